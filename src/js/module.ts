/** Loads WebAssembly modules, each once. */

import { EdgeflipError } from './error.js';
import { copyOf, messageOf, NUMBERS, read, shown, viewOf } from './given.js';
import { optionsOf } from './names.js';

/** Where a module comes from: its bytes, the module itself, a response, or a URL to fetch. */
export type ModuleSource = BufferSource | WebAssembly.Module | Response | URL | string;

/** Where the WebAssembly modules come from: one URL for all, or a source for each. */
export interface Sources {
  /**
   * The URL of a folder that holds the files of the package's `dist/wasm`, under the same names. Modules without their
   * own source are loaded from it.
   */
  base?: URL | string | undefined;
  /** The engines, for every run: `edgeflip_bg.wasm`. */
  core?: ModuleSource | undefined;
  /** The WebGL2 engine: `edgeflip_webgl2_bg.wasm`. */
  webgl2?: ModuleSource | undefined;
  /** The CPU engine on several threads: `edgeflip_threads_bg.wasm`. */
  threads?: ModuleSource | undefined;
  /** The repair of triangles that have turned over, for the option `untangle`: `edgeflip_untangle_bg.wasm`. */
  untangle?: ModuleSource | undefined;
  /** The audit, for `FlipSession.verify`: `edgeflip_audit_bg.wasm`. */
  audit?: ModuleSource | undefined;
  /** The entry `edgeflip/files`, and the options `weld` and `reorient`: `edgeflip_files_bg.wasm`. */
  files?: ModuleSource | undefined;
}

/** Where the modules of the entry `edgeflip/points` come from. */
export interface PointsSources extends Pick<Sources, 'base'> {
  /** For calls on one thread: `edgeflip_points_bg.wasm`. */
  points?: ModuleSource | undefined;
  /** For calls on several threads: `edgeflip_points_threads_bg.wasm`. */
  threads?: ModuleSource | undefined;
  /** For points that move: `edgeflip_point_session_bg.wasm`. */
  session?: ModuleSource | undefined;
}

/** The function of wasm-bindgen that starts a module. */
type Start = (options: { module_or_path: ModuleSource }) => Promise<unknown>;

/** Loads one module. */
type Load = (source?: ModuleSource) => Promise<void>;

/** The URL of the folder with the modules, if `init` was given one. */
let base: string | undefined;

/**
 * A function that loads one module at its first call. After a failure, the next call tries again.
 *
 * @param start - Starts the module.
 * @param file - The name of the module's file.
 * @param beside - The default URL of the module, in an expression that bundlers recognize.
 * @param inline - The bytes of the module, if the script has them; they come before `base`.
 */
export function loader(
  start: Start,
  file: string,
  beside: () => URL,
  inline: () => Promise<ArrayBuffer> | undefined = () => undefined,
): Load {
  let loading: Promise<void> | undefined;
  return (given) => {
    const place = given ?? (base === undefined ? beside() : absolute(base + file));
    const load = async () => {
      const bytes = given === undefined ? inline() : undefined;
      const source = bytes ? await bytes : sourceOf(place);
      await start({ module_or_path: readFile(source) ?? source });
    };
    loading ??= load().catch((cause: unknown) => {
      loading = undefined;
      throw failed(cause, file, place);
    });
    return loading;
  };
}

/**
 * The function `init` of an entry.
 *
 * @param first - The module that `init` loads if its caller names none.
 */
export function initOf<Name extends Exclude<keyof Sources | keyof PointsSources, 'base'>>(
  first: NoInfer<Name>,
  loads: Record<Name, Load>,
): (sources?: Pick<Sources & PointsSources, Name | 'base'>) => Promise<void> {
  const names = Object.keys(loads) as Name[];
  return async (sources) => {
    const named = read('the sources', () => {
      const { base: folder, ...given } = sourcesOf(sources, first, names);
      if (folder !== undefined) base = folder;
      return Object.entries(given) as [Name, ModuleSource][];
    });
    if (named.length === 0) return loads[first]();
    await Promise.all(named.map(([name, source]) => loads[name](source)));
  };
}

