/** How long edges are on screen, in a sample of the triangles in view. */

import { Matrix4, type Camera } from 'three/webgpu';

/** The most triangles of the sample. Each picture looks at all of them. */
const SAMPLE = 3000;
/** Edges are drawn in full from this length on, in pixels, and not at all below the other. */
export const [CLEAR, GONE] = [5, 2];
/** The share of the triangles in view that may be different before the page says so. */
const FEW = 0.1;
/** The fewest triangles in view that tell something. If fewer are, those nearest to the view count. */
const FEWEST = 24;
/** The golden ratio: its multiples are spread evenly, whatever the order of the mesh. */
const SPREAD = (Math.sqrt(5) - 1) / 2;

/** What is seen of edges: all of them, none because they are too short, or some. */
export type Seen = 'all' | 'none' | 'some';

export class EdgeScale {
  /** The corners of the triangles: 9 numbers each. */
  #corners = new Float32Array();
  readonly #matrix = new Matrix4();

  /** Takes a sample of the triangles of a mesh: 3 numbers for each vertex. */
  sample(positions: Float32Array, indices: Uint32Array): void {
    const triangles = indices.length / 3;
    const count = Math.min(SAMPLE, triangles);
    this.#corners = new Float32Array(9 * count);
    for (let i = 0; i < count; i++) {
      const first = 3 * (count < triangles ? Math.floor(((i * SPREAD) % 1) * triangles) : i);
      for (let k = 0; k < 9; k++)
        this.#corners[9 * i + k] = positions[3 * indices[first + Math.floor(k / 3)]! + (k % 3)]!;
    }
  }

  /** What is seen of edges in a picture of this size in pixels. */
  seen(camera: Camera, width: number, height: number): Seen {
    const lengths = this.#lengths(camera, width, height);
    const at = (share: number) => lengths[Math.round(share * (lengths.length - 1))] ?? Infinity;
    return at(FEW) >= CLEAR ? 'all' : at(1 - FEW) <= GONE ? 'none' : 'some';
  }

  /** Of each triangle of the sample that is in view and at the front: the length of its median edge, sorted. */
  #lengths(camera: Camera, width: number, height: number): Float32Array {
    camera.updateMatrixWorld();
    const { elements: m } = this.#matrix.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    const [found, turns, away] = [[], [], []] as [number[], number[], number[]];
    const depths = [0, 0];
    const [x, y, w] = [new Float32Array(3), new Float32Array(3), new Float32Array(3)];
    for (let at = 0; at < this.#corners.length; at += 9) {
      for (let k = 0; k < 3; k++) {
        const corner = at + 3 * k;
        w[k] = dot(m, 3, this.#corners, corner);
        x[k] = dot(m, 0, this.#corners, corner) / w[k]!;
        y[k] = dot(m, 1, this.#corners, corner) / w[k]!;
      }
      // Behind the camera.
      if (w[0]! <= 0 || w[1]! <= 0 || w[2]! <= 0) continue;
      const side = (a: number, b: number) => Math.hypot((width / 2) * (x[a]! - x[b]!), (height / 2) * (y[a]! - y[b]!));
      const [u, v, last] = [side(0, 1), side(1, 2), side(2, 0)];
      const turn = (x[1]! - x[0]!) * (y[2]! - y[0]!) > (x[2]! - x[0]!) * (y[1]! - y[0]!) ? 1 : 0;
      depths[turn]! += w[0]!;
      turns.push(turn);
      found.push(u + v + last - Math.max(u, v, last) - Math.min(u, v, last));
      away.push(Math.max(Math.abs(x[0]!), Math.abs(y[0]!)));
    }
    const front = frontOf(turns, depths);
    const isFront = (i: number) => front === undefined || turns[i] === front;
    const inFront = away.filter((_, i) => isFront(i));
    const near = inFront.filter((far) => far <= 1).length;
    const reach = near >= FEWEST ? 1 : (inFront.sort((a, b) => a - b)[FEWEST - 1] ?? Infinity);
    return Float32Array.from(found.filter((_, i) => isFront(i) && away[i]! <= reach)).sort();
  }
}

/** The way round in which the triangles at the front are seen; `undefined` if they are seen in one way only. */
function frontOf(turns: readonly number[], depths: readonly number[]): number | undefined {
  const ones = turns.filter((turn) => turn === 1).length;
  const zeros = turns.length - ones;
  if (Math.min(ones, zeros) < FEWEST) return undefined;
  return depths[1]! / ones < depths[0]! / zeros ? 1 : 0;
}

/** A row of a matrix, whose columns follow each other, times a point. */
function dot(matrix: readonly number[], row: number, points: Float32Array, at: number): number {
  const [x, y, z] = [
    matrix[row]! * points[at]!,
    matrix[row + 4]! * points[at + 1]!,
    matrix[row + 8]! * points[at + 2]!,
  ];
  return x + y + z + matrix[row + 12]!;
}
