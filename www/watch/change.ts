/** The change of an iteration, in a form that can be undone and redone. */

/** Offsets into the indices, and the old value xor the new value at each: the same change in both directions. */
export interface Change {
  at: Uint32Array<ArrayBuffer>;
  xor: Uint32Array<ArrayBuffer>;
}

/** The change from `before` to `now`. */
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

/** Applies the change of an iteration, or undoes it. */
export function applyChange(indices: Uint32Array, { at, xor }: Change): void {
  for (let k = 0; k < at.length; k++) indices[at[k]!]! ^= xor[k]!;
}

/** The outlines of all triangles, as indices of line segments: 6 per triangle. */
export function writeLines(lines: Uint32Array, indices: Uint32Array): void {
  for (let h = 0; h < indices.length; h++) {
    lines[2 * h] = indices[h]!;
    lines[2 * h + 1] = indices[h % 3 === 2 ? h - 2 : h + 1]!;
  }
}
