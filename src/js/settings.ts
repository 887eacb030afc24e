/** Reads the options of a session once: checks their types and copies them. */

import { EdgeflipError } from './error.js';
import { copyOf, functionOf, isWhole, NUMBERS, objectOf, read, shown, viewOf, wordsOf } from './given.js';
import { namesOf, optionsOf } from './names.js';
import {
  type Attributes,
  type Files,
  type GpuDevice,
  type IndexArray,
  type MakeDelaunayOptions,
  OPTION_KINDS,
  type Options,
  type Original,
  type RunOptions,
  type SyncOptions,
  type VertexArray,
} from './types.js';

/**
 * The options as they are passed to the modules: one object. `src/wasm/options.rs` reads it, and the library checks the
 * values.
 */
export type Settings = { [Name in keyof Omit<Options, 'weld'>]?: Read<NonNullable<Options[Name]>> } & {
  /** Absent if no vertices are joined. */
  weld?: Attributes;
  /** The locked edges that the mesh lost when it was untangled before the session. */
  lostEdges?: Uint32Array;
};

/** The settings for the module of the engines, and memory for the triangles of the result. */
export type GpuSettings = Settings & { leavesCpu?: boolean; spare?: Promise<Uint32Array | undefined> | undefined };

/** The type of an option after reading: a list becomes a Uint32Array. */
type Read<T> = [T] extends [IndexArray] ? Uint32Array : T;

/** The most iterations of an update. A test in `src/system/threads.rs` compares it with the limit of the modules. */
export const MOST_ITERATIONS = 64;

/** The most attributes of vertices: more than any file has. */
const MOST_ATTRIBUTES = 1024;

/** The names of the options of a session, of a run, and of the functions of the entries. */
const SESSION_OPTIONS: readonly string[] = Object.keys(OPTION_KINDS);
export const RUN_OPTIONS = namesOf<RunOptions>({ signal: true, onProgress: true });
export const MAKE_OPTIONS = [
  ...SESSION_OPTIONS,
  ...namesOf<Omit<MakeDelaunayOptions, keyof Options>>({ signal: true, onProgress: true, onIteration: true }),
];
export const WORKER_OPTIONS = withoutDevice(SESSION_OPTIONS);
export const WORKER_MAKE_OPTIONS = withoutDevice(MAKE_OPTIONS);
export const SYNC_OPTIONS = namesOf<SyncOptions>({
  maxNormalAngle: true,
  maxDeviation: true,
  maxIterations: true,
  lockedEdges: true,
  lockedTriangles: true,
  groups: true,
  order: true,
});

/**
 * The options of a session.
 *
 * @param known - The names of the options that are allowed.
 * @throws {@link EdgeflipError} `invalid-option`, `invalid-input`.
 */
export function settingsOf(options: Options, known = SESSION_OPTIONS): Settings {
  return read('the options', () => {
    const given = optionsOf(options, known);
    const settings: Record<string, unknown> = {};
    for (const [name, kind] of Object.entries(OPTION_KINDS)) {
      const value = given[name];
      const kept =
        value === undefined
          ? undefined
          : typeof kind === 'object'
            ? oneOf(name, value, kind)
            : READERS[kind](name, value);
      if (kept !== undefined) settings[name] = kept;
    }
    return settings;
  });
}

type Kind = (typeof OPTION_KINDS)[keyof Options];

/** Check a value and return it, copied if it is an array; `undefined` stands for the default. */
const READERS: Record<Extract<Kind, string>, (option: string, value: unknown) => unknown> = {
  flag: (option, value) => {
    if (typeof value === 'boolean') return value;
    throw wrong(option, value, 'true or false');
  },
  number: (option, value) => {
    if (typeof value === 'number') return value;
    throw wrong(option, value, 'a number');
  },
  whole: (option, value) => {
    if (isWhole(value)) return value;
    throw wrong(option, value, 'a whole number of 32 bits');
  },
  limit: (option, value) => {
    if (value === Infinity) return undefined;
    if (isWhole(value)) return value;
    throw wrong(option, value, 'a whole number of 32 bits or Infinity');
  },
  list: (option, value) => copyOf(wordsOf(value as IndexArray, `option ${option}`, 'invalid-option'), option),
  attributes: (option, value) => {
    if (value === true) return [];
    if (value === false) return undefined;
    if (typeof value === 'object' && value !== null) return attributesOf(value as Attributes, copyOf);
    throw wrong(option, value, 'true, false, a list of typed arrays or the file of the mesh');
  },
  device: deviceOf,
};

function withoutDevice(names: readonly string[]): readonly string[] {
  return names.filter((name) => name !== 'device');
}

/** The callbacks and the signal of a run. */
export interface Watch extends RunOptions {
  onIteration: NonNullable<MakeDelaunayOptions['onIteration']> | undefined;
  /** Whether the signal says to stop. */
  isStopped: () => boolean;
}

/**
 * The options of a run.
 *
 * @param known - The names of the options that are allowed, unless `settingsOf` checks them.
 * @throws {@link EdgeflipError} `invalid-input`, `invalid-option`.
 */
