/** Keeps the section at the top of the view to which a link has led, while the page above it still grows. */

/** How far from the top a section may be, in pixels, to count as the place to which a link has led. */
const NEAR = 2;

/** What a visitor scrolls with. Other scrolling is seen by its effect. */
const OWN = ['wheel', 'touchmove', 'pointerdown', 'keydown'];

/** Keeps it there from now on, until the visitor scrolls. */
export function keepLanding(): void {
  let section: HTMLElement | null = null;
  /** Where it was in the page, and where the view was. */
  let place = 0;
  let view = 0;
  const placeOf = (of: HTMLElement) => Math.round(of.getBoundingClientRect().top + scrollY);
  const note = () => {
    if (section) [place, view] = [placeOf(section), scrollY];
  };
  const release = () => (section = null);
  const target = () => {
    const [id] = location.hash.slice(1).split('?');
    return id ? document.querySelector<HTMLElement>(`main > #${CSS.escape(id)}.read`) : null;
  };
  const land = () => {
    section = target();
    // A step back leads to where the visitor was.
    if (section && Math.abs(section.getBoundingClientRect().top) > NEAR) release();
    note();
  };
  const keep = () => {
    if (!section) return;
    if (placeOf(section) !== place) section.scrollIntoView({ behavior: 'instant' });
    // The section has not moved, so the visitor has.
    else if (Math.abs(scrollY - view) > NEAR) release();
    note();
  };
  // A link that leads to the present address changes nothing but the view.
  document.addEventListener('click', ({ target }) => {
    if (target instanceof Element && target.closest('a[href^="#"]')) setTimeout(land);
  });
  addEventListener('hashchange', land);
  for (const type of OWN) addEventListener(type, release, { passive: true, capture: true });
  addEventListener('scroll', keep, { passive: true });
  const growth = new ResizeObserver(keep);
  for (const each of document.querySelectorAll('main > section')) growth.observe(each);
  const [arrival] = performance.getEntriesByType('navigation') as PerformanceNavigationTiming[];
  if (arrival?.type !== 'navigate') return;
  // The browser may not have gone there yet.
  section = target();
  section?.scrollIntoView({ behavior: 'instant' });
  note();
}
