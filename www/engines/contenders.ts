/** The engines that race, and the mesh. */

import type { Engine, Options } from 'edgeflip';

export interface PlainMesh {
  positions: Float32Array | Float64Array;
  indices: Uint32Array;
  dimension: 2 | 3;
}

/** A mesh with its name, and the options that change its result. */
export interface NamedMesh extends PlainMesh {
  name: string;
  options?: Pick<Options, 'maxNormalAngle' | 'maxDeviation' | 'lockedEdges' | 'lockedTriangles' | 'groups'>;
}

export interface Contender {
  name: string;
  where: string;
  options: { backend: Engine; threads?: number };
  /** Why it cannot run in this browser, if that is known before. */
  whyNot?: string | undefined;
}

/** The contender that the speed-up is relative to. */
export const ONE_THREAD: Contender = {
  name: 'CPU, 1 thread',
  where: 'WebAssembly',
  options: { backend: 'cpu', threads: 1 },
};

export const WEBGPU: Contender = {
  name: 'WebGPU',
  where: 'Your GPU, compute shaders',
  options: { backend: 'webgpu' },
  whyNot: navigator.gpu ? undefined : 'This browser has no WebGPU here.',
};

export const WEBGL2: Contender = {
  name: 'WebGL2',
  where: 'Your GPU, fragment shaders',
  options: { backend: 'webgl2' },
};

export const THREADS: Contender = {
  name: `CPU, ${navigator.hardwareConcurrency} threads`,
  where: 'WebAssembly, shared memory',
  options: { backend: 'cpu' },
  whyNot: whyOneThread(),
};

/** In the order in which they race: the CPU first. */
export const ALL = [ONE_THREAD, THREADS, WEBGPU, WEBGL2];

function whyOneThread(): string | undefined {
  if (navigator.hardwareConcurrency < 2) return 'This browser offers one core.';
  return crossOriginIsolated ? undefined : 'This page may not share memory, so it has one thread.';
}

/** Why several threads were asked for, and one ran: a part of the hint, unless the mesh is small. */
export function whyOneThreadRan(hint: string | undefined): string {
  const [why] = hint?.match(/The CPU engine ran on one thread.*/) ?? [];
  return why ?? 'A mesh this small runs on one thread: more would not be faster.';
}
