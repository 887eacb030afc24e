/** The gallery: a picture and a word for each sample. */

import { element, NARROW } from './controls.ts';
import { made } from '../shell/elements.ts';
import { BROUGHT, FIRST, MOVING, SAMPLES } from '../models/samples.js';

/** Fills the gallery. `open` is called with the spec of the sample that is chosen. */
export function makeGallery(open: (spec: string) => void): void {
  const gallery = element('gallery');
  const real = SAMPLES.filter(({ spec }) => spec.startsWith(BROUGHT));
  for (const sample of [...real, ...MOVING, ...SAMPLES.slice(real.length)]) {
    const picture = made('span', 'thumb');
    picture.style.setProperty('--thumb', `url(${new URL(sample.thumb, document.baseURI)})`);
    const button = made('button', '', picture, sample.short);
    button.type = 'button';
    const { credit, licence } = 'credit' in sample ? sample : {};
    button.title = [sample.name, credit, licence].filter(Boolean).join(', ');
    button.dataset['spec'] = sample.spec;
    button.addEventListener('click', ({ detail }) => {
      open(sample.spec);
      gallery.hidePopover();
      // After a click with the pointer, the keys are for the run.
      if (detail > 0) button.blur();
    });
    gallery.append(button);
  }
  markSample(FIRST);
  // On a narrow screen, it is a sheet behind the name.
  const close = () => gallery.hidePopover();
  matchMedia(NARROW).addEventListener('change', close);
  element('file').addEventListener('change', close);
}

/** Marks the sample that is shown, or was before its edges were scrambled or drawn; none for a file. */
export function markSample(spec: string): void {
  const gallery = element('gallery');
  for (const button of gallery.querySelectorAll('button')) {
    const isShown = button.dataset['spec'] === spec;
    button.ariaPressed = `${isShown}`;
    // `scrollIntoView` would scroll the page too.
    if (isShown) gallery.scrollTo({ top: button.offsetTop - gallery.clientHeight / 2 });
  }
}
