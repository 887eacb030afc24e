/** Links to what is shown: sample, engine, limits, iteration and view, in the part of the address after `#`. */

import type { Shown } from './shown.ts';
import type { Backend } from './run.ts';

/** What a link says. */
export interface Place {
  mesh: string;
  engine: Backend | undefined;
  beta: number | undefined;
  deviation: number | undefined;
  features: number | undefined;
  at: number;
  pose: number[] | undefined;
}

const ENGINES: readonly string[] = ['auto', 'webgpu', 'webgl2', 'cpu'] satisfies Backend[];

/**
 * The link; `undefined` for a mesh that is not a sample. If the page has changed the triangles of a sample, the link opens
 * the sample as it was before that, which has other iterations.
 */
export function linkTo({ opened, run, settings }: Shown, pose: readonly number[] | undefined): string | undefined {
  if (opened.origin === undefined) return undefined;
  const { backend, maxNormalAngle, maxDeviation, features } = settings;
  const parts = new URLSearchParams({ mesh: opened.origin, at: opened.spec === undefined ? '0' : `${run.at}` });
  if (backend !== 'auto') parts.set('engine', backend);
  if (opened.mesh.dimension === 3) parts.set('beta', `${maxNormalAngle}`);
  if (maxDeviation !== undefined) parts.set('deviation', `${maxDeviation}`);
  if (features !== undefined) parts.set('features', `${features}`);
  if (pose) parts.set('view', pose.map((x) => Number(x.toFixed(6))).join('_'));
  const url = new URL(location.href);
  url.hash = `watch?${parts}`;
  return url.href;
}

/** What the address says; `undefined` if it names no mesh. */
export function placeIn(hash: string): Place | undefined {
  const parts = new URLSearchParams(hash.split('?')[1] ?? '');
  const mesh = parts.get('mesh');
  if (!mesh) return undefined;
  const numberOf = (key: string, most: number) => {
    const value = Number(parts.get(key) ?? Number.NaN);
    return value >= 0 && value <= most ? value : undefined;
  };
  const engine = parts.get('engine') ?? '';
  return {
    mesh,
    engine: ENGINES.includes(engine) ? (engine as Backend) : undefined,
    beta: numberOf('beta', 180),
    deviation: numberOf('deviation', Number.MAX_VALUE),
    features: numberOf('features', 180),
    at: Math.floor(numberOf('at', 1e6) ?? 0),
    pose: parts.get('view')?.split('_').map(Number),
  };
}
