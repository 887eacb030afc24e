/** From where a mesh is looked at first: a height field, such as a terrain, from above. */

import { Vector3 } from 'three/webgpu';

/** The direction to the camera for most meshes. */
export const FROM = new Vector3(1.4, 0.9, 3.1).normalize();

/** The most triangles that are looked at. */
const MOST = 2_000;
/** The least share of the area of a height field that faces up. */
const FACING = 0.98;
/** The sum of the normals of a closed surface is 0. That of a height field is at least this share of its area. */
const OPEN = 0.3;
/** The least and the most angle of the camera over the plane of a height field, and the one that it gets, in radians. */
const [LEAST, HIGHEST, OVER] = [35, 65, 42].map((degrees) => (degrees * Math.PI) / 180) as [number, number, number];

/** The direction to the camera. `positions` has 3 numbers for each vertex. */
export function viewpointOf(positions: Float32Array, indices: Uint32Array): Vector3 {
  const up = upOf(positions, indices);
  if (!up) return FROM;
  const over = Math.asin(FROM.dot(up));
  if (over >= LEAST && over <= HIGHEST) return FROM;
  const along = FROM.clone().addScaledVector(up, -FROM.dot(up)).normalize();
  return along.multiplyScalar(Math.cos(OVER)).addScaledVector(up, Math.sin(OVER));
}

/** The direction to which almost all triangles face, or the opposite one if that is nearer to the camera. */
function upOf(positions: Float32Array, indices: Uint32Array): Vector3 | undefined {
  const normals = normalsOf(positions, indices);
  const sum = new Vector3();
  let [area, facing] = [0, 0];
  for (const normal of normals) {
    sum.add(normal);
    area += normal.length();
  }
  if (!(sum.length() > OPEN * area)) return undefined;
  const up = sum.normalize();
  for (const normal of normals) if (normal.dot(up) > 0) facing += normal.length();
  if (facing < FACING * area) return undefined;
  return up.dot(FROM) < 0 ? up.negate() : up;
}

/** The normals of triangles that are spread over the mesh, as long as twice their areas. */
function normalsOf(positions: Float32Array, indices: Uint32Array): Vector3[] {
  const step = 3 * Math.max(1, Math.floor(indices.length / 3 / MOST));
  const normals: Vector3[] = [];
  const [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
  for (let h = 0; h < indices.length; h += step) {
    [a, b, c].forEach((corner, k) => corner.fromArray(positions, 3 * indices[h + k]!));
    const normal = b.sub(a).cross(c.sub(a));
    if (Number.isFinite(normal.x + normal.y + normal.z)) normals.push(normal.clone());
  }
  return normals;
}
