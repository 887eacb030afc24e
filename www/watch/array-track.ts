/** The triangles of a run whose engine is in a worker: they are in main memory. */

import { applyChange, writeFlips, type Change, type Moment } from './change.ts';
import type { Step, Track } from './run.ts';

export class ArrayTrack implements Track {
  readonly #indices: Uint32Array;
  readonly #changes: Change[] = [];
  #sides: Uint32Array | undefined;

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

  flipping(index: number, moment: Moment): Uint32Array {
    this.#sides ??= new Uint32Array(this.#indices.length / 3);
    writeFlips(this.#sides, this.#changes[index]!, moment);
    return this.#sides;
  }

  async triangles(): Promise<Uint32Array> {
    return this.#indices.slice();
  }

  free(): void {
    this.#changes.length = 0;
  }
}
