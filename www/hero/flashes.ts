/** The edges that have just flipped, and how they cool. */

/** Seconds in which the heat falls to a third. */
const COOLING = 0.38;
/** An edge is cold below this heat. */
const COLD = 0.02;

export class Flashes {
  /** The heat of edges that have flipped: 1 at the flip, then less. */
  readonly #heats = new Map<number, number>();
  readonly #vertices: number;

  constructor(vertices: number) {
    this.#vertices = vertices;
  }

  /** From 0, cold, to 1. */
  heatOf(a: number, b: number): number {
    return this.#heats.size === 0 ? 0 : (this.#heats.get(this.#key(a, b)) ?? 0);
  }

  /**
   * Takes over an update: the edges of triangles that it changed, and that no triangle had before, flash.
   *
   * @param changes - For each triangle the number of the update that changed it last.
   */
  take(before: Uint32Array, now: Uint32Array, changes: Uint32Array, update: number): void {
    const changed: number[] = [];
    changes.forEach((last, t) => last === update && changed.push(3 * t));
    const sides = (indices: Uint32Array) => changed.flatMap((t) => this.#sidesOf(indices, t));
    const [old, present] = [new Set(sides(before)), new Set(sides(now))];
    for (const key of old) if (!present.has(key)) this.#heats.delete(key);
    for (const key of present) if (!old.has(key)) this.#heats.set(key, 1);
  }

  cool(seconds: number): void {
    const factor = Math.exp(-seconds / COOLING);
    for (const [key, heat] of this.#heats) {
      if (factor * heat < COLD) this.#heats.delete(key);
      else this.#heats.set(key, factor * heat);
    }
  }

  #sidesOf(indices: Uint32Array, t: number): number[] {
    const [a, b, c] = [indices[t]!, indices[t + 1]!, indices[t + 2]!];
    return [this.#key(a, b), this.#key(b, c), this.#key(c, a)];
  }

  #key(a: number, b: number): number {
    return Math.min(a, b) * this.#vertices + Math.max(a, b);
  }
}
