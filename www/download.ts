/** A mesh as a file for the user. */

import { Office } from './engines.ts';
import type { Kept } from './files.ts';
import type { OpenMesh } from './run.ts';

/** Writes the mesh and hands the file over. `kept` are the files that it was read from. */
export async function download(
  mesh: OpenMesh,
  name: string,
  kept: Kept | undefined,
  signal: AbortSignal,
): Promise<void> {
  // A worker of its own: the memory that writing takes goes with it, and it can be cancelled.
  const office = new Office();
  signal.addEventListener('abort', () => office.close());
  const bytes = await office.ask((desk) => desk.write(mesh, name, kept)).finally(() => office.close());
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([bytes]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
