/** Figures that move by themselves while they are in view. */

import { stillness } from '../shell/stillness.ts';
import type { Stage } from './figure.ts';

/** Draws beat `beat`, `turn` of the way to the next one: from 0, while it stands, to 1. */
type DrawBeat = (beat: number, turn: number) => void;

const STANDS = 2400;
const TURNS = 700;

const ease = (t: number) => (t < 0.5 ? 2 * t * t : 1 - 2 * (1 - t) ** 2);

/** Draws the way from one number to another; at once with reduced motion. Returns what stops it. */
export function glide(from: number, to: number, draw: (at: number) => void): () => void {
  const start = performance.now();
  const takes = stillness.matches ? 0 : 260;
  let request = 0;
  const tick = (now: number) => {
    const t = takes > 0 ? Math.min(1, Math.max(0, (now - start) / takes)) : 1;
    draw(t < 1 ? from + (to - from) * ease(t) : to);
    if (t < 1) request = requestAnimationFrame(tick);
  };
  tick(start);
  return () => cancelAnimationFrame(request);
}

/**
 * Loops through the beats. The button stops and continues it. With reduced motion, it stands at `still` until the
 * visitor plays it.
 */
export function loop({ svg, bar }: Stage, beats: number, still: [beat: number, turn: number], draw: DrawBeat): void {
  const button = document.createElement('button');
  button.type = 'button';
  button.className = 'explain-play';
  bar.append(button);

  let isPlaying = !stillness.matches;
  let isInView = false;
  let time = 0;
  let last: number | undefined;
  let request = 0;
  let shown = '';

  const show: DrawBeat = (beat, turn) => {
    const next = `${beat} ${turn}`;
    if (next !== shown) draw(beat, turn);
    shown = next;
  };
  const tick = (now: number) => {
    time = (time + Math.min(now - (last ?? now), 100)) % (beats * (STANDS + TURNS));
    last = now;
    const beat = Math.floor(time / (STANDS + TURNS));
    const turn = Math.max(0, time - beat * (STANDS + TURNS) - STANDS) / TURNS;
    // The last beat only stands.
    show(beat, beat === beats - 1 ? 0 : ease(turn));
    request = requestAnimationFrame(tick);
  };
  const change = () => {
    button.setAttribute('aria-label', isPlaying ? 'Pause the figure' : 'Play the figure');
    button.classList.toggle('explain-paused', !isPlaying);
    cancelAnimationFrame(request);
    last = undefined;
    if (isPlaying && isInView) request = requestAnimationFrame(tick);
  };
  const play = (plays: boolean) => {
    isPlaying = plays;
    change();
  };
  button.addEventListener('click', () => play(!isPlaying));
  stillness.addEventListener('change', () => {
    play(!stillness.matches);
    if (stillness.matches) show(...still);
  });
  new IntersectionObserver(
    (entries) => {
      isInView = entries.at(-1)!.isIntersecting;
      change();
    },
    { threshold: 0.3 },
  ).observe(svg.node()!);
  if (isPlaying) show(0, 0);
  else show(...still);
  change();
}
