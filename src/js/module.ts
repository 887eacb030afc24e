/** Loads a WebAssembly module, once. */

import { EdgeflipError } from './error.js';
import { copyOf, messageOf, read, shown, viewOf } from './given.js';
import { VERTEX_ARRAYS } from './settings.js';

/** Where the module comes from: its bytes, the module itself, a response, or an address to fetch. */
export type ModuleSource = BufferSource | WebAssembly.Module | Response | URL | string;

/** What wasm-bindgen writes to start its module. */
type Start = (options: { module_or_path: ModuleSource }) => Promise<unknown>;

/**
 * A function that loads one module. Its first call counts; after a failure the next one tries again.
 *
 * @param start - Starts the module.
 * @param place - Where the module lies if the call does not say.
 */
export function loader(start: Start, place: () => URL): (source?: ModuleSource) => Promise<void> {
  let loading: Promise<void> | undefined;
  const load = async (given: ModuleSource = place()) => {
    const source = sourceOf(given);
    await start({ module_or_path: readFile(source) ?? source });
  };
  return (source) => {
    loading ??= load(source).catch((cause: unknown) => {
      loading = undefined;
      throw new EdgeflipError('load-failed', `the WebAssembly module could not be loaded: ${messageOf(cause)}`, { cause });
    });
    return loading;
  };
}

/** What was passed, read at once. */
function sourceOf(given: ModuleSource): ModuleSource {
  if (typeof given === 'string') return given;
  const view = viewOf(given, VERTEX_ARRAYS, 'the bytes');
  if (view) return copyOf(view, 'the bytes') as Uint8Array<ArrayBuffer>;
  if (given instanceof ArrayBuffer || ArrayBuffer.isView(given)) return bytesOf(given);
  const kinds = [URL, WebAssembly.Module, Response];
  // One that has a `then` would be waited for.
  if (kinds.some((kind) => given instanceof kind) && !('then' in given)) return given;
  throw new TypeError(`${shown(given)} is no address, response, module or bytes`);
}

/** A copy of the bytes in a buffer, or in a view of any kind: V8 compiles no DataView. */
function bytesOf(given: ArrayBuffer | ArrayBufferView): Uint8Array<ArrayBuffer> {
  return read('the bytes', () => {
    const bytes = ArrayBuffer.isView(given) ? new Uint8Array(given.buffer, given.byteOffset, given.byteLength) : new Uint8Array(given);
    return new Uint8Array(bytes);
  });
}

/** The module of a source, without an instance. */
export async function compile(source: ModuleSource): Promise<WebAssembly.Module> {
  if (source instanceof WebAssembly.Module) return source;
  if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(source);
  const response = source instanceof Response ? source : await fetch(source as URL | string);
  if (!response.ok) throw new Error(`HTTP status ${response.status}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

/** The bytes of a file in Node, whose `fetch` knows no files. No import: a bundler would look for it. */
function readFile(source: ModuleSource): BufferSource | undefined {
  if (!(source instanceof URL) || source.protocol !== 'file:') return undefined;
  if (typeof process === 'undefined') return undefined;
  const bytes = process.getBuiltinModule?.('node:fs').readFileSync(source);
  return bytes && new Uint8Array(bytes);
}
