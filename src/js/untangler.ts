/** The module of the repair, and what it gives. */

import type * as wasm from './wasm/edgeflip_untangle.js';

/** A mesh before its first run, after a repair. */
export interface Begun {
  indices: Uint32Array;
  /** The locked edges that it has, two vertices per edge. */
  lockedEdges: Uint32Array;
  /** Those that it has lost. */
  lostEdges: Uint32Array;
}

/** What the modules of the engines call: as `Untangler.repaired` for the mesh with this key. */
export interface UntangleModule {
  repaired(key: object, ...mesh: Parameters<wasm.Untangler['repaired']>): Uint32Array;
}

/** The exports of the module. It starts once. */
export async function started(module: WebAssembly.Module): Promise<typeof wasm> {
  const exports = await import('./wasm/edgeflip_untangle.js');
  await exports.default({ module_or_path: module });
  return exports;
}

/** The module, for those of the engines. A mesh that is gone frees what the module keeps for it. */
export async function untanglerOf(module: WebAssembly.Module): Promise<UntangleModule> {
  const { Untangler } = await started(module);
  const untanglers = new WeakMap<object, wasm.Untangler>();
  return {
    repaired(key, ...mesh) {
      let untangler = untanglers.get(key);
      if (!untangler) untanglers.set(key, (untangler = new Untangler()));
      return untangler.repaired(...mesh);
    },
  };
}
