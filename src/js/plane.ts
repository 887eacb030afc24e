/** The plane of a terrain: which coordinates decide. */

import { EdgeflipError } from './error.js';

/**
 * The plane of a terrain: the two coordinates that decide. The third, the height, counts for nothing, and may be any
 * number. `'xy'` where z is up, as in maps; `'xz'` where y is up, as in three.js and glTF.
 */
export type Plane = 'xy' | 'xz' | 'yz';

/**
 * The axes of each plane, in the order in which a triangle that is counter-clockwise from above is positive, as in
 * `src/mesh/plane.rs`.
 */
export const AXES: Readonly<Record<Plane, readonly number[]>> = { xy: [0, 1], xz: [2, 0], yz: [1, 2] };

/** Positions as the modules take them. */
export type Floats = Float32Array | Float64Array;

/**
 * The two coordinates of a plane.
 *
 * @throws {@link EdgeflipError} `ragged-array`.
 */
export function planOf(space: Floats, plane: Plane): Floats {
  if (space.length % 3 > 0) {
    throw new EdgeflipError('ragged-array', `positions has ${space.length} numbers, not a multiple of 3`);
  }
  const [u, v] = AXES[plane] as [number, number];
  const plan = new (space.constructor as Float64ArrayConstructor)((space.length / 3) * 2);
  for (let to = 0, from = 0; to < plan.length; from += 3) {
    plan[to++] = space[from + u]!;
    plan[to++] = space[from + v]!;
  }
  return plan;
}

/**
 * The modules would name other axes.
 *
 * @throws {@link EdgeflipError} `non-finite`.
 */
export function checkPlan(plan: Floats, plane: Plane): void {
  const at = plan.findIndex((x) => !Number.isFinite(x));
  if (at < 0) return;
  const axis = 'xyz'[AXES[plane][at % 2]!];
  throw new EdgeflipError('non-finite', `vertex ${at >> 1}: coordinate ${axis} is ${plan[at]}, not a finite number`);
}
