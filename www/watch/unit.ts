/** Positions to draw: f32 numbers near 0, whatever the mesh's own offset and size. */

import type { FileMesh, IndexedMesh } from 'edgeflip/files';
import { widthOf } from './plan.ts';

/** The positions, in the scene if the file has one, moved and scaled into the unit ball; 3 numbers per vertex. */
export function unitPositions(mesh: IndexedMesh | FileMesh): Float32Array {
  const placed = 'placed' in mesh ? mesh.placed : undefined;
  const [positions, width] = placed ? [placed, 3] : [mesh.positions, widthOf(mesh)];
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i++) {
    const axis = i % width;
    const x = positions[i]!;
    if (x < low[axis]!) low[axis] = x;
    if (x > high[axis]!) high[axis] = x;
  }
  const centre = low.map((x, axis) => (Number.isFinite(x) ? x / 2 + high[axis]! / 2 : 0));
  const count = positions.length / width;
  let radius = 0;
  for (let v = 0; v < count; v++) {
    let square = 0;
    for (let axis = 0; axis < width; axis++) square += (positions[width * v + axis]! - centre[axis]!) ** 2;
    if (square > radius) radius = square;
  }
  const scale = radius > 0 ? 1 / Math.sqrt(radius) : 1;
  const unit = new Float32Array(3 * count);
  for (let v = 0; v < count; v++) {
    for (let axis = 0; axis < width; axis++) {
      unit[3 * v + axis] = (positions[width * v + axis]! - centre[axis]!) * scale;
    }
  }
  return unit;
}
