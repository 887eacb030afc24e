/** What an iteration has changed, kept so that it can be taken back and done again. */

/** Places in the indices, and what was there xor what is there now: the same in both directions. */
export interface Change {
  at: Uint32Array<ArrayBuffer>;
  xor: Uint32Array<ArrayBuffer>;
}

/** What turns `before` into `now`. */
export function changeOf(before: Uint32Array, now: Uint32Array): Change {
  let count = 0;
  for (let i = 0; i < now.length; i++) if (before[i] !== now[i]) count++;
  const change = { at: new Uint32Array(count), xor: new Uint32Array(count) };
  for (let i = 0, k = 0; k < count; i++) {
    const difference = before[i]! ^ now[i]!;
    if (difference !== 0) {
      change.at[k] = i;
      change.xor[k++] = difference;
    }
  }
  return change;
}

/** Turns the state before the iteration into that after it, or back. */
export function applyChange(indices: Uint32Array, { at, xor }: Change): void {
  for (let k = 0; k < at.length; k++) indices[at[k]!]! ^= xor[k]!;
}

/** The lines around all triangles, as indices: 6 a triangle. */
export function writeLines(lines: Uint32Array, indices: Uint32Array): void {
  for (let h = 0; h < indices.length; h++) {
    lines[2 * h] = indices[h]!;
    lines[2 * h + 1] = indices[h % 3 === 2 ? h - 2 : h + 1]!;
  }
}
