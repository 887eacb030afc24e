/** Calls methods in a worker, and answers such calls there. */

import { buffersOf } from './buffers.js';
import { node } from './cores.js';
import { EdgeflipError, type ErrorCode, fromModule } from './error.js';

/** The functions that a worker offers, by name. */
export type Functions = Record<string, (...args: never[]) => unknown>;

/** A message that calls a function. */
interface Call {
  id: number;
  method: string;
  args: unknown[];
}

/** A message of a worker: an event of a call, or the value or the error that ends it. */
interface Answer {
  id: number;
  event?: unknown;
  value?: unknown;
  error?: { code: ErrorCode; message: string };
}

/** The script of a worker. Bundlers recognize the expressions `new Worker(new URL(…))` and `new URL(…)`. */
export interface Script {
  worker: () => Worker;
  url: () => URL;
}

/** A worker of a browser or of Node. A worker of Node keeps the process alive only during a call. */
export interface Thread {
  post(call: Call, transfer: ArrayBuffer[]): void;
  end(): void;
  wait(isWaiting: boolean): void;
}

/** Starts a worker. `onError` gets no message if the worker could not be loaded. */
export function startThread(
  { worker: start, url }: Script,
  onAnswer: (answer: Answer) => void,
  onError: (message?: string) => void,
): Thread {
  // Bun and Deno have both kinds, but their web workers keep the process alive.
  if (node && (typeof window === 'undefined' || typeof Worker === 'undefined')) {
    const worker = new node.Worker(url());
    worker.on('message', onAnswer);
    worker.on('error', ({ message, code }: NodeJS.ErrnoException) =>
      onError(/MODULE_NOT_FOUND$/.test(code ?? '') ? undefined : message),
    );
    worker.on('messageerror', ({ message }) => onError(message));
    worker.unref();
    return {
      post: (call, transfer) => worker.postMessage(call, transfer),
      end: () => void worker.terminate(),
      wait: (isWaiting) => (isWaiting ? worker.ref() : worker.unref()),
    };
  }
  const worker = start();
  worker.onmessage = ({ data }) => onAnswer(data);
  worker.onerror = (event) => {
    event.preventDefault();
    onError(event.message);
  };
  worker.onmessageerror = () => onError('a message could not be read');
  return {
    post: (call, transfer) => worker.postMessage(call, transfer),
    end: () => worker.terminate(),
    wait: () => undefined,
  };
}

/** How a call sends its arguments, and who gets its events. */
export interface Sending {
  transfer?: ArrayBuffer[];
  onEvent?: (event: never) => void;
}

interface Waiting {
  resolve: (value: never) => void;
  reject: (error: Error) => void;
  onEvent: Sending['onEvent'];
}

/** A worker that answers calls. */
export class Remote<F extends Functions> {
  readonly #thread: Thread;
  readonly #calls = new Map<number, Waiting>();
  #numbers = 0;
  #error: EdgeflipError | undefined;

  /** @param onEnd - Gets the message of an error of the worker, which then ends; none if it could not be loaded. */
  constructor(script: Script, onEnd: (message?: string) => void) {
    this.#thread = startThread(script, (answer) => this.#take(answer), onEnd);
  }

  /** Calls a function. An event of an earlier call may come first. */
  call<M extends keyof F & string>(
    method: M,
    args: Parameters<F[M]>,
    { transfer = [], onEvent }: Sending = {},
  ): Promise<Awaited<ReturnType<F[M]>>> {
    return new Promise((resolve, reject) => {
      if (this.#error) throw this.#error;
      const id = this.#numbers++;
      this.#thread.post({ id, method, args }, transfer);
      this.#thread.wait(true);
      this.#calls.set(id, { resolve, reject, onEvent });
    });
  }

  /** Ends the worker. All calls fail with the error. */
  end(error: EdgeflipError): void {
    this.#error = error;
    this.#thread.end();
    for (const { reject } of this.#calls.values()) reject(error);
    this.#calls.clear();
  }

  #take({ id, event, value, error }: Answer): void {
    const call = this.#calls.get(id);
    if (event !== undefined) return call?.onEvent?.(event as never);
    this.#calls.delete(id);
    if (this.#calls.size === 0) this.#thread.wait(false);
    if (error) call?.reject(new EdgeflipError(error.code, error.message));
    else call?.resolve(value as never);
  }
}

/** A worker of Node and a worker of a browser both have these two members. */
const port = (node?.parentPort ?? globalThis) as unknown as {
  onmessage: (event: MessageEvent<Call>) => void;
  postMessage(answer: Answer, transfer: ArrayBuffer[]): void;
};

/** Sends an event to the caller of a function. */
export type Emit = (event: unknown) => void;

/**
 * Answers calls, in a worker. A function gets the arguments of the call and then `emit`. The buffers of arrays in a
 * value are transferred.
 *
 * @param isFatal - Whether an exception ends the worker and all its calls.
 */
export function answerCalls(
  functions: object,
  isFatal: (thrown: unknown, method: string) => boolean = () => false,
): void {
  port.onmessage = async ({ data: { id, method, args } }) => {
    const emit: Emit = (event) => port.postMessage({ id, event }, []);
    try {
      const value: unknown = await (functions as Record<string, (...args: unknown[]) => unknown>)[method]!(
        ...args,
        emit,
      );
      port.postMessage({ id, value }, buffersOf(value));
    } catch (thrown) {
      if (isFatal(thrown, method)) return crash(thrown);
      const { code, message } = fromModule(thrown);
      port.postMessage({ id, error: { code, message } }, []);
    }
  };
}

/** Raises an error of the worker. */
function crash(reason: unknown): void {
  setTimeout(() => {
    throw reason;
  });
}
