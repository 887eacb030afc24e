/**
 * Reads the arguments of callers once, before the first wait, so that later changes have no effect. A program without
 * types may pass anything, and so may a hostile one. This file therefore trusts no getter of an object, and reports an
 * exception of one as an error of the input.
 */

import { EdgeflipError, type ErrorCode } from './error.js';
import type { IndexArray, VertexArray } from './types.js';

/** The most bytes of an array in WebAssembly. */
const MOST_BYTES = 2 ** 31 - 1;

/** The most numbers of an array that is not a typed array. It is read number by number, and its length may be false. */
export const MOST_NUMBERS = 2 ** 24;

/**
 * Returns the result of `work`, which reads input.
 *
 * @throws {@link EdgeflipError} `too-large` for a RangeError, `invalid-input` for other exceptions; errors of this
 * package pass through.
 */
export function read<T>(what: string, work: () => T): T {
  try {
    return work();
  } catch (cause) {
    if (cause instanceof EdgeflipError) throw cause;
    const isOfMemory = cause instanceof RangeError;
    const [code, why]: [ErrorCode, string] = isOfMemory
      ? ['too-large', 'there is no memory for a copy']
      : ['invalid-input', messageOf(cause)];
    throw new EdgeflipError(code, `${what} cannot be read: ${why}`, { cause });
  }
}

/** The message of an error, whatever was thrown. */
export function messageOf(thrown: unknown): string {
  try {
    return thrown instanceof Error ? `${thrown.message}` : String(thrown);
  } catch {
    return 'a value that is not an error was thrown';
  }
}

/** A value, for a message. */
export function shown(value: unknown): string {
  if (typeof value === 'string') return `'${value.length > 40 ? `${value.slice(0, 40)}…` : value}'`;
  if (typeof value === 'function') return 'a function';
  if (typeof value === 'bigint') return `${value}n`;
  if (typeof value !== 'object' || value === null) return String(value);
  const name: unknown = nameOf.call(value);
  if (typeof name === 'string') return `a ${name}`;
  try {
    return Array.isArray(value) ? 'a list' : 'an object';
  } catch {
    return 'an object';
  }
}

/** @throws {@link EdgeflipError} `invalid-input` if the value is not an object. */
export function objectOf(given: unknown, what: string): Record<string, unknown> {
  if (typeof given === 'object' && given !== null) return given as Record<string, unknown>;
  throw new EdgeflipError('invalid-input', `${what}: ${shown(given)} is not an object`);
}

/** @throws {@link EdgeflipError} `invalid-input` if the value is neither a function nor absent. */
export function functionOf<F>(given: F, what: string): NonNullable<F> | undefined {
  if (given === undefined || given === null) return undefined;
  if (typeof given === 'function') return given;
  throw new EdgeflipError('invalid-input', `${what}: ${shown(given)} is not a function`);
}

const TypedArray = Object.getPrototypeOf(Uint8Array.prototype) as object;
const own = (name: string | symbol) => Object.getOwnPropertyDescriptor(TypedArray, name)!.get!;
const [nameOf, bufferOf, offsetOf, lengthOf] = [
  own(Symbol.toStringTag),
  own('buffer'),
  own('byteOffset'),
  own('length'),
];

const KINDS = {
  Int8Array,
  Uint8Array,
  Uint8ClampedArray,
  Int16Array,
  Uint16Array,
  Int32Array,
  Uint32Array,
  Float32Array,
  Float64Array,
};
type Kind = keyof typeof KINDS;

/** The kinds of typed arrays that hold whole numbers. */
export const INTEGERS = [
  ...(['Uint32Array', 'Uint16Array', 'Uint8Array', 'Uint8ClampedArray'] as const),
  ...(['Int32Array', 'Int16Array', 'Int8Array'] as const),
] as const;

/** The kinds of typed arrays that hold numbers. */
export const NUMBERS = [...INTEGERS, 'Float32Array', 'Float64Array'] as const;

