/** The options of a session as they were when it was asked for: read once, checked in type, copied. */

import { EdgeflipError } from './error.js';
import { copyOf, functionOf, isWhole, numbersOf, objectOf, read, shown, viewOf } from './given.js';
import type { Attributes, Files, MakeDelaunayOptions, Options, Original, RunOptions, VertexArray } from './types.js';

/** What the modules take. Values are theirs to check. */
export interface Settings {
  backend?: NonNullable<Options['backend']>;
  maxNormalAngle?: number;
  maxDeviation?: number;
  /** Absent where there is no cap. */
  maxIterations?: number;
  lockedEdges?: Uint32Array;
  lockedTriangles?: Uint32Array;
  groups?: Uint32Array;
  order?: NonNullable<Options['order']>;
  threads?: number;
  device?: GPUDevice;
}

/** What a session is asked for. */
export interface Chosen {
  settings: Settings;
  reorient: boolean;
  /** Absent where vertices stay as they are. */
  weld?: Attributes;
}

/** Each thread is a worker. */
export const MOST_THREADS = 256;

/** Attributes of vertices; no file has so many. */
const MOST_ATTRIBUTES = 1024;

/** Kinds of arrays with numbers of vertices. */
export const VERTEX_ARRAYS = [
  ...['Int8Array', 'Uint8Array', 'Uint8ClampedArray', 'Int16Array', 'Uint16Array'] as const,
  ...['Int32Array', 'Uint32Array', 'Float32Array', 'Float64Array'] as const,
] as const;

/** @throws {@link EdgeflipError} `invalid-option`, `invalid-input`. */
export function chosenOf(options: Options): Chosen {
  return read('the options', () => {
    const { backend, order, maxNormalAngle, maxDeviation, maxIterations, threads, device, ...rest } = given(options);
    const settings: Settings = {};
    if (backend !== undefined) settings.backend = oneOf('backend', backend, ['auto', 'webgpu', 'webgl2', 'cpu']);
    if (order !== undefined) settings.order = oneOf('order', order, ['reproducible', 'any']);
    if (maxNormalAngle !== undefined) settings.maxNormalAngle = numberOf('maxNormalAngle', maxNormalAngle);
    if (maxDeviation !== undefined) settings.maxDeviation = numberOf('maxDeviation', maxDeviation);
    if (maxIterations !== undefined && maxIterations !== Infinity) {
      if (!isWhole(maxIterations)) throw wrong('maxIterations', maxIterations, 'a number of iterations');
      settings.maxIterations = maxIterations;
    }
    if (threads !== undefined) {
      if (!isWhole(threads) || threads < 1 || threads > MOST_THREADS) {
        throw wrong('threads', threads, `a number of threads, 1 to ${MOST_THREADS}`);
      }
      settings.threads = threads;
    }
    if (device !== undefined) settings.device = deviceOf(device);
    const { lockedEdges, lockedTriangles, groups, reorient, weld } = rest;
    if (lockedEdges !== undefined) settings.lockedEdges = numbersOf(lockedEdges, 'lockedEdges', 'vertex indices');
    if (lockedTriangles !== undefined) settings.lockedTriangles = numbersOf(lockedTriangles, 'lockedTriangles', 'numbers of triangles');
    if (groups !== undefined) settings.groups = numbersOf(groups, 'groups', 'whole numbers');
    const chosen: Chosen = { settings, reorient: isSet('reorient', reorient) };
    if (weld === true) chosen.weld = [];
    else if (typeof weld === 'object' && weld !== null) chosen.weld = attributesOf(weld, copyOf);
    else if (weld !== undefined && weld !== false) throw wrong('weld', weld, 'true, false, a list of typed arrays or the file of the mesh');
    return chosen;
  });
}

