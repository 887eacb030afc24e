/** The worker of `edgeflip/worker`: holds its sessions and answers calls. */

import { EdgeflipError, FlipSession, init, makeDelaunay } from './index.js';
import type { Sources } from './module.js';
import { answerCalls, type Emit } from './remote.js';
import type { Settings } from './settings.js';
import type { Mesh, RunOptions } from './types.js';

/** The methods of a session that a message calls by name. */
export type Question =
  | 'backend'
  | 'changes'
  | 'counters'
  | 'edgeStates'
  | 'edges'
  | 'result'
  | 'setPositions'
  | 'step'
  | 'problems'
  | 'triangles'
  | 'update'
  | 'verify';

/** Which callbacks the caller has, and whether its signal has stopped the run already. */
export interface Watched {
  onProgress: boolean;
  onIteration: boolean;
  isStopped: boolean;
}

const sessions = new Map<number, FlipSession>();
/** The runs that a signal can stop, by the number that the caller gave them. */
const runs = new Map<number, AbortController>();

/** Runs until the caller calls `stop` with the same number. */
async function stoppable<T>(
  run: number,
  { isStopped }: Watched,
  work: (signal: AbortSignal) => Promise<T>,
): Promise<T> {
  const controller = new AbortController();
  if (isStopped) controller.abort();
  runs.set(run, controller);
  try {
    return await work(controller.signal);
  } finally {
    runs.delete(run);
  }
}

/** The callbacks that send events to the caller: those that it has. */
function callbacks({ onProgress, onIteration }: Watched, emit: Emit): RunOptions {
  return {
    ...(onProgress && { onProgress: (progress: unknown) => emit({ progress }) }),
    ...(onIteration && { onIteration: (iteration: unknown) => emit({ iteration }) }),
  };
}

const functions = {
  /** Texts are absolute URLs. */
  init(sources: Record<string, unknown>): Promise<void> {
    const entries = Object.entries(sources).map(([name, source]) => [
      name,
      typeof source === 'string' ? new URL(source) : source,
    ]);
    return init(Object.fromEntries(entries) as Sources);
  },
  make(run: number, mesh: Mesh<Uint32Array>, settings: Settings, watched: Watched, ...[emit]: [emit?: Emit]) {
    return stoppable(run, watched, (signal) =>
      makeDelaunay(mesh, { ...settings, signal, ...callbacks(watched, emit!) }),
    );
  },
  async create(session: number, mesh: Mesh<Uint32Array>, settings: Settings): Promise<void> {
    sessions.set(session, await FlipSession.create(mesh, settings));
  },
  ask(session: number, question: Question, args: never[]): Promise<unknown> {
    const asked = sessions.get(session)!;
    return (asked[question] as (...args: never[]) => unknown).apply(asked, args) as Promise<unknown>;
  },
  run(session: number, run: number, watched: Watched, ...[emit]: [emit?: Emit]) {
    return stoppable(run, watched, (signal) => sessions.get(session)!.run({ signal, ...callbacks(watched, emit!) }));
  },
  stop(run: number): void {
    runs.get(run)?.abort();
  },
  free(session: number): void {
    sessions.get(session)?.free();
    sessions.delete(session);
  },
};

export type Functions = typeof functions;

// After a trap the module may be corrupt, so the page starts another worker.
answerCalls(functions, (thrown) => thrown instanceof EdgeflipError && thrown.cause instanceof WebAssembly.RuntimeError);
