/** A thread of the CPU engine: a worker. The first of them has the sessions, and answers calls. */

import { buffersOf } from './buffers.js';
import { type ErrorCode, fromModule } from './error.js';
import type { IndexedMesh } from './mesh.js';
import type { Settings } from './settings.js';
import { Indices, initSync, Session, startThreads, work } from './wasm/edgeflip_threads.js';

/** What a session can be asked. */
export type Question =
  | 'advance'
  | 'auditInput'
  | 'edgeStates'
  | 'edges'
  | 'outcome'
  | 'setPositions'
  | 'step'
  | 'triangles';

/** What the session answers, and how far it is then. */
export interface Reply {
  value: unknown;
  iterations: number;
  flips: number;
}

/** Milliseconds that iterations may take until a run hears of them: two frames. A message takes as long as many small ones. */
const SLICE = 32;

/** Meshes whose sessions are not open yet. */
const begun = new Map<number, { mesh: IndexedMesh; settings: Settings }>();
const sessions = new Map<number, Session>();
/** What the page has not copied yet, by session. */
const lent = new Map<number, Indices>();

const calls = {
  /** Makes this worker the first of so many threads, and gives the memory for all. */
  start(module: WebAssembly.Module, count: number): WebAssembly.Memory {
    initSync({ module });
    return startThreads(count);
  },
  /** Makes this worker another one, for ever. */
  work(module: WebAssembly.Module, memory: WebAssembly.Memory): void {
    initSync({ module, memory });
    work();
  },
  /** Takes a mesh for a session. */
  begin(session: number, mesh: IndexedMesh, settings: Settings): void {
    begun.set(session, { mesh, settings });
  },
  /** Opens the session. Where there was too little memory, it can be tried again. */
  async open(session: number): Promise<void> {
    const { mesh, settings } = begun.get(session)!;
    sessions.set(session, await Session.create(mesh.positions, mesh.indices, mesh.dimension, settings));
    begun.delete(session);
  },
  async ask(session: number, question: Question, args: unknown[]): Promise<Reply> {
    const asked = sessions.get(session)!;
    const answer = () => (asked[question] as (...args: unknown[]) => Promise<unknown>).apply(asked, args);
    const start = performance.now();
    let value = await answer();
    while (question === 'advance' && value && performance.now() - start < SLICE) value = await answer();
    return { value: lend(session, value), iterations: asked.iterations, flips: asked.flips };
  },
  /** The page has copied what it was lent. */
  release(session: number): void {
    lent.get(session)?.free();
    lent.delete(session);
  },
  free(session: number): void {
    calls.release(session);
    begun.delete(session);
    sessions.get(session)?.free();
    sessions.delete(session);
  },
};

export type Calls = typeof calls;

/** What is sent of a value: of its indices, where they are in memory and how many, for the page to copy them. */
function lend(session: number, value: unknown): unknown {
  if (value instanceof Indices) {
    lent.set(session, value);
    return value.place();
  }
  const { indices } = Object(value) as { indices?: unknown };
  return indices instanceof Indices ? { ...(value as object), indices: lend(session, indices) } : value;
}

/** A call by its name. */
export interface Call {
  id: number;
  method: keyof Calls;
  args: unknown[];
}

/** What a call gives. */
export interface Answer {
  id: number;
  value?: unknown;
  error?: { code: ErrorCode; message: string };
}

const node = typeof process === 'undefined' ? undefined : process.getBuiltinModule?.('node:worker_threads');
/** Both have these two. */
const port = (node?.parentPort ?? globalThis) as unknown as {
  onmessage: (event: MessageEvent<Call>) => void;
  postMessage(answer: Answer, transfer: ArrayBuffer[]): void;
};

/** After a trap nothing can be said of the memory: an error of the worker, which ends all. */
function crash(reason: unknown): void {
  setTimeout(() => {
    throw reason;
  });
}

port.onmessage = async ({ data: { id, method, args } }) => {
  try {
    const value: unknown = await (calls[method] as (...args: unknown[]) => unknown)(...args);
    port.postMessage({ id, value }, buffersOf(value));
  } catch (thrown) {
    if (thrown instanceof WebAssembly.RuntimeError || method === 'work') return crash(thrown);
    const { code, message } = fromModule(thrown);
    port.postMessage({ id, error: { code, message } }, []);
  }
};
