/** The elements of the page that the code uses. */

export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
}

export const controls = {
  file: element<HTMLInputElement>('file'),
  sample: element<HTMLSelectElement>('sample'),
  backend: element<HTMLSelectElement>('backend'),
  beta: element<HTMLInputElement>('beta'),
  reset: element<HTMLButtonElement>('reset'),
  play: element<HTMLButtonElement>('play'),
  step: element<HTMLButtonElement>('step'),
  slider: element<HTMLInputElement>('slider'),
  speed: element<HTMLSelectElement>('speed'),
  wireframe: element<HTMLInputElement>('wireframe'),
  download: element<HTMLButtonElement>('download'),
};
