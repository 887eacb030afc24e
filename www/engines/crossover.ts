/** From which size of the mesh on a GPU is first. */

import type { Point, Series } from './sizes.ts';

/** Who is first, and from which size on a GPU is, if it is not from the start. */
export type Crossover = { first: 'cpu' | 'gpu' | 'only the cpu' | 'only a gpu' } | { from: Point };

/** Compares the best GPU engine with the CPU at each size that either has. */
export function crossoverOf(series: readonly Series[]): Crossover {
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