export function watchOf(options: MakeDelaunayOptions, known?: readonly string[]): Watch {
  return read('the options', () => {
    const given = known ? optionsOf(options, known) : objectOf(options, 'options');
    const { signal, onProgress, onIteration } = given as MakeDelaunayOptions;
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

/** Copies an array, or returns it unchanged. */
export type Hold = <A extends VertexArray>(view: A, what: string) => A;

/**
 * Checks the attributes of vertices. `hold` copies the arrays, or the bytes of a file, or returns them.
 *
 * @throws {@link EdgeflipError} `invalid-input`.
 */
export function attributesOf(attributes: Attributes, hold: Hold): readonly VertexArray[] | Required<Original> {
  return read('attributes', () => {
    if (!Array.isArray(attributes)) return originalOf(attributes as Original, hold);
    const { length } = attributes;
    if (length > MOST_ATTRIBUTES)
      throw new EdgeflipError('invalid-input', `there are more than ${MOST_ATTRIBUTES} attributes`);
    return Array.from({ length }, (_, i) => {
      const view = viewOf(attributes[i], NUMBERS, 'attributes');
      if (!view)
        throw new EdgeflipError('invalid-input', `attribute ${i}: ${shown(attributes[i])} is not a typed array`);
      return hold(view, 'attributes');
    });
  });
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function originalOf(original: Original, hold: Hold): Required<Original> {
  return read('the original', () => {
    const given = objectOf(original, 'original') as unknown as Original;
    const { bytes, name, files, maxBytes, coordinates, ignoreAttributes } = given;
    return {
      bytes: hold(bytesOf(bytes, 'original.bytes'), 'original.bytes'),
      name: textOf(name, 'original.name'),
      files: filesOf(files, hold),
      maxBytes: maxBytesOf(maxBytes),
      coordinates: coordinatesOf(coordinates),
      ignoreAttributes: attributeNamesOf(ignoreAttributes),
    };
  });
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function bytesOf(given: Uint8Array, what: string): Uint8Array {
  const view = viewOf(given, ['Uint8Array'], what);
  if (view) return view;
  throw new EdgeflipError('invalid-input', `${what}: ${shown(given)} is not a Uint8Array`);
}

/** Returns the bytes of the file with this name, or `undefined` if there is none. */
export type FindFile = (name: string) => Uint8Array | undefined;

/** The files that a function finds. The module looks them up by name and ignores errors, so they go to `failures`. */
export function foundBy(find: FindFile, failures: unknown[]): Files {
  const get = (_: Files, name: string | symbol) => {
    try {
      return find(String(name));
    } catch (error) {
      failures.push(error);
      return undefined;
    }
  };
  return new Proxy({}, { get });
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function filesOf(given: Files | undefined, hold: Hold): Files {
  if (given === undefined) return {};
  return read('files', () => {
    const entries = Object.entries(objectOf(given, 'files'));
    return Object.fromEntries(
      entries.map(([name, bytes]) => [name, hold(bytesOf(bytes as Uint8Array, `files: ${shown(name)}`), 'files')]),
    );
  });
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function maxBytesOf(given: number | undefined): number | undefined {
  if (given === undefined || typeof given === 'number') return given;
  throw new EdgeflipError('invalid-input', `maxBytes: ${shown(given)} is not a number`);
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function coordinatesOf(given: 32 | 64 | undefined): 32 | 64 | undefined {
  if (given === undefined || given === 32 || given === 64) return given;
  throw new EdgeflipError('invalid-input', `coordinates: ${shown(given)} is not 32 or 64`);
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function attributeNamesOf(given: readonly string[] | undefined): string[] {
  if (given === undefined) return [];
  const length = Array.isArray(given) ? given.length : Infinity;
  if (length > MOST_ATTRIBUTES) {
    const most = `a list of at most ${MOST_ATTRIBUTES} names`;
    throw new EdgeflipError('invalid-input', `ignoreAttributes: ${shown(given)} is not ${most}`);
  }
  return Array.from({ length }, (_, i) => textOf(given[i]!, `ignoreAttributes: name ${i}`));
}

/** @throws {@link EdgeflipError} `invalid-input`. */
export function textOf(given: string, what: string): string {
  if (typeof given === 'string') return given;
  throw new EdgeflipError('invalid-input', `${what}: ${shown(given)} is not a string`);
}

function wrong(option: string, value: unknown, known: string): EdgeflipError {
  return new EdgeflipError('invalid-option', `option ${option}: ${shown(value)} is not ${known}`);
}

function oneOf(option: string, value: unknown, known: readonly string[]): string {
  const found = known.find((name) => name === value);
  if (found) return found;
  const names = known.map((name) => `'${name}'`);
  throw wrong(option, value, `${names.slice(0, -1).join(', ')} or ${names.at(-1)}`);
}

/** Accepts only a device of this window or worker: the getter of its `GPUDevice` throws for other objects. */
function deviceOf(option: string, device: unknown): GpuDevice {
  try {
    const limits = Object.getOwnPropertyDescriptor(GPUDevice.prototype, 'limits')?.get;
    limits?.call(device);
    if (limits) return device as GpuDevice;
  } catch {
    // Not a device of this window, or a browser without WebGPU.
  }
  throw wrong(option, device, 'a GPUDevice of this window or worker');
}
