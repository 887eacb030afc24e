/** A thread of the CPU engine: a worker. The first of them has the sessions, and answers calls. */

import { type ErrorCode, fromModule } from './error.js';
import type { Options } from './types.js';
import { Arrays, Indices, initSync, type Session, startThreads, work } from './wasm/edgeflip_threads.js';

/** What a session can be asked. */
export type Question = 'advance' | 'auditInput' | 'edgeStates' | 'edges' | 'outcome' | 'setPositions' | 'step' | 'triangles';

/** What the session answers, and how far it is then. */
export interface Reply {
  value: unknown;
  iterations: number;
  flips: number;
}

/** Milliseconds that iterations may take until a run hears of them: two frames. A message takes as long as many small ones. */
const SLICE = 32;

const begun = new Map<number, { arrays: Arrays; dimension: number; options: Options }>();
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
  /** Where to write so many numbers of positions and indices. */
  begin(session: number, options: Options, dimension: number, isDouble: boolean, numbers: number, indices: number): Uint32Array {
    const arrays = new Arrays(numbers, isDouble, indices);
    begun.set(session, { arrays, dimension, options });
    return arrays.places();
  },
  /** Opens a session on what has been written. */
  async open(session: number): Promise<void> {
    const { arrays, dimension, options } = begun.get(session)!;
    begun.delete(session);
    sessions.set(session, await arrays.open(dimension, options));
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

/** What of a value need not be copied. */
function buffers(value: unknown): ArrayBuffer[] {
  if (ArrayBuffer.isView(value)) return value.buffer instanceof ArrayBuffer ? [value.buffer] : [];
  if (typeof value !== 'object' || value === null || value instanceof WebAssembly.Memory) return [];
  return Object.values(value).flatMap(buffers);
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

// Where a function of the module has waited before, its promise does not hear of a trap. In Node it is such an error.
globalThis.addEventListener?.('unhandledrejection', (event) => crash(event.reason));

port.onmessage = async ({ data: { id, method, args } }) => {
  try {
    const value: unknown = await (calls[method] as (...args: unknown[]) => unknown)(...args);
    port.postMessage({ id, value }, buffers(value));
  } catch (thrown) {
    if (thrown instanceof WebAssembly.RuntimeError || method === 'work') return crash(thrown);
    const { code, message } = fromModule(thrown);
    port.postMessage({ id, error: { code, message } }, []);
  }
};
