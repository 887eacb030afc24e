/** The names of options: one that is not known is an error, so that a slip of the pen is no silent default. */

import { EdgeflipError } from './error.js';
import { objectOf, shown } from './given.js';

/** The names of all fields of `O`: TypeScript refuses a list that lacks one. */
export function namesOf<O>(names: Record<keyof O, true>): readonly string[] {
  return Object.keys(names);
}

/**
 * The object of options that was passed. Those with other names than `known` have to be `undefined`.
 *
 * @throws {@link EdgeflipError} `invalid-option`, with the nearest known name; `invalid-input` for what is no object.
 */
export function optionsOf(given: unknown, known: readonly string[], what = 'options'): Record<string, unknown> {
  const options = objectOf(given, what);
  // A list may have more entries than there is memory for their names.
  if (Array.isArray(options) || ArrayBuffer.isView(options)) {
    throw new EdgeflipError('invalid-input', `${what}: a list is not an object with options`);
  }
  for (const name of Object.keys(options)) {
    if (known.includes(name) || options[name] === undefined) continue;
    throw new EdgeflipError('invalid-option', `${shownName(name)} is not an option; ${advice(name, known)}`);
  }
  return options;
}

function advice(name: string, known: readonly string[]): string {
  const distances = known.map((other) => distance(plain(name), plain(other)));
  const least = Math.min(...distances);
  const nearest = known[distances.indexOf(least)];
  if (nearest !== undefined && 2 * least < nearest.length) return `did you mean ${nearest}?`;
  return known.length > 0 ? `there are ${known.join(', ')}` : 'there are none';
}

/** A short name as it is, a long one or a strange one as text. */
function shownName(name: string): string {
  return /^\w{1,40}$/.test(name) ? name : shown(name);
}

/** Without what styles of names differ in. */
function plain(name: string): string {
  return name.slice(0, 40).replace(/[-_]/g, '').toLowerCase();
}

/** How many characters to insert, delete or replace: the edit distance of Levenshtein. */
function distance(from: string, to: string): number {
  let row = Array.from({ length: to.length + 1 }, (_, i) => i);
  for (let i = 0; i < from.length; i++) {
    const next = [i + 1];
    for (let j = 0; j < to.length; j++) {
      next.push(Math.min(row[j]! + Number(from[i] !== to[j]), row[j + 1]! + 1, next[j]! + 1));
    }
    row = next;
  }
  return row[to.length]!;
}
