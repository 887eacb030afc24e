/** The change of an iteration, in a form that can be undone and redone. */

import { EDGE_STATES } from 'edgeflip';

/** Offsets into the indices, and the old value xor the new value at each: the same change in both directions. */
export interface Change {
  at: Uint32Array<ArrayBuffer>;
  xor: Uint32Array<ArrayBuffer>;
}

/** The change from `before` to `now`. */
export function changeOf(before: Uint32Array, now: Uint32Array): Change {
  let count = 0;
  for (let i = 0; i < now.length; i++) if (before[i] !== now[i]) count++;
  const change = { at: new Uint32Array(count), xor: new Uint32Array(count) };
  for (let i = 0, k = 0; k < count; i++) {
    const difference = before[i]! ^ now[i]!;
    if (difference !== 0) {
      change.at[k] = i;
      change.xor[k++] = difference;
    }
  }
  return change;
}

/** Applies the change of an iteration, or undoes it. */
export function applyChange(indices: Uint32Array, { at, xor }: Change): void {
  for (let k = 0; k < at.length; k++) indices[at[k]!]! ^= xor[k]!;
}

/** Whether the sides that a change flips are those before it or those after it. */
export type Moment = 'before' | 'after';

/**
 * The corner of a triangle at which the side that flips begins, counted from the corner that the flip changes. The old
 * side ends there, and the new one begins there.
 */
export const SIDE_FROM: Record<Moment, number> = { before: 2, after: 0 };

/** The number of the state of an edge that flips. */
const FLIPS = EDGE_STATES.indexOf('flips');

/** Writes the sides that a change flips, as their states, in the form of `Corners.sides`. */
export function writeFlips(sides: Uint32Array, { at }: Change, moment: Moment): void {
  sides.fill(0);
  const from = SIDE_FROM[moment];
  for (const h of at) sides[Math.floor(h / 3)] = FLIPS << (4 * ((h + from) % 3));
}