/**
 * A view of the typed array, if it is of one of these kinds; it may come from another window. Only the getters of the
 * language are used: overrides in subclasses are ignored, and proxies and look-alikes give `undefined`.
 *
 * @throws {@link EdgeflipError} `invalid-input` if its buffer was transferred or has shrunk.
 */
export function viewOf<K extends Kind>(
  given: unknown,
  kinds: readonly K[],
  what: string,
): InstanceType<(typeof KINDS)[K]> | undefined {
  const kind: K | undefined = kinds.find((kind) => kind === nameOf.call(given));
  if (!kind) return undefined;
  try {
    const view: VertexArray = new KINDS[kind](bufferOf.call(given), offsetOf.call(given), lengthOf.call(given));
    return view as InstanceType<(typeof KINDS)[K]>;
  } catch (cause) {
    throw new EdgeflipError('invalid-input', `${what}: the buffer was transferred or has shrunk`, { cause });
  }
}

/**
 * A copy of a view.
 *
 * @throws {@link EdgeflipError} `too-large`, also if the array is too large for WebAssembly.
 */
export function copyOf<A extends VertexArray>(view: A, what: string): A {
  return read(what, () => itselfOf(view, what).slice() as A);
}

/**
 * The view itself, for a module that copies it before the first wait.
 *
 * @throws {@link EdgeflipError} `too-large` if the array is too large for WebAssembly.
 */
export function itselfOf<A extends VertexArray>(view: A, what: string): A {
  if (view.byteLength > MOST_BYTES) {
    throw new EdgeflipError(
      'too-large',
      `${what} have ${view.byteLength} bytes; WebAssembly allows at most ${MOST_BYTES} per array`,
    );
  }
  return view;
}

/**
 * The numbers of a typed array of integers as words, or those of an array of whole numbers of 32 bits: a copy, or the
 * Uint32Array itself. `-1` becomes 0xffffffff.
 */
export function wordsOf(given: IndexArray, what: string, code: ErrorCode = 'invalid-input'): Uint32Array {
  const view = viewOf(given, INTEGERS, what);
  if (view) return view instanceof Uint32Array ? view : new Uint32Array(view);
  const kinds = 'neither an integer array, such as a Uint32Array, nor an array of whole numbers of 32 bits';
  return new Uint32Array(listOf(given, what, isWhole, kinds, code));
}

/**
 * The numbers of an array as 32-bit floats, or as 64-bit floats if one of them is not a 32-bit float.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `too-large`.
 */
export function floatsOfList(given: unknown, what: string): Float32Array | Float64Array {
  const isNumber = (value: unknown): value is number => typeof value === 'number';
  const numbers = listOf(given, what, isNumber, 'neither a typed array nor an array of numbers');
  return read(what, () => {
    const singles = new Float32Array(numbers);
    return numbers.every((number, i) => Object.is(singles[i], number)) ? singles : new Float64Array(numbers);
  });
}

/** A copy of an array of numbers that are `wanted`. */
function listOf(
  given: unknown,
  what: string,
  wanted: (value: unknown) => value is number,
  kinds: string,
  code: ErrorCode = 'invalid-input',
): number[] {
  const wrong = (why: string) => new EdgeflipError(code, `${what}: ${why}`);
  return read(what, () => {
    if (!Array.isArray(given)) throw wrong(`${shown(given)} is ${kinds}`);
    const { length } = given;
    if (length > MOST_NUMBERS) throw wrong(`an array has at most ${MOST_NUMBERS} numbers; pass a typed array`);
    const numbers: number[] = [];
    for (let i = 0; i < length; i++) {
      const number: unknown = given[i];
      if (!wanted(number)) throw wrong(`it is ${kinds}; number ${i} is ${shown(number)}`);
      numbers.push(number);
    }
    return numbers;
  });
}

/** Whether the value is a whole number of 32 bits. */
export function isWhole(value: unknown): value is number {
  return Number.isInteger(value) && (value as number) >= 0 && (value as number) < 2 ** 32;
}
