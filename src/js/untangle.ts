/** Calls of a session that may need the module of the repair. */

import { moduleOfUntangler } from './load.js';
import type { ModuleSession } from './threads.js';
import { setUntangler } from './wasm/edgeflip.js';

/** What `src/session/untangler_proxy.rs` throws if a call needs the module. */
const MISSING = 'untangler';

/** Calls a session. If the call lacks the module of the repair, it has changed nothing: then it is called again with it. */
export async function call<T>(session: ModuleSession, work: (session: ModuleSession) => Promise<T>): Promise<T> {
  try {
    return await work(session);
  } catch (thrown) {
    // A thread makes an error of it.
    if (thrown !== MISSING && Object(thrown).message !== MISSING) throw thrown;
  }
  await supply(session);
  return work(session);
}

/** Gives the module of the repair to that of the engines, here or in a thread. */
async function supply(session: ModuleSession): Promise<void> {
  const module = await moduleOfUntangler();
  if (session.takeUntangler) return session.takeUntangler(module);
  const { untanglerOf } = await import('./untangler.js');
  setUntangler(await untanglerOf(module));
}
