/** Files for the user. */

import { WorkerClient } from './worker-client.ts';
import type { Kept } from './files.ts';
import type { OpenMesh } from './run.ts';

/** Writes the mesh to a file and downloads it. `kept` has the files that the mesh was read from. */
export async function download(
  mesh: OpenMesh,
  name: string,
  kept: Kept | undefined,
  signal: AbortSignal,
): Promise<void> {
  // Writing has its own worker. Closing the worker frees the memory and can cancel the job.
  const client = new WorkerClient().closeOn(signal);
  const bytes = await client.call((worker) => worker.write(mesh, name, kept)).finally(() => client.close());
  save(new Blob([bytes]), name);
}

/** Gives the user a file. */
export function save(content: Blob, name: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
