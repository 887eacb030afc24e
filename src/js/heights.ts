/** The heights of a session whose mesh has a plane: the engines know the other two coordinates only. */

import { copyTo, type Source } from './gather.js';
import { AXES, type Floats, type Plane } from './plane.js';
import type { SessionBuffers } from './session-buffers.js';
import type { GpuBuffer, GpuDevice } from './types.js';

/** More than what rounding does to the difference of two products, for its sign. */
const ROUNDING = 2 ** -50;

/** All coordinates of the vertices, and a buffer with them on the device of the session once the page has asked for it. */
export class Heights {
  readonly #plane: Plane;
  #positions: Floats;
  #buffer: GpuBuffer | undefined;
  #device: GpuDevice | undefined;

  /** The plane in which no triangle of the input is turned over, if it is another one. */
  readonly rightPlane: Plane | undefined;

  /** Keeps the positions. */
  constructor(plane: Plane, positions: Floats, indices: Uint32Array) {
    this.#plane = plane;
    this.#positions = positions;
    const isRight = (plane: Plane) => isTerrain(plane, positions, indices);
    this.rightPlane = isRight(plane) ? undefined : (Object.keys(AXES) as Plane[]).find(isRight);
  }

  /** The buffers of the session, with all coordinates as its positions. */
  withHeights(gpu: SessionBuffers): SessionBuffers {
    if (this.#device !== gpu.device) {
      this.free();
      const usage = GPUBufferUsage.STORAGE | GPUBufferUsage.VERTEX | GPUBufferUsage.COPY_SRC | GPUBufferUsage.COPY_DST;
      const size = Math.max(4, 4 * this.#positions.length);
      this.#device = gpu.device;
      this.#buffer = gpu.device.createBuffer({ label: 'edgeflip positions with heights', size, usage });
      this.#write();
    }
    return { ...gpu, positions: this.#buffer! };
  }

  /** Copies positions. */
  move(positions: Floats): void {
    if (positions.constructor === this.#positions.constructor) this.#positions.set(positions);
    else this.#positions = positions.slice();
    this.#write();
  }

  /**
   * Gives the engine the plan of positions on its device: of those in a buffer of the page, or those that the page has
   * written to ours.
   */
  moveOn(gpu: SessionBuffers, given: Source | undefined): void {
    const vertices = this.#positions.length / 3;
    const own = this.#device === gpu.device ? this.#buffer : undefined;
    const source = given ?? (own && { buffer: own, offset: 0, stride: 3 });
    if (given && own) copyTo(gpu.device, given, own, [0, 1, 2], vertices);
    if (source) copyTo(gpu.device, source, gpu.positions, AXES[this.#plane], vertices);
  }

  free(): void {
    this.#buffer?.destroy();
    this.#buffer = undefined;
    this.#device = undefined;
  }

  /** Rounds doubles, as the engine does. */
  #write(): void {
    if (!this.#buffer) return;
    const numbers = this.#positions;
    const floats = numbers instanceof Float32Array ? numbers : new Float32Array(numbers);
    this.#device?.queue.writeBuffer(this.#buffer, 0, floats as Float32Array<ArrayBuffer>);
  }
}

/**
 * Whether all triangles that are not flat from above have one orientation, as `Mesh::terrain_plane` of the crate. What is
 * flat up to rounding counts as flat.
 */
function isTerrain(plane: Plane, numbers: Floats, indices: Uint32Array): boolean {
  const [u, v] = AXES[plane] as [number, number];
  let first = 0;
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [3 * indices[i]!, 3 * indices[i + 1]!, 3 * indices[i + 2]!];
    const left = (numbers[b + u]! - numbers[a + u]!) * (numbers[c + v]! - numbers[a + v]!);
    const right = (numbers[c + u]! - numbers[a + u]!) * (numbers[b + v]! - numbers[a + v]!);
    if (Math.abs(left - right) <= ROUNDING * (Math.abs(left) + Math.abs(right))) continue;
    const sign = Math.sign(left - right);
    if (sign === -first) return false;
    first = sign;
  }
  return first !== 0;
}
