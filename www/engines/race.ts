/** Runs each engine on one mesh, one engine after the other. */

import { digestOf } from '../shell/digest.ts';
import { whyOneThreadRan, type Contender, type NamedMesh } from './contenders.ts';
import { RACE } from './recorded.ts';
import { sentenceOf, start, startTimer, time } from './timer.ts';
import type { Timing } from './timing.ts';

/** How an engine ran, and the milliseconds of its start; or why it did not. */
export type Outcome = { timing: Timing; start: number; digest: string } | { whyNot: string };

/** The mesh of the record. */
export async function recordedMesh(signal: AbortSignal): Promise<NamedMesh> {
  const timer = startTimer(signal);
  try {
    return { ...(await timer.call((worker) => worker.generate(RACE.spec))), name: RACE.name };
  } finally {
    timer.close();
  }
}

/** Starts one engine and times it. `say` gets what it does. Throws only if the signal is aborted. */
export async function runOn(
  { options, whyNot }: Contender,
  mesh: NamedMesh,
  signal: AbortSignal,
  say: (what: 'starts' | 'runs') => void,
): Promise<Outcome> {
  if (whyNot !== undefined) return { whyNot };
  const { positions, indices, dimension } = mesh;
  const all = { ...mesh.options, ...options };
  const timer = startTimer(signal);
  try {
    say('starts');
    const started = await start(timer, dimension, all);
    say('runs');
    const timing = await time(timer, { positions, indices, dimension }, all);
    const { threads, hint } = timing.result;
    const isAlone = options.backend === 'cpu' && options.threads !== 1 && threads === 1;
    if (isAlone) return { whyNot: whyOneThreadRan(hint) };
    return { timing, start: started, digest: await digestOf(timing.result.indices) };
  } catch (error) {
    signal.throwIfAborted();
    return { whyNot: sentenceOf(error) };
  } finally {
    timer.close();
  }
}
