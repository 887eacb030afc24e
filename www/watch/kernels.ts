/** The kernels of the flips on the page's GPU. Compiling them takes far longer than flipping a small mesh. */

import { FlipSession } from 'edgeflip';
import type { OpenMesh } from './run.ts';

export class Kernels {
  readonly #device: GPUDevice;
  /** The kernels that are ready or being compiled, by the form of their meshes. */
  readonly #made = new Map<string, Promise<void>>();
  readonly #ready = new Set<string>();

  constructor(device: GPUDevice) {
    this.#device = device;
  }

  areReadyFor(mesh: OpenMesh): boolean {
    return this.#ready.has(formOf(mesh));
  }

  /**
   * Compiles and tests the kernels for a mesh, once for all meshes of its form. After a failure, the next call tries
   * again.
   *
   * @throws {@link EdgeflipError} about the GPU.
   */
  makeReadyFor(mesh: OpenMesh): Promise<void> {
    const form = formOf(mesh);
    let made = this.#made.get(form);
    if (!made) {
      made = this.#make(mesh).then(() => void this.#ready.add(form));
      this.#made.set(form, made);
      made.catch(() => this.#made.delete(form));
    }
    return made;
  }

  /** The package keeps the kernels of a device after the session has been freed. */
  async #make({ dimension, positions }: OpenMesh): Promise<void> {
    // 0.1 as a double is not a 32-bit float. Doubles that are would use the kernels for 32-bit floats.
    const corners = [0, 0, 0, 0.1, 0, 0, 0, 0.1, 0].filter((_, i) => i % 3 < dimension);
    const Floats = positions instanceof Float64Array ? Float64Array : Float32Array;
    const triangle = { dimension, positions: new Floats(corners), indices: new Uint32Array([0, 1, 2]) };
    const session = await FlipSession.create(triangle, { backend: 'webgpu', device: this.#device });
    session.free();
  }
}

function formOf({ dimension, positions }: OpenMesh): string {
  return `${dimension}, ${positions.BYTES_PER_ELEMENT}`;
}
