/** Starts the page: the first view at once, then the tool, and the sections when the visitor comes near them. */

import type { Hero } from '../hero/hero.ts';
import type { Tool } from '../watch/main.ts';
import { keptDrop } from './early-drop.ts';
import { keepLanding } from './landing.ts';
import { markSections } from './sections.ts';
import { stillness } from './stillness.ts';
import { onTheme, toggleTheme } from './theme.ts';
import { loadTool, loadToolAhead, loadToolWhenIdle, startedTool } from './tool.ts';

const part = <T extends HTMLElement>(selector: string): T => {
  const found = document.querySelector<T>(selector);
  if (!found) throw new Error(`the page has no ${selector}`);
  return found;
};

const [live, liveText, playAnyway] = [part('#live'), part('#live-text'), part('#play-anyway')];
/** Milliseconds from the start of the tool until the rest of the page is loaded. */
const PATIENCE = 5000;
/** The most milliseconds for which the mesh of the first view stands still. */
const STILL = 2000;

/** The mesh of the first view, once it has been shown. */
let hero: Promise<Hero> | undefined;
/** Whether the page has begun with the view that its address names. */
let hasBegun = false;
/** Settles when the words of the page are on the screen. They come before the mesh. */
const words = new Promise<void>((done) => requestAnimationFrame(() => setTimeout(done)));

async function makeHero(): Promise<Hero> {
  const { Hero } = await import('../hero/hero.ts');
  const hero = new Hero(part('#first canvas'), (words) => {
    live.hidden = false;
    liveText.textContent = words;
  });
  onTheme(() => hero.repaint());
  return hero;
}

let moves = !stillness.matches;

/** Loads the tool ahead. The mesh stands still meanwhile: its motion would hold the tool up. */
const toolFirst = () => Promise.race([loadToolWhenIdle(), new Promise((done) => setTimeout(done, STILL))]);

/** Shows the first view or the tool, if the address names one of them. A link to a section only scrolls. */
function follow(): void {
  // Browsers do not find a section whose link says more after a question mark.
  if (location.hash.startsWith('#explain?')) part('#explain').scrollIntoView();
  const { view } = document.body.dataset;
  // A link to the tool may say more after a question mark.
  const next = { '#first': 'first', '#watch': 'watch' }[location.hash.replace(/\?.*/, '')] ?? view;
  if (next === view) return;
  document.body.dataset.view = next;
  // The first view lies over the tool until this has drawn its mesh. A link to the tool does not show it.
  document.body.toggleAttribute('data-opening', next === 'watch' && hasBegun);
  // The browser may be on its way to where the view was before.
  scrollTo({ top: 0, behavior: 'instant' });
  void show();
}

/** Loads all files of the page, for visits without a network. Browsers allow it over HTTPS and on this computer. */
function keepOffline(): void {
  navigator.serviceWorker?.register(new URL('offline.js', document.baseURI)).catch(() => {});
}

/** Shows the tool, once it has drawn its mesh. A sign says that it is on its way. */
async function showTool(): Promise<void> {
  const [busy, progress] = [part('#busy'), part('#progress')];
  busy.hidden = progress.hidden = false;
  if (!startedTool()) part('#busy-text').textContent = 'Loading the tool…';
  let tool: Tool;
  try {
    tool = await loadTool();
    await tool.drawn();
  } catch {
    progress.hidden = true;
    part('#busy-text').textContent = 'The tool could not be loaded. Check the connection, and load the page again.';
    return;
  }
  busy.hidden = true;
  document.body.removeAttribute('data-opening');
  loadSections();
  if (import.meta.env.PROD) setTimeout(keepOffline, PATIENCE);
  if (hero && location.hash === '#watch') tool.guide();
}

async function show(): Promise<void> {
  if (document.body.dataset.view === 'watch') {
    hero?.then(
      (hero) => hero.stop(),
      () => {},
    );
    await showTool();
  } else {
    await words;
    if (document.body.dataset.view !== 'first') return;
    try {
      hero ??= makeHero();
      await (await hero).start(moves, toolFirst);
      playAnyway.hidden = moves;
    } catch {
      // A browser without WebGL2 shows the words alone.
      live.hidden = true;
    }
  }
}

/** Loads a section when the visitor comes near it. */
function whenNear(section: string, mount: (host: HTMLElement) => Promise<void>): void {
  new IntersectionObserver(
    ([entry], observer) => {
      if (!entry?.isIntersecting) return;
      observer.disconnect();
      void mount(part(`${section} .wrap`));
    },
    { rootMargin: '300px' },
  ).observe(part(section));
}

let hasSections = false;

/** Loads the sections when the visitor comes near them. */
function loadSections(): void {
  if (hasSections) return;
  hasSections = true;
  whenNear('#explain', async (host) => (await import('../explain/index.ts')).mountExplanation(host));
  whenNear('#engines', async (host) => {
    (await import('../engines/index.ts')).mountEngines(host, () => startedTool()?.mesh());
  });
  whenNear('#paper', async (host) => (await import('../paper/index.ts')).mountPaper(host));
  whenNear('#package', async (host) => (await import('../package/index.ts')).mountPackage(host));
}

const sections = part('#sections');
sections.addEventListener('click', () => sections.hidePopover());
part('#theme').addEventListener('click', toggleTheme);
playAnyway.addEventListener('click', () => {
  moves = true;
  void show();
});
addEventListener('hashchange', follow);
// The bar needs a ground where it lies on what is read.
addEventListener('scroll', () => document.body.toggleAttribute('data-scrolled', scrollY > 8), { passive: true });
addEventListener('scroll', loadSections, { passive: true, once: true });

const way = part('.way.first');
for (const type of ['pointerenter', 'focus', 'touchstart']) {
  way.addEventListener(type, loadToolAhead, { passive: true });
}
const watch = () => (location.hash = '#watch');
const file = part<HTMLInputElement>('#file');
file.addEventListener('change', watch);
const hasFiles = ({ dataTransfer }: DragEvent) => dataTransfer?.types.includes('Files') === true;
document.addEventListener('dragenter', (event) => hasFiles(event) && loadToolAhead());
document.addEventListener('dragover', (event) => event.preventDefault());
document.addEventListener('drop', (event) => {
  event.preventDefault();
  if (!hasFiles(event)) return;
  // The tool takes what is dropped itself, once it has started.
  if (!startedTool()) {
    const drop = keptDrop(event);
    loadTool().then(
      (tool) => tool.open(drop),
      () => {},
    );
  }
  watch();
});
let width = innerWidth;
addEventListener('resize', () => {
  // The bars of a phone's browser change only the height.
  if (document.body.dataset.view === 'first' && innerWidth !== width) void show();
  width = innerWidth;
});

follow();
keepLanding();
markSections();
hasBegun = true;
if (document.body.dataset.view === 'first') {
  void show()
    .then(loadToolWhenIdle)
    // The tool comes before the sections.
    .finally(() => document.body.dataset.view === 'first' && loadSections());
}
