/** The frame of a figure: a card with the drawing and one caption that changes, and the words below. */

import { create } from 'd3-selection';
import type { Svg } from './draw.ts';

/** What a figure draws on. */
export interface Stage {
  svg: Svg;
  /** The row below the drawing, with the caption. */
  bar: HTMLElement;
  /** Changes the caption. A hot one is about an edge that is not Delaunay. */
  say(text: string, isHot?: boolean): void;
}

export interface Figure {
  title: string;
  words: string;
  /** What to drag, if the visitor can. */
  hint?: string;
  /** Describes the drawing for those who do not see it. */
  label: string;
  start(stage: Stage): Promise<void>;
}

function tag<K extends keyof HTMLElementTagNameMap>(name: K, kind: string, ...inside: (Node | string)[]) {
  const element = document.createElement(name);
  element.className = kind;
  element.append(...inside);
  return element;
}

/** Builds a figure and starts it. */
export function mountFigure(figure: Figure, number: number): HTMLElement {
  const { title, words, hint, label } = figure;
  const svg: Svg = create('svg')
    .attr('class', 'explain-drawing')
    .attr('viewBox', '0 0 384 244')
    .attr('role', hint ? 'group' : 'img')
    .attr('aria-label', label);
  const caption = tag('p', 'explain-caption');
  if (hint) caption.setAttribute('aria-live', 'polite');
  const bar = tag('div', 'explain-bar', caption);
  const say = (text: string, isHot = false) => {
    if (caption.textContent !== text) caption.textContent = text;
    caption.classList.toggle('explain-hot', isHot);
  };
  const name = tag('h3', 'explain-title', tag('span', 'explain-number', `${number}`), title);
  const element = tag('figure', 'explain-figure', tag('div', 'explain-card', svg.node()!, bar), name);
  element.append(tag('p', 'explain-words', words));
  if (hint) element.append(tag('p', 'explain-hint', hint));
  figure.start({ svg, bar, say }).catch((error) => {
    say('The engine did not load, so this figure stands still.');
    console.error(error);
  });
  return element;
}
