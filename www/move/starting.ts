/** Generates a mesh that moves, and starts the engine that moves it. */

import type { IndexedMesh } from 'edgeflip/files';
import { forAuto, type Gpu } from '../watch/engines.ts';
import type { Backend } from '../watch/run.ts';
import type { Scene } from '../watch/scene.ts';
import { WorkerClient } from '../watch/worker-client.ts';
import { wordsForMesh, type Words } from './motion-panel.ts';
import type { Motion, Point } from './motions.ts';
import type { Grip, MovingMesh } from './moving-mesh.ts';
import { moveInArrays } from './on-arrays.ts';
import { moveOnDevice } from './on-device.ts';
import { PointerDrag } from './pointer-drag.ts';
import type { Sharing } from '../watch/corners.ts';

/** What moves, once it has begun. */
export interface Started {
  moving: MovingMesh;
  words: Words;
  /** Why the GPU is not used. */
  remark: string;
  /** What the camera sees. */
  view: Pick<Motion, 'dimension' | 'box'>;
  /** Makes the pointer that drags it, see `FrameLoop`. */
  grip(view: HTMLElement, scene: Scene, changed: (isHeld: boolean) => void): Grip;
}

/** Starts a mesh with about so many triangles. */
export async function startMovingMesh(
  motion: Motion,
  many: number,
  backend: Backend,
  gpu: Gpu | string | undefined,
  share: Sharing,
  signal: AbortSignal,
): Promise<Started> {
  const [engine, remark] = engineFor(backend, gpu);
  const mesh = begun(await generated(motion.spec(many), signal), motion);
  signal.throwIfAborted();
  const moving =
    typeof engine === 'string'
      ? await moveInArrays(mesh, motion, engine)
      : await moveOnDevice(mesh, motion, engine.device, share);
  if (signal.aborted) {
    moving.free();
    throw signal.reason;
  }
  const [triangles, vertices] = [mesh.indices.length / 3, mesh.positions.length / mesh.dimension];
  return {
    moving,
    words: wordsForMesh(triangles, vertices, moving.engine),
    remark,
    view: motion,
    grip: (view, scene, changed) => new PointerDrag(view, scene, motion.dimension, changed),
  };
}

/** A mesh of a family, made in a worker. */
function generated(spec: string, signal: AbortSignal): Promise<IndexedMesh> {
  const client = new WorkerClient().closeOn(signal);
  return client.call((worker) => worker.generate(spec)).finally(() => client.close());
}

/** The GPU, or an engine on arrays; and why the GPU is not used. */
function engineFor(backend: Backend, gpu: Gpu | string | undefined): [engine: Gpu | 'cpu' | 'webgl2', remark: string] {
  if (backend === 'cpu' || backend === 'webgl2') return [backend, ''];
  const usable = backend === 'auto' && gpu ? forAuto(gpu) : (gpu ?? 'WebGPU is not ready');
  if (typeof usable !== 'string') return [usable, ''];
  if (backend === 'webgpu') throw new Error(`The WebGPU engine is not available: ${usable}.`);
  return ['cpu', `On the CPU: ${usable}.`];
}

/** The mesh of a family, where the motion begins, in 32-bit floats as GPUs take them. */
function begun({ positions, indices, dimension }: IndexedMesh, motion: Motion): IndexedMesh {
  const start = new Float32Array(positions.length);
  for (let i = 0; i < positions.length; i += dimension) {
    const vertex = [0, 1, 2].map((k) => (k < dimension ? positions[i + k]! : 0)) as Point;
    start.set(motion.start(vertex).slice(0, dimension), i);
  }
  return { positions: start, indices, dimension };
}
