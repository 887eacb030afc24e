/** Says what was copied: in the sheet "Take away" if it is open, else in a notice that goes away by itself. */

import { element } from './controls.ts';

/** Milliseconds that a notice stays. */
const STAYS = 6000;

let timer = 0;

/** Says the words once they are known, or that the browser does not let the page copy. */
export async function tell(words: Promise<string>): Promise<void> {
  const said = await words.catch(() => 'Not copied: the browser does not let this page use the clipboard.');
  if (element('away').matches(':popover-open')) {
    element('away-says').textContent = said;
    return;
  }
  const notice = element('notice');
  notice.textContent = said;
  clearTimeout(timer);
  timer = setTimeout(() => (notice.textContent = ''), STAYS);
}
