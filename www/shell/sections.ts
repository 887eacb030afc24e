/** Marks the link to the section that is on the screen. */

/** Marks it from now on, while the visitor scrolls and the page grows. */
export function markSections(): void {
  const links = document.querySelectorAll<HTMLAnchorElement>('.top nav a');
  const sections = [...document.querySelectorAll<HTMLElement>('main > section')];
  let frame = 0;
  const mark = () => {
    frame = 0;
    // As far down the screen as the visitor is down the page. So the line also comes to the last section, which may be
    // shorter than the screen.
    const line = (innerHeight * scrollY) / Math.max(1, document.documentElement.scrollHeight - innerHeight);
    const current = sections.findLast((each) => each.offsetHeight > 0 && each.getBoundingClientRect().top <= line + 1);
    for (const link of links) {
      if (link.hash === `#${current?.id}`) link.ariaCurrent = 'location';
      else link.removeAttribute('aria-current');
    }
  };
  const soon = () => (frame ||= requestAnimationFrame(mark));
  addEventListener('scroll', soon, { passive: true });
  // Another view may be as high as the last one.
  addEventListener('hashchange', soon);
  new ResizeObserver(soon).observe(document.body);
}
