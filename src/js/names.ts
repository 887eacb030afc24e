/** Checks the names of options and of the fields of a mesh, so that a misspelt name is not ignored. */

import { EdgeflipError } from './error.js';
import { objectOf, shown } from './given.js';

/** The names of all fields of `O`. TypeScript refuses a list with a missing name. */
export function namesOf<O>(names: Record<keyof O, true>): readonly string[] {
  return Object.keys(names);
}

/**
 * The options as an object. An option whose name is not in `known` has to be `undefined`.
 *
 * @throws {@link EdgeflipError} `invalid-option`, with the nearest known name; `invalid-input` if it is not an object.
 */
export function optionsOf(given: unknown, known: readonly string[], what = 'options'): Record<string, unknown> {
  const options = objectOf(given, what);
  // `Object.keys` of a large list could run out of memory.
  if (isList(options)) {
    throw new EdgeflipError('invalid-input', `${what}: a list is not an object with options`);
  }
  for (const name of Object.keys(options)) {
    if (known.includes(name) || options[name] === undefined) continue;
    throw new EdgeflipError('invalid-option', `${shownName(name)} is not an option; ${advice(name, known)}`);
  }
  return options;
}

/**
 * Refuses a number or a list whose name is almost one of the `known` names that the object lacks. It may have other
 * names, because a program may pass an object that is more than a mesh.
 *
 * @throws {@link EdgeflipError} `invalid-input`, with the known name.
 */
export function checkSpelling(object: object, known: readonly string[], what: string): void {
  if (isList(object)) return;
  const missing = known.filter((name) => (object as Record<string, unknown>)[name] === undefined);
  for (const [name, value] of Object.entries(object)) {
    if (known.includes(name) || (typeof value !== 'number' && !isList(value))) continue;
    const nearest = nearestOf(name, missing);
    if (nearest)
      throw new EdgeflipError('invalid-input', `${what}: ${shownName(name)} is not known; did you mean ${nearest}?`);
  }
}

const isList = (value: unknown): boolean => Array.isArray(value) || ArrayBuffer.isView(value);

function advice(name: string, known: readonly string[]): string {
  const nearest = nearestOf(name, known);
  if (nearest) return `did you mean ${nearest}?`;
  return known.length > 0 ? `there are ${known.join(', ')}` : 'there are none';
}

/** The known name that the name is almost. */
function nearestOf(name: string, known: readonly string[]): string | undefined {
  const distances = known.map((other) => distance(plain(name), plain(other)));
  const least = Math.min(...distances);
  const nearest = known[distances.indexOf(least)];
  return nearest !== undefined && 2 * least < nearest.length ? nearest : undefined;
}

/** A short name unchanged, any other name quoted. */
function shownName(name: string): string {
  return /^\w{1,40}$/.test(name) ? name : shown(name);
}

/** The name without hyphens, underscores and capitals, so that only the letters are compared. */
function plain(name: string): string {
  return name.slice(0, 40).replace(/[-_]/g, '').toLowerCase();
}

/** The Levenshtein distance. */
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
