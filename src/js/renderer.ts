/** Runs on the device of a WebGPURenderer of three.js, which then draws from the buffer that the flips wrote. */

import type { BufferAttribute } from 'three';
import { EdgeflipError } from './error.js';
import { objectOf } from './given.js';
import { createWatched, type FlipSession, runWatched } from './session.js';
import { MAKE_OPTIONS, watchOf } from './settings.js';
import type { GpuBuffer, GpuDevice, MakeDelaunayOptions, Mesh, Result } from './types.js';

/** A renderer of three.js: a `WebGPURenderer`, or one that cannot share a device. */
export interface Renderer {
  /** Prepares the renderer; the `WebGPURenderer` has it. */
  init?(): Promise<unknown>;
}

/** The part of the backend of a WebGPURenderer that is used here. Its data of an attribute has the buffer. */
interface Backend {
  readonly isWebGPUBackend?: boolean;
  readonly device?: GpuDevice;
  get(attribute: object): { buffer?: GpuBuffer };
}

/** A result, and where its triangles are. */
export interface Run {
  result: Result;
  /** Absent if `result` has the triangles. */
  onGpu?: OnGpu;
}

/** Triangles on the device of a renderer. */
export interface OnGpu {
  /** The session whose buffer has them. */
  session: FlipSession;
  /** Gives that buffer to an attribute that the renderer has not drawn yet. */
  adopt: (index: BufferAttribute) => void;
}

/** @throws {@link EdgeflipError} `invalid-option`. */
export function rendererOf(given: unknown): Renderer | undefined {
  if (given === undefined) return undefined;
  const renderer = objectOf(given, 'option renderer');
  if (typeof renderer['render'] === 'function') return renderer as Renderer;
  throw new EdgeflipError('invalid-option', 'option renderer: it is not a renderer of three.js');
}

/** Flips on the device of the renderer, if it has one. The triangles stay there. There must be no option `weld`. */
export async function flipShared(
  renderer: Renderer,
  mesh: Mesh<Uint32Array>,
  options: MakeDelaunayOptions,
): Promise<Run> {
  const watch = watchOf(options, MAKE_OPTIONS);
  await renderer.init?.();
  const { backend } = renderer as { backend?: Backend };
  const device = backend?.isWebGPUBackend ? backend.device : undefined;
  const session = await createWatched(mesh, { ...options, device });
  let onGpu: OnGpu | undefined;
  try {
    const result = await runWatched(session, watch, true);
    const gpu = device && (await session.gpu());
    if (!backend || !gpu) return { result: await session.result() };
    // three.js makes no buffer for an attribute that has one.
    const adopt = (index: BufferAttribute) => void (backend.get(index).buffer = gpu.indices);
    onGpu = { session, adopt };
    return { result, onGpu };
  } finally {
    if (!onGpu) session.free();
  }
}
