/** Runs on the device of a WebGPURenderer of three.js, which then draws from the buffer that the flips wrote. */

import type { BufferAttribute } from 'three';
import { EdgeflipError } from './error.js';
import { copyOf, messageOf, objectOf } from './given.js';
import { readMesh } from './mesh.js';
import { createWatched, type FlipSession, runWatched } from './session.js';
import { MAKE_OPTIONS, settingsOf, watchOf } from './settings.js';
import type { GpuBuffer, GpuDevice, MakeDelaunayOptions, Mesh, Result } from './types.js';

/** A renderer of three.js: a `WebGPURenderer`, or one that has no device to share. */
export interface Renderer {
  render(...args: never[]): unknown;
}

/** The part of a WebGPURenderer that is used here. */
interface WebGpuRenderer extends Renderer {
  readonly backend?: Backend;
  /** Whether `init` was called and is done. */
  readonly _initialized?: boolean;
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
  if (typeof renderer['render'] === 'function') return renderer as unknown as Renderer;
  throw new EdgeflipError('invalid-option', 'option renderer: it is not a renderer of three.js');
}

/** The backend of a renderer that draws with WebGPU. */
async function backendOf(renderer: WebGpuRenderer): Promise<Backend | undefined> {
  try {
    // Older releases of three.js refuse a second call.
    if (!renderer._initialized) await renderer.init?.();
  } catch (cause) {
    const message = `option renderer: its init failed: ${messageOf(cause)}`;
    throw new EdgeflipError('backend-unavailable', message, { cause });
  }
  const { backend } = renderer;
  return backend?.isWebGPUBackend && backend.device ? backend : undefined;
}

/**
 * Flips on the device of the renderer, if it has one. The triangles stay there. There must be no option `weld`. Copies
 * the arrays before it returns its promise.
 */
export async function flipShared(
  renderer: Renderer,
  mesh: Mesh<Uint32Array>,
  options: MakeDelaunayOptions,
): Promise<Run> {
  const watch = watchOf(options);
  const [copy] = readMesh(mesh, copyOf);
  const settings = settingsOf(options, MAKE_OPTIONS);
  const backend = await backendOf(renderer);
  const device = backend?.device ?? settings.device;
  const session = await createWatched(copy, { ...settings, device });
  let onGpu: OnGpu | undefined;
  try {
    const result = await runWatched(session, watch, true);
    const gpu = backend && (await session.gpu());
    if (!gpu) return { result: await session.result() };
    // three.js makes no buffer for an attribute that has one.
    const adopt = (index: BufferAttribute) => void (backend.get(index).buffer = gpu.indices);
    onGpu = { session, adopt };
    return { result, onGpu };
  } finally {
    if (!onGpu) session.free();
  }
}
