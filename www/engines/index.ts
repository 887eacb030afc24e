/** The section "Three engines, one answer": a race of the engines, and the size from which on a GPU is first. */

import { made } from '../shell/elements.ts';
import './engines.css';
import './race.css';
import './crossover.css';
import { autoRules } from './auto.ts';
import { CrossoverView } from './crossover-view.ts';
import type { NamedMesh } from './contenders.ts';
import { RaceView } from './race-view.ts';
import { OneAtATime } from './one-at-a-time.ts';

export type { NamedMesh } from './contenders.ts';

/** Puts the section into `host`. The race runs on the mesh that is open then, or on a sample if there is none. */
export function mountEngines(host: HTMLElement, openMesh: () => NamedMesh | undefined): void {
  const oneAtATime = new OneAtATime();
  new RaceView(host, oneAtATime, openMesh);
  const crossover = made('div', 'engines-crossover');
  new CrossoverView(crossover, oneAtATime);
  host.append(made('div', 'engines-below', crossover, made('div', 'engines-auto', ...autoRules())));
}
