/** Lecture mode: the tools are hidden and the type is larger, for a picture on a wall. A clicker steps. */

import { element } from './controls.ts';

export const isLecture = () => document.body.hasAttribute('data-lecture');

/** Whether the address asks for lecture mode. */
export const asksForLecture = (hash: string) => new URLSearchParams(hash.split('?')[1] ?? '').has('lecture');

/** A link to the present mode. */
export function withLecture(link: string): string {
  return isLecture() ? `${link}&lecture` : link;
}

/** Begins lecture mode, or ends it. `resize` is called when the picture has another part that is free. */
export function setLecture(isOn: boolean, resize: () => void): void {
  if (isOn === isLecture()) return;
  document.body.toggleAttribute('data-lecture', isOn);
  element('gallery').hidePopover();
  for (const sheet of document.querySelectorAll<HTMLElement>('#watch .sheet')) sheet.hidePopover();
  element('announcement').textContent = isOn ? 'Lecture mode. Escape ends it.' : 'Lecture mode has ended.';
  scrollTo({ top: 0, behavior: 'instant' });
  resize();
}