/**
 * Checks and copies sources.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `invalid-option`, `load-failed`.
 */
export function sourcesOf(
  sources: unknown,
  first: string,
  names: readonly string[],
): Partial<Record<string, ModuleSource>> & { base?: string } {
  if (sources === undefined) return {};
  if (isSource(sources)) throw new EdgeflipError('invalid-input', `name the module of a source: init({ ${first}: … })`);
  const { base: folder, ...given } = optionsOf(sources, ['base', ...names], 'the sources') as Sources;
  const named = Object.entries(given).filter(([, source]) => source !== undefined);
  const read = named.map(([name, source]) => [name, attempt(() => sourceOf(source as ModuleSource))] as const);
  return { ...Object.fromEntries(read), ...(folder !== undefined && { base: folderOf(folder) }) };
}

/** Returns the result of `work`. An exception becomes `load-failed`. */
function attempt<T>(work: () => T): T {
  try {
    return work();
  } catch (cause) {
    throw failed(cause);
  }
}

/** The error of a module that could not be loaded: which one, from where, and what to do. */
function failed(cause: unknown, file = 'the WebAssembly module', place?: ModuleSource): EdgeflipError {
  const url = typeof place === 'string' || place instanceof URL ? ` from ${place}` : '';
  const remedy = url ? `; serve the package's dist/wasm/${file} there, or pass init the URL or the bytes of it` : '';
  return new EdgeflipError('load-failed', `${file} could not be loaded${url}: ${messageOf(cause)}${remedy}`, { cause });
}

/** The URL of a folder, with a slash at its end. */
function folderOf(given: unknown): string {
  const url = given instanceof URL ? given.href : given;
  if (typeof url !== 'string') throw new EdgeflipError('invalid-input', `base: ${shown(given)} is not a URL`);
  return url === '' || url.endsWith('/') ? url : `${url}/`;
}

/** An absolute URL becomes a URL object, which `readFile` needs; a relative one stays a string. */
function absolute(url: string): URL | string {
  return /^[a-z][-+.\w]*:/i.test(url) ? new URL(url) : url;
}

/** Checks a source and copies its bytes. */
function sourceOf(given: ModuleSource): ModuleSource {
  if (typeof given === 'string') return given;
  const view = viewOf(given, NUMBERS, 'the bytes');
  if (view) return copyOf(view, 'the bytes') as Uint8Array<ArrayBuffer>;
  if (given instanceof ArrayBuffer || ArrayBuffer.isView(given)) return bytesOf(given);
  // An `await` would call the `then` of a source.
  if (isSource(given) && !('then' in given)) return given;
  throw new TypeError(`${shown(given)} is not a URL, Response, WebAssembly.Module or bytes`);
}

/** Whether the value is a source other than a string or bytes. */
function isSource(given: unknown): given is URL | WebAssembly.Module | Response {
  return [URL, WebAssembly.Module, Response].some((kind) => given instanceof kind);
}

/** A copy of the bytes of a buffer or a view, as a Uint8Array: V8 does not compile a DataView. */
function bytesOf(given: ArrayBuffer | ArrayBufferView): Uint8Array<ArrayBuffer> {
  return read('the bytes', () => {
    const bytes = ArrayBuffer.isView(given)
      ? new Uint8Array(given.buffer, given.byteOffset, given.byteLength)
      : new Uint8Array(given);
    return new Uint8Array(bytes);
  });
}

/** Compiles the module of a source. */
export async function compile(source: ModuleSource): Promise<WebAssembly.Module> {
  if (source instanceof WebAssembly.Module) return source;
  if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(source);
  const response = source instanceof Response ? source : await fetch(source as URL | string);
  if (!response.ok) throw new Error(`HTTP status ${response.status}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

/**
 * The bytes of a file in Node, whose `fetch` does not support `file:`. An import of `node:fs` would fail in bundlers.
 */
function readFile(source: ModuleSource): BufferSource | undefined {
  if (!(source instanceof URL) || source.protocol !== 'file:') return undefined;
  const bytes = globalThis.process?.getBuiltinModule?.('node:fs').readFileSync(source);
  return bytes && new Uint8Array(bytes);
}
