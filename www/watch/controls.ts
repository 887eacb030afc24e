/** The elements of the page that the code uses. */

/** A screen on which the parts of the tool are below each other, as in the style sheets. */
export const NARROW = '(max-width: 860px)';

export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
}

const input = (id: string) => element<HTMLInputElement>(id);
const button = (id: string) => element<HTMLButtonElement>(id);

export const controls = {
  file: input('file'),
  backend: element<HTMLSelectElement>('backend'),
  speed: element<HTMLSelectElement>('speed'),
  slider: input('slider'),
  reset: button('reset'),
  back: button('back'),
  play: button('play'),
  step: button('step'),
  phase: button('phase'),
  compare: button('compare'),
  cut: input('cut'),
  surface: element<HTMLSelectElement>('surface'),
  scramble: button('scramble'),
  draw: button('draw'),
  limit: button('limit'),
  take: button('take'),
  picture: button('picture'),
  beta: input('beta'),
  betaRange: input('beta-range'),
  deviation: input('deviation'),
  feature: input('feature'),
  groups: input('groups'),
};
