/** The triangles of a run whose engine is in a worker: they are in main memory. */

import { applyChange, type Change, writeLines } from './change.ts';
import type { Step, Track } from './run.ts';

export class ArrayTrack implements Track {
  readonly #indices: Uint32Array;
  readonly #changes: Change[] = [];
  #lines: Uint32Array | undefined;

  constructor(indices: Uint32Array) {
    this.#indices = indices.slice();
  }

  async record({ change }: Step): Promise<void> {
    if (!change) throw new Error('an iteration came without its change');
    this.#changes.push(change);
    applyChange(this.#indices, change);
  }

  apply(index: number): void {
    applyChange(this.#indices, this.#changes[index]!);
  }

  drawn(): Uint32Array {
    return this.#indices;
  }

  lines(): Uint32Array {
    this.#lines ??= new Uint32Array(2 * this.#indices.length);
    writeLines(this.#lines, this.#indices);
    return this.#lines;
  }

  async triangles(): Promise<Uint32Array> {
    return this.#indices.slice();
  }

  free(): void {
    this.#changes.length = 0;
  }
}
