/** Loads the module of the repair for a session. */

import { moduleOfUntangler } from './load.js';
import type { ModuleSession } from './threads.js';
import { untanglerOf } from './untangler.js';
import { setUntangler } from './wasm/edgeflip.js';

/** Gives the module to that of the engines, here or in a thread. */
export async function supply(session: ModuleSession): Promise<void> {
  const module = await moduleOfUntangler();
  if (session.takeUntangler) await session.takeUntangler(module);
  else setUntangler(await untanglerOf(module));
}
