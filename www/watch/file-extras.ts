/** What a file has besides its mesh: colours and seams. They are found when they are needed, in a worker. */

import type { FileMesh } from 'edgeflip/files';
import type { FileColours } from './colour-format.ts';
import type { Kept } from './files.ts';
import { widthOf } from './plan.ts';
import type { Seams } from './seam.ts';
import { WorkerClient } from './worker-client.ts';

export class FileExtras {
  readonly #mesh: FileMesh;
  readonly #kept: Kept;
  /** The workers that search. */
  readonly #clients = new Set<WorkerClient>();
  #finding: Promise<void> | undefined;
  #seams: Promise<Seams> | undefined;
  /** The colours, if the file has any, once they are found. */
  colours: FileColours | undefined;
  /** What is not drawn, a sentence each. */
  notes: readonly string[] = [];

  constructor(mesh: FileMesh, kept: Kept) {
    this.#mesh = mesh;
    this.#kept = kept;
  }

  /** Finds the colours. */
  find(): Promise<void> {
    return (this.#finding ??= this.#find());
  }

  /** The seams of the mesh. */
  seams(): Promise<Seams> {
    return (this.#seams ??= this.#beside((client) => client.call((worker) => worker.seams(this.#mesh, this.#kept))));
  }

  /** Ends what still searches. */
  close(): void {
    for (const client of this.#clients) client.close();
  }

  async #find(): Promise<void> {
    const { positions, indices, dropped } = this.#mesh;
    // A file without further content has no colours.
    if (dropped.length === 0) return;
    const sizes = { vertices: positions.length / widthOf(this.#mesh), triangles: indices.length / 3, dropped };
    try {
      const found = await this.#beside((client) => client.call((worker) => worker.colours(this.#kept, sizes)));
      this.colours = found.colours;
      this.notes = found.notes;
    } catch (error) {
      const why = error instanceof Error ? error.message.replace(/\.$/, '') : String(error);
      this.notes = [`The colours of the file are not drawn (${why}).`];
    }
  }

  /** Calls a worker of its own, so that measures need not wait, and its memory is freed afterwards. */
  async #beside<T>(work: (client: WorkerClient) => Promise<T>): Promise<T> {
    const client = new WorkerClient();
    this.#clients.add(client);
    try {
      return await work(client);
    } finally {
      client.close();
      this.#clients.delete(client);
    }
  }
}
