/** How the nodes of a glTF-Transform document place a mesh in the scene. */

import type { Document, mat4, Mesh } from '@gltf-transform/core';

/** Relative tolerance for squares of lengths, because quaternions and matrices are rounded to 32 bits. */
const ROUNDING = 1e-5;

/** A matrix of 3 rows and 3 columns, column by column. */
export type Matrix = readonly number[];

/** For each mesh, the linear part of its first node's placement, if it changes angles: an uneven scale, or a shear. */
export function stretches(document: Document): Map<Mesh, Matrix | undefined> {
  const found = new Map<Mesh, Matrix | undefined>();
  for (const node of document.getRoot().listNodes()) {
    const mesh = node.getMesh();
    if (!mesh || found.has(mesh)) continue;
    // The joints of a skin place its vertices, not the node.
    const linear = node.getSkin() ? undefined : linearOf(node.getWorldMatrix());
    found.set(mesh, linear && !isSimilarity(linear) ? linear : undefined);
  }
  return found;
}

function linearOf(world: mat4): Matrix {
  return [0, 4, 8].flatMap((column) => world.slice(column, column + 3));
}

/** Whether the matrix keeps angles, or is singular or infinite, so that no angles are left. */
function isSimilarity(matrix: Matrix): boolean {
  const [x, y, z] = [matrix.slice(0, 3), matrix.slice(3, 6), matrix.slice(6, 9)] as const;
  const dot = (a: Matrix, b: Matrix) => a[0]! * b[0]! + a[1]! * b[1]! + a[2]! * b[2]!;
  const squares = [dot(x, x), dot(y, y), dot(z, z)];
  const mean = squares.reduce((sum, square) => sum + square) / 3;
  const off = [dot(x, y), dot(y, z), dot(z, x), ...squares.map((square) => square - mean)];
  const volume = dot(x, [y[1]! * z[2]! - y[2]! * z[1]!, y[2]! * z[0]! - y[0]! * z[2]!, y[0]! * z[1]! - y[1]! * z[0]!]);
  return volume === 0 || !Number.isFinite(volume) || off.every((value) => Math.abs(value) <= ROUNDING * mean);
}

/** The positions times a matrix. */
export function stretched(positions: Float32Array | Float64Array, matrix: Matrix): Float64Array {
  return Float64Array.from(positions, (_, i) => {
    const [axis, first] = [i % 3, i - (i % 3)];
    return [0, 1, 2].reduce((sum, column) => sum + matrix[3 * column + axis]! * positions[first + column]!, 0);
  });
}
