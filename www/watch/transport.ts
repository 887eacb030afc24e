/** Updates the controls below the mesh, and the words on the page about the mesh and its run. */

import type { Reasons } from 'edgeflip';
import { controls, element } from './controls.ts';
import { made } from '../shell/elements.ts';
import type { Flips } from './mesh-worker.ts';
import { counted } from '../shell/numbers.ts';
import type { Opened } from './opening.ts';
import { ENGINES, reasons } from './panel.ts';
import { canScramble, type Run, type Summary } from './run.ts';
import { statusOf, type Smallest } from './sentences.ts';
import { FEW } from './phases.ts';
import { showPosition, type Timeline } from './timeline.ts';

export interface RunStatus {
  run: Run | undefined;
  opened: Opened | undefined;
  /** The summary of the run when it last paused. */
  summary: Summary | undefined;
  /** The flips of all iterations, if they are known before they are run. */
  ahead: Flips[] | undefined;
  /** The angles that were measured last. */
  smallest: Smallest | undefined;
  /** Whether a job is running. */
  isBusy: boolean;
  isPlaying: boolean;
}

export function showTransport(timeline: Timeline, status: RunStatus): void {
  const { run, opened, summary, ahead, smallest, isBusy, isPlaying } = status;
  const at = run?.at ?? 0;
  const isIdle = run !== undefined && !isBusy;
  controls.play.ariaLabel = isPlaying ? 'Pause' : 'Play';
  controls.play.disabled = !isIdle;
  controls.step.disabled = !isIdle || run.isOver;
  controls.phase.disabled = !isIdle;
  controls.phase.hidden = !opened || opened.mesh.indices.length > 3 * FEW;
  for (const control of [controls.back, controls.reset]) control.disabled = !isIdle || at === 0;
  for (const control of [controls.compare, controls.scramble, controls.draw, controls.take]) control.disabled = !isIdle;
  const flips = ahead ?? run?.iterations ?? [];
  showPosition(at, flips.length, isIdle);
  timeline.show(flips, at, ahead !== undefined || run?.hasEnded === true);
  const [bold, rest] = run
    ? statusOf(run, summary, ahead, smallest, opened !== undefined && canScramble(opened.mesh))
    : ['', ''];
  element('status').replaceChildren(...(bold ? [made('b', '', bold), ' '] : []), rest);
  element('note').textContent = noteOn(status);
  element('note').hidden = element('note').textContent === '';
  element('caption').textContent = opened?.title ?? '';
  element('about').textContent = opened ? about(opened) : '';
  const state = isBusy ? 'busy' : !run ? 'empty' : isPlaying ? 'playing' : run.isOver ? 'done' : 'ready';
  Object.assign(document.body.dataset, { state, mesh: opened?.name ?? '', newest: `${run?.iterations.length ?? 0}` });
}

function about(opened: Opened): string {
  const { what, mesh } = opened;
  const remark = remarkOf(opened);
  const mostly = [what, counted(mesh.indices.length / 3, 'triangle')].filter(Boolean).join(', ');
  return remark ? `${mostly}. ${remark}` : mostly;
}

/** What reading changed, and what is not drawn. */
const remarkOf = ({ remark, extras }: Opened) => [remark, ...(extras?.notes ?? [])].filter(Boolean).join(' ');

/** What is left and why, what reading changed, and why the engine is where it is. */
function noteOn({ run, opened, summary }: RunStatus): string {
  const isFinal = run?.isOver && summary?.iterations === run.iterations.length;
  const remains = isFinal ? left(summary.remaining) : '';
  return [remains, opened ? remarkOf(opened) : '', run ? whyThere(run, summary) : ''].filter(Boolean).join(' ');
}

/** Why `auto` runs on its engine. */
function whyThere({ fallback }: Run, summary: Summary | undefined): string {
  if (!fallback || !summary) return '';
  const engine = `${summary.backend === 'cpu' ? 'the ' : ''}${ENGINES[summary.backend]}`;
  return `On ${engine}: ${[fallback, summary.fallback].filter(Boolean).join('; ')}.`;
}

function left(remaining: Reasons): string {
  const what = reasons(remaining);
  return what === 'none' ? 'Every edge is Delaunay.' : `Not Delaunay, but they stay: ${what}.`;
}
