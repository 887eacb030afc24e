/** The guide of a first visit: asks an edge why it flips, plays the run once, and says that a click asks any edge. */

import { FIRST } from '../models/samples.js';
import { stillness } from '../shell/stillness.ts';
import { element } from './controls.ts';
import type { Page } from './page.ts';

/** The name of what the browser keeps for the visit. */
const SEEN = 'edgeflip-guide';
/** Milliseconds in which the first edge is read. */
const READING = 3500;
/** What the visitor does that ends the guide. */
const ENDING = ['pointerdown', 'keydown', 'dragenter'];

export class Guide {
  readonly #page: Page;
  readonly #opened: Promise<void>;
  #hasEnded = false;

  /**
   * Begins when the visitor follows "Watch it work", or has done so before the tool was loaded. `opened` settles when
   * the first mesh is shown.
   */
  constructor(page: Page, opened: Promise<void>) {
    [this.#page, this.#opened] = [page, opened];
    const way = document.querySelector('.way.first');
    if (document.body.hasAttribute('data-guided')) void this.#begin();
    else way?.addEventListener('click', () => void this.#begin(), { once: true });
  }

  /** Says something, unless this visit has had the guide, or the visitor does something already. */
  async #begin(): Promise<void> {
    for (const kind of ENDING) addEventListener(kind, this.#end, { capture: true });
    await this.#opened;
    // The picture has its size now, and the visitor has arrived.
    for (let frame = 0; frame < 2; frame++) await new Promise(requestAnimationFrame);
    const shown = this.#page.shown;
    if (this.#hasEnded) return;
    if (shown?.opened.spec !== FIRST || shown.run.at > 0 || !isFirst()) return this.#end();
    addEventListener('hashchange', this.#end, { once: true });
    this.#page.inspectNearest('flips');
    const touches = matchMedia('(hover: none)').matches;
    element('guide').textContent = `${touches ? 'Tap' : 'Click'} any edge to ask why.`;
    if (stillness.matches) return;
    await new Promise((resolve) => setTimeout(resolve, READING));
    // The run may have moved to the GPU meanwhile.
    const now = this.#page.shown;
    if (!this.#hasEnded && now?.opened === shown.opened && now.run.at === 0) await this.#page.player.toggle();
  }

  readonly #end = (): void => {
    this.#hasEnded = true;
    element('guide').textContent = '';
    for (const kind of ENDING) removeEventListener(kind, this.#end, { capture: true });
    removeEventListener('hashchange', this.#end);
  };
}

/** Whether this visit has not had the guide yet. From then on it has. */
function isFirst(): boolean {
  try {
    if (sessionStorage.getItem(SEEN) !== null) return false;
    sessionStorage.setItem(SEEN, 'seen');
  } catch {
    // The browser keeps nothing. The tool starts once a visit at most, unless the page is loaded again.
  }
  return true;
}
