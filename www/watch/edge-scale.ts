/** How long edges are on screen: the median of those in view, from a sample of the mesh. */

import { Matrix4, type Camera } from 'three/webgpu';

/** The most edges of the sample. Each picture looks at all of them. */
const SAMPLE = 4000;
/** The fewest edges in view whose median is taken; if fewer are, those nearest to the view count. */
const FEWEST = 24;
/** Edges are drawn in full from this length on, in pixels, and not at all below the other. */
const [CLEAR, GONE] = [5, 2];
/** The golden ratio: its multiples are spread evenly, whatever the order of the mesh. */
const SPREAD = (Math.sqrt(5) - 1) / 2;

export class EdgeScale {
  /** The ends of the edges: 6 numbers each. */
  #ends = new Float32Array();
  /** Of each edge in the picture: its length in pixels, and how far it is from the middle, 1 at the rim. */
  #lengths = new Float32Array();
  #away = new Float32Array();
  readonly #matrix = new Matrix4();

  /** Takes a sample of the edges of a mesh: 3 numbers for each vertex. */
  sample(positions: Float32Array, indices: Uint32Array): void {
    const count = Math.min(SAMPLE, indices.length);
    this.#ends = new Float32Array(6 * count);
    [this.#lengths, this.#away] = [new Float32Array(count), new Float32Array(count)];
    for (let i = 0; i < count; i++) {
      const h = count < indices.length ? Math.floor(((i * SPREAD) % 1) * indices.length) : i;
      const [a, b] = [3 * indices[h]!, 3 * indices[h % 3 === 2 ? h - 2 : h + 1]!];
      for (let k = 0; k < 3; k++) {
        this.#ends[6 * i + k] = positions[a + k]!;
        this.#ends[6 * i + 3 + k] = positions[b + k]!;
      }
    }
  }

  /** The median length of the edges in view, in pixels. */
  median(camera: Camera, width: number, height: number): number {
    camera.updateMatrixWorld();
    const { elements: m } = this.#matrix.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    const [ends, lengths, away] = [this.#ends, this.#lengths, this.#away];
    const count = lengths.length;
    let seen = 0;
    for (let i = 0; i < count; i++) {
      const a = dot(m, 3, ends, 6 * i);
      const b = dot(m, 3, ends, 6 * i + 3);
      // Behind the camera.
      if (a <= 0 || b <= 0) continue;
      const ux = dot(m, 0, ends, 6 * i) / a;
      const uy = dot(m, 1, ends, 6 * i) / a;
      const vx = dot(m, 0, ends, 6 * i + 3) / b;
      const vy = dot(m, 1, ends, 6 * i + 3) / b;
      lengths[seen] = Math.hypot((width / 2) * (ux - vx), (height / 2) * (uy - vy));
      away[seen++] = Math.max(Math.abs(ux + vx), Math.abs(uy + vy)) / 2;
    }
    if (seen === 0) return Infinity;
    let reach = 1;
    const near = away.subarray(0, seen).filter((far) => far <= 1).length;
    if (near < FEWEST) reach = away.slice(0, seen).sort()[Math.min(FEWEST, seen) - 1]!;
    const inView = lengths.subarray(0, seen).filter((_, i) => away[i]! <= reach);
    return inView.sort()[inView.length >> 1]!;
  }

  /** How clear edges of this length are: from 0 to 1. */
  static clarity(length: number): number {
    return Math.max(0, Math.min(1, (length - GONE) / (CLEAR - GONE)));
  }
}

/** A row of a matrix, whose columns follow each other, times a point. */
function dot(matrix: readonly number[], row: number, points: Float32Array, at: number): number {
  const [x, y, z] = [matrix[row]! * points[at]!, matrix[row + 4]! * points[at + 1]!, matrix[row + 8]! * points[at + 2]!];
  return x + y + z + matrix[row + 12]!;
}
