/** Runs each engine on one mesh, one engine after the other. */

import { digestOf } from '../shell/digest.ts';
import { whyOneThreadRan, type Contender, type NamedMesh } from './contenders.ts';
import { startTimer, sentenceOf } from './timer.ts';
import type { Timing } from './timing.ts';

/** Milliseconds. A run that takes longer is the last of its engine. */
const LONG = 2000;

/** The mesh of the race, if none is open. */
const SAMPLE = { spec: 'uvsphere 100', name: 'the paper’s mesh 3' };

/** How an engine ran, or why it did not. */
export type Outcome = { timing: Timing; digest: string } | { whyNot: string };

export async function sampleMesh(signal: AbortSignal): Promise<NamedMesh> {
  const timer = startTimer(signal);
  try {
    const mesh = await timer.call((worker) => worker.generate(SAMPLE.spec));
    return { ...mesh, name: SAMPLE.name };
  } finally {
    timer.close();
  }
}

/** Times one engine. Throws only if the signal is aborted. */
export async function runOn({ options, whyNot }: Contender, mesh: NamedMesh, signal: AbortSignal): Promise<Outcome> {
  if (whyNot !== undefined) return { whyNot };
  const { positions, indices, dimension } = mesh;
  const timer = startTimer(signal);
  try {
    const plain = { positions, indices, dimension };
    const timing = await timer.call((worker) => worker.time(plain, { ...mesh.options, ...options }, LONG));
    const { threads, hint } = timing.result;
    const isAlone = options.backend === 'cpu' && options.threads !== 1 && threads === 1;
    if (isAlone) return { whyNot: whyOneThreadRan(hint) };
    return { timing, digest: await digestOf(timing.result.indices) };
  } catch (error) {
    signal.throwIfAborted();
    return { whyNot: sentenceOf(error) };
  } finally {
    timer.close();
  }
}
