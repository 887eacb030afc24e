/** Times the engines on meshes of growing size. */

import { ONE_THREAD, THREADS, WEBGL2, WEBGPU, type Contender } from './contenders.ts';
import { sentenceOf, start, startTimer, time } from './timer.ts';
import { count } from './words.ts';

/** The meshes: `random N` in the plane, with 2(N − 1)² triangles. */
const SIDES = [11, 20, 38, 73, 140, 269, 501];

/** Milliseconds. An engine with a slower run is not measured on larger meshes. */
const SLOW = 1000;

/** Such an engine is slower than the CPU, and can take minutes. */
const EMULATED = 'not measured, because this browser emulates the GPU on the CPU, which is slower than the CPU alone';

export interface Point {
  triangles: number;
  ms: number;
}

/** The times of one engine, by size. */
export interface Series {
  contender: Contender;
  points: Point[];
  /** Why it has no point, or no more points. */
  whyNot?: string | undefined;
}

/** The CPU engine chooses its number of threads itself, as in a program. */
const CPU = THREADS.whyNot === undefined ? THREADS : ONE_THREAD;

export const emptySeries = (): Series[] =>
  [CPU, WEBGPU, WEBGL2].map((contender) => ({ contender, points: [], whyNot: contender.whyNot }));

/**
 * Fills the series, the small meshes first. `report` is called before each measurement, with the completed share.
 *
 * @throws if the signal is aborted, or if no mesh can be made.
 */
export async function measureSizes(
  series: Series[],
  signal: AbortSignal,
  report: (share: number, what: string) => void,
): Promise<void> {
  const source = startTimer(signal);
  const running = new Map(series.filter(({ whyNot }) => !whyNot).map((one) => [one, startTimer(signal)]));
  try {
    for (const [done, side] of SIDES.entries()) {
      const mesh = await source.call((worker) => worker.generate(`random ${side}`));
      const triangles = mesh.indices.length / 3;
      for (const [one, timer] of running) {
        const { name, options } = one.contender;
        report(done / SIDES.length, `${count(triangles)} triangles, ${name}`);
        try {
          if (side === SIDES[0]) {
            if (await timer.call((worker) => worker.isSoftware(options))) throw new Error(EMULATED);
            await start(timer, 2, options);
          }
          const { median } = await time(timer, mesh, options);
          one.points.push({ triangles, ms: median });
          if (median <= SLOW) continue;
        } catch (error) {
          signal.throwIfAborted();
          one.whyNot = sentenceOf(error);
        }
        timer.close();
        running.delete(one);
      }
    }
  } finally {
    for (const timer of [source, ...running.values()]) timer.close();
  }
}
