/** The worker: runs one engine on a mesh several times and times it, so that the page never blocks. */

import { expose, transfer } from 'comlink';
import { makeDelaunay, type Options, type Result } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { isSoftware } from '../shell/adapter.ts';
import type { PlainMesh } from './contenders.ts';

const RUNS = 5;

/** Milliseconds. Shorter runs are timed several at once, because clocks of browsers are coarse. */
const SHORT = 5;
const MOST_AT_ONCE = 50;

/** A thin diamond, split along its long diagonal: the smallest mesh with a flip. */
const DIAMOND = {
  2: Float32Array.of(-3, 0, 0, -1, 3, 0, 0, 1),
  3: Float32Array.of(-3, 0, 0, 0, -1, 0, 3, 0, 0, 0, 1, 0),
};
const TWO = Uint32Array.of(0, 1, 2, 0, 2, 3);

/** The times are in milliseconds, from arrays to arrays. */
export interface Timing {
  /** The median of the runs after the first, or the first if there was no time for more. */
  median: number;
  /** How many runs, or groups of short runs, the median is of. */
  runs: number;
  result: Pick<Result, 'indices' | 'flips' | 'threads' | 'hint'>;
  isSoftware: boolean;
}

class Timer {
  async generate(spec: string): Promise<PlainMesh> {
    const { positions, indices, dimension } = await generate(spec);
    return transfer({ positions, indices, dimension }, [positions.buffer, indices.buffer]);
  }

  /** Whether the engine would run on a GPU that the browser emulates on the CPU. */
  async isSoftware({ backend }: Options): Promise<boolean> {
    if (backend === 'webgpu') {
      const adapter = await navigator.gpu?.requestAdapter();
      return adapter ? isSoftware(adapter) : false;
    }
    return backend === 'webgl2' && /swiftshader|llvmpipe|softpipe|basic render/i.test(rendererName());
  }

  /**
   * Starts the engine: loads it, opens the GPU, compiles the kernels for the dimension and flips an edge. Returns the
   * milliseconds.
   */
  async start(dimension: 2 | 3, options: Options): Promise<number> {
    // The locks are those of another mesh.
    const { lockedEdges, lockedTriangles, groups, ...others } = options;
    return timeOf({ positions: DIAMOND[dimension], indices: TWO, dimension }, others, 1);
  }

  /** No run begins after `most` milliseconds but the first. */
  async time(mesh: PlainMesh, options: Options, most: number): Promise<Timing> {
    const begin = performance.now();
    const { indices, flips, threads, hint } = await makeDelaunay(mesh, options);
    const first = performance.now() - begin;
    const atOnce = Math.min(MOST_AT_ONCE, Math.ceil(SHORT / Math.max(first, 1e-3)));
    const times: number[] = [];
    while (times.length < RUNS && performance.now() - begin < most) times.push(await timeOf(mesh, options, atOnce));
    const sorted = times.length > 0 ? times.sort((a, b) => a - b) : [first];
    const median = (sorted[(sorted.length - 1) >> 1]! + sorted[sorted.length >> 1]!) / 2;
    const result = { indices, flips, threads, hint };
    const isSoftware = await this.isSoftware(options);
    return transfer({ median, runs: sorted.length, result, isSoftware }, [indices.buffer]);
  }
}

/** The mean time of `count` runs, one after the other. */
async function timeOf(mesh: PlainMesh, options: Options, count: number): Promise<number> {
  const start = performance.now();
  for (let i = 0; i < count; i++) await makeDelaunay(mesh, options);
  return (performance.now() - start) / count;
}

/** The renderer of WebGL2. Chromium and Safari tell it only through an extension, about which Firefox warns. */
function rendererName(): string {
  const gl = new OffscreenCanvas(1, 1).getContext('webgl2');
  if (!gl) return '';
  const name: string = gl.getParameter(gl.RENDERER);
  const extension = name.startsWith('WebKit') ? gl.getExtension('WEBGL_debug_renderer_info') : null;
  const renderer: string = extension ? gl.getParameter(extension.UNMASKED_RENDERER_WEBGL) : name;
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return renderer;
}

export type { Timer };
expose(new Timer());
