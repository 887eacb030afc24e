/** Starts the page: the first view at once, everything else when it is asked for. */

import type { NamedMesh } from '../engines/index.ts';
import type { Hero } from '../hero/hero.ts';
import { number } from './numbers.ts';
import { stillness } from './stillness.ts';
import { onTheme, toggleTheme } from './theme.ts';

const part = <T extends HTMLElement>(selector: string): T => {
  const found = document.querySelector<T>(selector);
  if (!found) throw new Error(`the page has no ${selector}`);
  return found;
};

const [live, liveText, playAnyway] = [part('#live'), part('#live-text'), part('#play-anyway')];
/** Milliseconds from the start of the tool until the rest of the page is loaded. */
const PATIENCE = 5000;

/** The first view, once it has been shown. */
let hero: Promise<Hero> | undefined;

async function makeHero(): Promise<Hero> {
  const { Hero } = await import('../hero/hero.ts');
  const hero = new Hero(part('#first canvas'), ({ triangles, flips }) => {
    live.hidden = false;
    liveText.textContent = stillness.matches
      ? `${number.format(triangles)} triangles. Motion is off, as your system asks.`
      : `Live: ${number.format(triangles)} triangles, ${number.format(flips)} flips in this frame`;
  });
  onTheme(() => hero.repaint());
  return hero;
}

let moves = !stillness.matches;

/** The tool, once it has been asked for, and the mesh that is open in it. */
let tool: Promise<() => NamedMesh | undefined> | undefined;
let openMesh = (): NamedMesh | undefined => undefined;

/** Shows the first view or the tool, if the address names one of them. A link to a section only scrolls. */
function follow(): void {
  for (const link of document.querySelectorAll('.top nav a')) {
    link.toggleAttribute('aria-current', link.getAttribute('href') === location.hash.replace(/\?.*/, ''));
  }
  const { view } = document.body.dataset;
  // A link to the tool may say more after a question mark.
  const next = { '#first': 'first', '#watch': 'watch' }[location.hash.replace(/\?.*/, '')] ?? view;
  if (next === view) return;
  document.body.dataset.view = next;
  // The browser may be on its way to where the view was before.
  scrollTo({ top: 0, behavior: 'instant' });
  void show();
}

/** Loads all files of the page, for visits without a network. Browsers allow it over HTTPS and on this computer. */
function keepOffline(): void {
  navigator.serviceWorker?.register(new URL('offline.js', document.baseURI)).catch(() => {});
}

async function show(): Promise<void> {
  if (document.body.dataset.view === 'watch') {
    void hero?.then((hero) => hero.stop());
    tool ??= import('../watch/main.ts').then(({ start }) => start());
    openMesh = await tool;
    if (import.meta.env.PROD) setTimeout(keepOffline, PATIENCE);
  } else {
    try {
      hero ??= makeHero();
      await (await hero).start(moves);
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

whenNear('#explain', async (host) => (await import('../explain/index.ts')).mountExplanation(host));
whenNear('#engines', async (host) => (await import('../engines/index.ts')).mountEngines(host, () => openMesh()));
whenNear('#paper', async (host) => (await import('../paper/index.ts')).mountPaper(host));

const sections = part('#sections');
sections.addEventListener('click', () => sections.hidePopover());
part('#theme').addEventListener('click', toggleTheme);
playAnyway.addEventListener('click', () => {
  moves = true;
  void show();
});
// The guide of the tool begins only on this way.
part('.way.first').addEventListener('click', () => document.body.toggleAttribute('data-guided', true));
addEventListener('hashchange', follow);
// The bar needs a ground where it lies on what is read.
addEventListener('scroll', () => document.body.toggleAttribute('data-scrolled', scrollY > 8), { passive: true });
const watch = () => (location.hash = '#watch');
part('#file').addEventListener('change', watch);
document.addEventListener('dragenter', watch);
let width = innerWidth;
addEventListener('resize', () => {
  // The bars of a phone's browser change only the height.
  if (document.body.dataset.view === 'first' && innerWidth !== width) void show();
  width = innerWidth;
});

follow();
if (document.body.dataset.view === 'first') void show();
