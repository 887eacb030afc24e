/** Counts the locked edges of a run, which stay whatever their angles are. */

import type { Options } from 'edgeflip';
import type { IndexedMesh } from 'edgeflip/files';

/** What locks edges. */
export type Locks = Pick<Options, 'groups' | 'lockedEdges' | 'lockedTriangles'>;

/**
 * The number of locked edges: borders between groups, `lockedEdges`, and the sides of `lockedTriangles`. No flip changes
 * it.
 */
export function countLocks({ indices, positions, dimension }: IndexedMesh, locks: Locks): number {
  const { groups, lockedEdges = [], lockedTriangles = [] } = locks;
  const vertices = positions.length / dimension;
  const keyOf = (u: number, v: number) => Math.min(u, v) * vertices + Math.max(u, v);
  const sides = (t: number) => [0, 1, 2].map((k) => keyOf(indices[3 * t + k]!, indices[3 * t + ((k + 1) % 3)]!));
  const locked = new Set<number>();
  for (let i = 0; i + 1 < lockedEdges.length; i += 2) locked.add(keyOf(lockedEdges[i]!, lockedEdges[i + 1]!));
  for (const t of lockedTriangles) for (const key of sides(t)) locked.add(key);
  if (!groups) return locked.size;
  const groupOf = new Map<number, number>();
  for (let t = 0; t < groups.length; t++) {
    for (const key of sides(t)) {
      const other = groupOf.get(key);
      if (other === undefined) groupOf.set(key, groups[t]!);
      else if (other !== groups[t]) locked.add(key);
    }
  }
  return locked.size;
}
