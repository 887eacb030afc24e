/** A recorded run of a hardware GPU: the lanes and the lines that are there before this computer has run. */

import record from 'virtual:recorded';
import { ONE_THREAD, THREADS, WEBGL2, WEBGPU, type Contender } from './contenders.ts';
import { crossoverOf } from './crossover.ts';
import type { Series } from './sizes.ts';
import { about, count, timeText } from './words.ts';

/** The largest mesh of the chart. */
const MOST = 1e6;

/** The mesh of the race: large enough for a GPU, and small enough for any computer. */
const { spec, triangles, ms } = record.meshes.find((mesh) => mesh.spec === 'random 269')!;

export const RACE = { spec, name: `${count(triangles)} triangles between random points` };

/** The recorded milliseconds of an engine in the race. On one thread, none was recorded. */
export function recordedTime(contender: Contender): number | undefined {
  return contender === ONE_THREAD ? undefined : ms[contender.options.backend as keyof typeof ms];
}

/** The words for it. The names of the engines have the threads of this computer, and the record was on others. */
export function recordedWords(contender: Contender): string {
  const time = recordedTime(contender);
  if (time === undefined) return 'Not recorded';
  return `Recorded${contender === THREADS ? ` on ${record.cores} threads` : ''}: ${timeText(time)}`;
}

const plane = record.meshes.filter((mesh) => mesh.spec.startsWith('random') && mesh.triangles <= MOST);

/** The recorded times of the engines by size. */
export const SERIES: readonly Series[] = [THREADS, WEBGPU, WEBGL2].map((contender) => ({
  contender,
  points: plane.map((mesh) => ({
    triangles: mesh.triangles,
    ms: mesh.ms[contender.options.backend as keyof typeof ms],
  })),
}));

const date = new Date(record.date).toLocaleDateString('en-GB', { dateStyle: 'long', timeZone: 'UTC' });

/** What the record is of. */
export const WHAT = `an ${record.device} with ${record.cores} CPU cores in ${record.browser}, ${date}`;

export const RUNS = record.runs;

/** The page with the record. */
export const SOURCE = record.source;

/** From which size on the recorded GPU was first. */
export function recordedCrossover(): string {
  const crossover = crossoverOf(SERIES);
  if (!('from' in crossover)) throw new Error('the recorded lines do not cross');
  return about(crossover.from.triangles);
}
