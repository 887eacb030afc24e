/** Loads the WebAssembly module, once. */

import initModule from './wasm/edgeflip.js';
import { EdgeflipError } from './error.js';

/** Where the module comes from: its bytes, the module itself, a response, or an address to fetch. */
export type ModuleSource = BufferSource | WebAssembly.Module | Response | URL | string;

let loading: Promise<void> | undefined;

/**
 * Loads the WebAssembly module. Everything else calls it by itself: call it to load early, or with a source where the
 * module does not lie beside this file. The first call counts; after a failure the next one tries again.
 *
 * @throws {@link EdgeflipError} `load-failed`.
 */
export function init(source?: ModuleSource): Promise<void> {
  loading ??= load(source).catch((cause: unknown) => {
    loading = undefined;
    const message = cause instanceof Error ? cause.message : String(cause);
    throw new EdgeflipError('load-failed', `the WebAssembly module could not be loaded: ${message}`, { cause });
  });
  return loading;
}

async function load(source: ModuleSource | undefined): Promise<void> {
  const address = source ?? new URL('./wasm/edgeflip_bg.wasm', import.meta.url);
  await initModule({ module_or_path: readFile(address) ?? address });
}

/** The bytes of a file in Node, whose `fetch` knows no files. No import: a bundler would look for it. */
function readFile(source: ModuleSource): BufferSource | undefined {
  if (!(source instanceof URL) || source.protocol !== 'file:') return undefined;
  if (typeof process === 'undefined') return undefined;
  const bytes = process.getBuiltinModule?.('node:fs').readFileSync(source);
  return bytes && new Uint8Array(bytes);
}
