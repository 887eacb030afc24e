/** Code in tabs, one for each way to use the package. */

import { made } from '../shell/elements.ts';

export interface Snippet {
  name: string;
  /** The command that installs it, or the lines that add it. */
  install?: string;
  code: string;
  /** What else to know before. */
  note?: string;
  /** The kilobytes that the code loads, after gzip. */
  loads?: number;
  /** The file that has the code, its title, and its page on the site. */
  source: string;
  title: string;
  page: string;
}

/** Where a key leads from a tab, among so many. */
const STEPS: Record<string, (at: number, count: number) => number> = {
  ArrowRight: (at, count) => (at + 1) % count,
  ArrowLeft: (at, count) => (at + count - 1) % count,
  Home: () => 0,
  End: (_, count) => count - 1,
};

/** Comments are grey. */
const COMMENT = /((?:^|\s)(?:\/\/.*|# .*|#$))/m;

function codeOf(text: string, kind = ''): HTMLElement {
  const parts = text.split(COMMENT).map((part, i) => (i % 2 === 1 ? made('i', '', part) : part));
  const box = made('pre', kind, made('code', '', ...parts));
  box.tabIndex = 0;
  return box;
}

/** The tabs; the first one is open. */
export function tabs(snippets: readonly Snippet[]): HTMLElement {
  const list = made('div', 'package-tabs');
  list.setAttribute('role', 'tablist');
  list.ariaLabel = 'Code for';
  const all = snippets.map(({ name }, i) => {
    const tab = made('button', '', name);
    tab.type = 'button';
    tab.id = `package-tab-${i}`;
    tab.setAttribute('role', 'tab');
    tab.setAttribute('aria-controls', `package-panel-${i}`);
    tab.addEventListener('click', () => select(i));
    return tab;
  });
  const panels = snippets.map((snippet, i) => panelOf(snippet, i));
  const select = (chosen: number) => {
    for (const [i, tab] of all.entries()) {
      tab.ariaSelected = `${i === chosen}`;
      tab.tabIndex = i === chosen ? 0 : -1;
      panels[i]!.hidden = i !== chosen;
    }
  };
  list.addEventListener('keydown', (event) => {
    const step = STEPS[event.key];
    if (!step || event.ctrlKey || event.metaKey || event.altKey) return;
    const next = step(all.indexOf(event.target as HTMLButtonElement), all.length);
    select(next);
    all[next]!.focus();
    event.preventDefault();
    // The same keys move through a run of the tool.
    event.stopPropagation();
  });
  select(0);
  list.append(...all);
  return made('div', 'package-code', list, ...panels);
}

function panelOf({ install, note, code, loads, title, page }: Snippet, i: number): HTMLElement {
  const copy = made('button', 'read-button', 'Copy');
  copy.type = 'button';
  copy.addEventListener('click', async () => {
    try {
      await navigator.clipboard.writeText(code);
      copy.textContent = 'Copied';
    } catch {
      copy.textContent = 'Not allowed';
    }
    setTimeout(() => (copy.textContent = 'Copy'), 2000);
  });
  copy.ariaLive = 'polite';
  const from = made('a', '', title);
  from.href = page;
  const size = loads ? `It loads ${loads} KB after gzip.` : '';
  const row = made('p', 'package-row', made('span', '', 'From ', from, `, tested with every change. ${size}`), copy);
  const panel = made(
    'div',
    'package-panel',
    ...(install ? [codeOf(install, 'package-install')] : []),
    codeOf(code),
    ...(note ? [made('p', 'package-note', note)] : []),
    row,
  );
  panel.id = `package-panel-${i}`;
  panel.setAttribute('role', 'tabpanel');
  panel.setAttribute('aria-labelledby', `package-tab-${i}`);
  return panel;
}
