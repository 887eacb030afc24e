/** The sharp edges of a surface. */

import { FlipSession } from 'edgeflip';
import type { IndexedMesh } from 'edgeflip/files';
import { normalOf } from './quad.ts';

/** The edges whose two triangles differ by more than this angle in degrees: two vertices each. */
export async function featuresOf(mesh: IndexedMesh, degrees: number): Promise<Uint32Array> {
  const session = await FlipSession.create(mesh, { backend: 'cpu', threads: 1 });
  const { v1, v2, ta, tb } = await session.edges();
  session.free();
  const least = Math.cos((degrees * Math.PI) / 180);
  const found: number[] = [];
  ta.forEach((first, e) => {
    const second = tb[e]!;
    if (second === 0xffffffff) return;
    const [u, v] = [normalOf(mesh, first), normalOf(mesh, second)];
    const cosine = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    if (cosine < least * Math.hypot(...u) * Math.hypot(...v)) found.push(v1[e]!, v2[e]!);
  });
  return Uint32Array.from(found);
}
