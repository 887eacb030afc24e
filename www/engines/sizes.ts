/** Times the engines on meshes of growing size, and finds the size from which on a GPU is first. */

import { ONE_THREAD, THREADS, WEBGL2, WEBGPU, type Contender } from './lineup.ts';
import { Runner, sentenceOf } from './runner.ts';

/** The meshes: `random N` in the plane, with 2(N − 1)² triangles. */
const SIDES = [11, 20, 38, 73, 140, 269, 501];

/** Milliseconds. An engine with a slower run is not measured on larger meshes. */
const SLOW = 1000;

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
  isSoftware: boolean;
}

/** The CPU engine chooses its number of threads itself, as in a program. */
const CPU = THREADS.whyNot === undefined ? THREADS : ONE_THREAD;

export const emptySeries = (): Series[] =>
  [WEBGPU, WEBGL2, CPU].map((contender) => ({ contender, points: [], whyNot: contender.whyNot, isSoftware: false }));

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
  const source = new Runner(signal);
  const running = new Map(series.filter(({ whyNot }) => !whyNot).map((one) => [one, new Runner(signal)]));
  try {
    for (const [done, side] of SIDES.entries()) {
      const mesh = await source.ask((timer) => timer.generate(`random ${side}`));
      const triangles = mesh.indices.length / 3;
      for (const [one, runner] of running) {
        const { name, options } = one.contender;
        report(done / SIDES.length, `${triangles.toLocaleString('en')} triangles, ${name}`);
        try {
          const { median, isSoftware } = await runner.ask((timer) => timer.time(mesh, options, SLOW));
          one.points.push({ triangles, ms: median });
          one.isSoftware = isSoftware;
          if (median <= SLOW) continue;
        } catch (error) {
          signal.throwIfAborted();
          one.whyNot = sentenceOf(error);
        }
        runner.close();
        running.delete(one);
      }
    }
  } finally {
    for (const runner of [source, ...running.values()]) runner.close();
  }
}

/** Who is first, and from which size on a GPU is, if it is not from the start. */
export type Lead = { first: 'cpu' | 'gpu' | 'only the cpu' | 'only a gpu' } | { from: Point };

/** Compares the best GPU engine with the CPU at each size that either has. */
export function leadOf(series: readonly Series[]): Lead {
  const best = (isGpu: boolean) => {
    const times = new Map<number, number>();
    for (const { contender, points } of series) {
      if ((contender.options.backend !== 'cpu') !== isGpu) continue;
      for (const { triangles, ms } of points) times.set(triangles, Math.min(ms, times.get(triangles) ?? Infinity));
    }
    return times;
  };
  const [gpu, cpu] = [best(true), best(false)];
  if (gpu.size === 0) return { first: 'only the cpu' };
  if (cpu.size === 0) return { first: 'only a gpu' };
  const sizes = [...new Set([...cpu.keys(), ...gpu.keys()])].sort((a, b) => a - b);
  /** Above 0 where the GPU is first, on the logarithmic scale of the drawing. */
  const gain = (size: number) => Math.log(cpu.get(size) ?? Infinity) - Math.log(gpu.get(size) ?? Infinity);
  const last = sizes.map((size) => gain(size) > 0).lastIndexOf(false);
  if (last === sizes.length - 1) return { first: 'cpu' };
  if (last < 0) return { first: 'gpu' };
  return { from: between(sizes[last]!, sizes[last + 1]!, gain, (size) => cpu.get(size) ?? gpu.get(size)!) };
}

/** Where the lines cross between two sizes, if both engines have both sizes; else the upper size. */
function between(a: number, b: number, gain: (size: number) => number, ms: (size: number) => number): Point {
  const share = gain(a) / (gain(a) - gain(b));
  if (!Number.isFinite(share)) return { triangles: b, ms: ms(b) };
  const mix = (from: number, to: number) => Math.exp(Math.log(from) + share * (Math.log(to) - Math.log(from)));
  return { triangles: mix(a, b), ms: mix(ms(a), ms(b)) };
}
