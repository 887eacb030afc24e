/**
 * The entry `edgeflip` with the module of the engines inside the script, so that no file has to be served: for bundlers
 * that do not copy WebAssembly, for a single file, for strict hosts. Same names, same results. The other modules are
 * files as before: `init` says where they are, if a run needs one.
 *
 * ```ts
 * import { makeDelaunay } from 'edgeflip/inline';
 * ```
 *
 * @packageDocumentation
 */

import core from './inline-core.js';
import { inlineCore } from './load.js';

export * from './index.js';

inlineCore(async () => {
  const packed = Uint8Array.from(atob(core), (letter) => letter.charCodeAt(0));
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(unpacked).arrayBuffer();
});