/** What is called during a run, and what stops it. */
export interface Watch extends RunOptions {
  onIteration: NonNullable<MakeDelaunayOptions['onIteration']> | undefined;
  /** Whether the signal says to stop. */
  isStopped: () => boolean;
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function watchOf(options: MakeDelaunayOptions): Watch {
  return read('the options', () => {
    const { signal, onProgress, onIteration } = given(options);
    const watched = signal ?? undefined;
    if (watched) objectOf(watched, 'signal');
    return {
      signal: watched,
      onProgress: functionOf(onProgress, 'onProgress'),
      onIteration: functionOf(onIteration, 'onIteration'),
      isStopped: () => read('the signal', () => Boolean(watched?.aborted)),
    };
  });
}

/** Makes of an array what is kept of it. */
export type Hold = <A extends VertexArray>(view: A, what: string) => A;

/**
 * What vertices have beside positions. The arrays, and the bytes of a file, go through `hold`.
 *
 * @throws {@link EdgeflipError} `invalid-input`.
 */
export function attributesOf(attributes: Attributes, hold: Hold): readonly VertexArray[] | Required<Original> {
  return read('attributes', () => {
    if (!Array.isArray(attributes)) return originalOf(attributes as Original, hold);
    const { length } = attributes;
    if (length > MOST_ATTRIBUTES) throw new EdgeflipError('invalid-input', `there are more than ${MOST_ATTRIBUTES} attributes`);
    return Array.from({ length }, (_, i) => {
      const view = viewOf(attributes[i], VERTEX_ARRAYS, 'attributes');
      if (!view) throw new EdgeflipError('invalid-input', `attribute ${i}: ${shown(attributes[i])} is not a typed array`);
      return hold(view, 'attributes');
    });
  });
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function originalOf(original: Original, hold: Hold): Required<Original> {
  return read('the original', () => {
    const { bytes, name, files, maxBytes } = objectOf(original, 'original') as unknown as Original;
    return {
      bytes: hold(bytesOf(bytes, 'original.bytes'), 'original.bytes'),
      name: textOf(name, 'original.name'),
      files: filesOf(files, hold),
      maxBytes: maxBytesOf(maxBytes),
    };
  });
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function bytesOf(given: Uint8Array, what: string): Uint8Array {
  const view = viewOf(given, ['Uint8Array'], what);
  if (view) return view;
  throw new EdgeflipError('invalid-input', `${what}: ${shown(given)} is not a Uint8Array`);
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function filesOf(given: Files | undefined, hold: Hold): Files {
  if (given === undefined) return {};
  return read('files', () => {
    const entries = Object.entries(objectOf(given, 'files'));
    return Object.fromEntries(entries.map(([name, bytes]) => [name, hold(bytesOf(bytes as Uint8Array, `files: ${shown(name)}`), 'files')]));
  });
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function maxBytesOf(given: number | undefined): number | undefined {
  if (given === undefined || typeof given === 'number') return given;
  throw new EdgeflipError('invalid-input', `maxBytes: ${shown(given)} is not a number`);
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function textOf(given: string, what: string): string {
  if (typeof given === 'string') return given;
  throw new EdgeflipError('invalid-input', `${what}: ${shown(given)} is not a string`);
}

function given<O>(options: O): O {
  return objectOf(options, 'options') as unknown as O;
}

function wrong(option: keyof Options, value: unknown, known: string): EdgeflipError {
  return new EdgeflipError('invalid-option', `option ${option}: ${shown(value)} is not ${known}`);
}

function oneOf<T extends string>(option: keyof Options, value: unknown, known: readonly T[]): T {
  const found = known.find((name) => name === value);
  if (found) return found;
  const names = known.map((name) => `'${name}'`);
  throw wrong(option, value, `${names.slice(0, -1).join(', ')} or ${names.at(-1)}`);
}

function numberOf(option: keyof Options, value: unknown): number {
  if (typeof value === 'number') return value;
  throw wrong(option, value, 'a number');
}

function isSet(option: keyof Options, value: unknown): boolean {
  if (value === undefined || typeof value === 'boolean') return value ?? false;
  throw wrong(option, value, 'true or false');
}

/** One of this window or worker: its own getter knows it. */
function deviceOf(device: unknown): GPUDevice {
  try {
    const limits = Object.getOwnPropertyDescriptor(GPUDevice.prototype, 'limits')?.get;
    limits?.call(device);
    if (limits) return device as GPUDevice;
  } catch {
    // Not even a browser with WebGPU.
  }
  throw wrong('device', device, 'a GPUDevice of this window or worker');
}
