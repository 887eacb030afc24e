/** Updates the controls below the mesh and the sentences next to it. */

import type { Reasons } from 'edgeflip';
import { controls, element } from './controls.ts';
import type { Opened } from './opening.ts';
import { ENGINES, number, reasons } from './panel.ts';
import type { Run, Summary } from './run.ts';

export interface Standing {
  run: Run | undefined;
  opened: Opened | undefined;
  /** The summary of the run when it last paused. */
  summary: Summary | undefined;
  /** Whether a job is running. */
  isBusy: boolean;
  isPlaying: boolean;
}

export function showTransport({ run, opened, summary, isBusy, isPlaying }: Standing): void {
  const [at, newest] = [run?.at ?? 0, run?.iterations.length ?? 0];
  const isIdle = run !== undefined && !isBusy;
  controls.play.textContent = isPlaying ? 'Pause' : 'Play';
  controls.play.disabled = !isIdle;
  controls.step.disabled = !isIdle || run.isOver;
  controls.reset.disabled = !isIdle || at === 0;
  controls.slider.disabled = !isIdle || newest === 0;
  controls.slider.max = `${newest}`;
  controls.slider.value = `${at}`;
  controls.download.disabled = !isIdle;
  const position = run ? `${number.format(at)} / ${number.format(newest)}${run.hasEnded ? '' : '…'}` : '';
  element('position').textContent = position;
  element('status').textContent = run ? statusOf(run) : '';
  const isFinal = run?.isOver && summary?.iterations === newest;
  const remains = isFinal ? left(summary.remaining) : '';
  const note = [remains, opened?.remark, run ? whyThere(run, summary) : ''].filter(Boolean).join(' ');
  element('note').hidden = note === '';
  element('note').textContent = note;
  element('caption').textContent = opened?.name ?? '';
  const state = isBusy ? 'busy' : !run ? 'empty' : isPlaying ? 'playing' : run.isOver ? 'done' : 'ready';
  document.body.dataset['state'] = state;
}

/** The flips and iterations up to the shown state, as a text. */
export function statusOf({ at, isOver, iterations }: Run): string {
  if (at === 0) return isOver ? 'No edge of the input can flip' : 'The input';
  const flips = iterations.slice(0, at).reduce((sum, iteration) => sum + iteration.flips, 0);
  const progress = `${number.format(flips)} ${flips === 1 ? 'flip' : 'flips'} in ${number.format(at)} ${at === 1 ? 'iteration' : 'iterations'}`;
  return isOver ? `Done: ${progress}` : progress;
}

/** Why `auto` runs on its engine. */
function whyThere({ fallback }: Run, summary: Summary | undefined): string {
  if (!fallback || !summary) return '';
  const engine = `${summary.backend === 'cpu' ? 'the ' : ''}${ENGINES[summary.backend]}`;
  return `On ${engine}: ${[fallback, summary.fallback].filter(Boolean).join('; ')}.`;
}

/** A sentence about the remaining edges. */
function left(remaining: Reasons): string {
  const what = reasons(remaining);
  return what === 'none' ? 'Every edge is Delaunay.' : `Not Delaunay, and cannot flip: ${what}.`;
}
