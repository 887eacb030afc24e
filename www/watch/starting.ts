/** Starts a run of the open mesh, and counts its flips ahead. */

import type { Options } from 'edgeflip';
import type { Settings } from './choices.ts';
import type { Flips } from './mesh-worker.ts';
import { beginRun, waitsForGpu } from './engines.ts';
import type { Graphics } from './graphics.ts';
import { showProgress } from './jobs.ts';
import type { Opened } from './opening.ts';
import { optionsFor } from './options.ts';
import type { Backend, Run } from './run.ts';

/** The most triangles of a mesh whose iterations are counted before they are shown. */
const AHEAD = 200_000;

/** The milliseconds after which counting stops. */
const LONGEST = 4000;

type Chosen = Options & { backend: Backend };

/** Starts a run with these settings, once the picture can be drawn. */
export async function startRun(
  opened: Opened,
  settings: Settings,
  graphics: Graphics,
  signal: AbortSignal,
): Promise<{ run: Run; options: Chosen }> {
  const { mesh } = opened;
  const options = await optionsFor(opened, settings);
  if (waitsForGpu(mesh, settings.backend)) await graphics.ready;
  signal.throwIfAborted();
  const { gpu } = graphics;
  const compiles = settings.backend === 'webgpu' && typeof gpu === 'object' && !gpu.kernels.areReadyFor(mesh);
  if (compiles) showProgress('Compiling the kernels for the GPU…');
  const run = await beginRun(mesh, options, gpu, signal);
  // The scene opens together with the GPU.
  await graphics.ready;
  if (!signal.aborted) return { run, options };
  run.free();
  throw signal.reason;
}

/** The flips of all iterations of a small mesh; `undefined` for a large one. */
export async function flipsAhead(opened: Opened, options: Chosen): Promise<Flips[] | undefined> {
  const { mesh } = opened;
  if (mesh.indices.length > 3 * AHEAD) return undefined;
  try {
    return await opened.client.call((worker) => worker.lookAhead(mesh, options, LONGEST));
  } catch {
    return undefined;
  }
}
