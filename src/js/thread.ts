/** A thread of the CPU engine: a worker. The first worker holds the sessions and answers calls. */

import { begin } from './begin.js';
import type { IndexedMesh } from './mesh.js';
import { answerCalls } from './remote.js';
import { reserve } from './reserve.js';
import type { Settings } from './settings.js';
import { untanglerOf } from './untangler.js';
import { Indices, initSync, Session, setUntangler, startThreads, work } from './wasm/edgeflip_threads.js';

/** The methods of a session that a message can call. */
export type Question =
  | 'advance'
  | 'auditInput'
  | 'changes'
  | 'counters'
  | 'edgeStates'
  | 'edges'
  | 'outcome'
  | 'setPositions'
  | 'step'
  | 'triangles'
  | 'update';

/** The answer of a session, and its progress. */
export interface Reply {
  value: unknown;
  iterations: number;
  flips: number;
}

/** Milliseconds of iterations per message to a run: two frames. A message takes as long as many small iterations. */
const SLICE = 32;

const sessions = new Map<number, Session>();
/** Indices that the client has not copied yet, by session. */
const lent = new Map<number, Indices>();

const calls = {
  ...begin({ initSync, startThreads, work }),
  reserve,
  /** Takes the module of the repair. */
  async takeUntangler(module: WebAssembly.Module): Promise<void> {
    setUntangler(await untanglerOf(module));
  },
  async open(session: number, { positions, indices, dimension }: IndexedMesh, settings: Settings): Promise<void> {
    sessions.set(session, await Session.create(positions, indices, dimension, settings, false));
  },
  async ask(session: number, question: Question, args: unknown[]): Promise<Reply> {
    const asked = sessions.get(session)!;
    const answer = () => (asked[question] as (...args: unknown[]) => Promise<unknown>).apply(asked, args);
    const start = performance.now();
    let value = await answer();
    while (question === 'advance' && value && performance.now() - start < SLICE) value = await answer();
    return { value: lend(session, value), iterations: asked.iterations, flips: asked.flips };
  },
  /** Frees the indices after the client has copied them. */
  release(session: number): void {
    lent.get(session)?.free();
    lent.delete(session);
  },
  free(session: number): void {
    calls.release(session);
    sessions.get(session)?.free();
    sessions.delete(session);
  },
};

export type Calls = typeof calls;

/** The value to send. Indices become their address and their number, and the client copies them from the memory. */
function lend(session: number, value: unknown): unknown {
  if (value instanceof Indices) {
    lent.set(session, value);
    return value.place();
  }
  const { indices } = Object(value) as { indices?: unknown };
  return indices instanceof Indices ? { ...(value as object), indices: lend(session, indices) } : value;
}

// After a trap the shared memory may be corrupt, so the client ends all threads.
answerCalls(calls, (thrown, method) => thrown instanceof WebAssembly.RuntimeError || method === 'work');
