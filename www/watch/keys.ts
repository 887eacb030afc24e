/** The keys of the tool, and the list of them. */

import { element } from './controls.ts';
import { made } from '../shell/elements.ts';

/** A key, as the browser names it and as the list writes it, and what it does. */
export interface Key {
  keys: readonly string[];
  /** As the list writes it; nothing if another key's line says it. */
  label?: string;
  says?: string;
  /** Elements that use the key themselves while they have the focus. */
  keptBy?: string;
  /** Whether the key does something now; else the browser has it. */
  when?: () => boolean;
  act: (key: string) => void;
}

const TEXT = 'input:not([type=range], [type=radio], [type=checkbox]), select, textarea';

/** Listens for keys while the tool is shown, and fills the list. */
export function listen(keys: readonly Key[]): void {
  const list = element<HTMLDialogElement>('keys');
  const rows = keys.flatMap(({ label, says }) =>
    label && says ? [made('tr', '', made('td', '', made('kbd', '', label)), made('td', '', says))] : [],
  );
  list.querySelector('tbody')?.replaceChildren(...rows);
  document.addEventListener('keydown', (event) => {
    if (document.body.dataset['view'] !== 'watch' || event.ctrlKey || event.metaKey || event.altKey) return;
    if (list.open) return;
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const key = keys.find(({ keys, when }) => keys.includes(name) && (when?.() ?? true));
    if (!key) return;
    if (event.target instanceof Element && event.target.closest(key.keptBy ?? TEXT)) return;
    // The browser closes sheets on Escape too.
    if (name !== 'Escape') event.preventDefault();
    key.act(event.shiftKey ? `Shift ${name}` : name);
  });
}
