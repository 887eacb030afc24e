/** The tool: connects its controls and opens its first mesh. */

import './style.css';
import './panel.css';
import { FORMATS } from 'edgeflip/files';
import { controls, element } from './controls.ts';
import { Page } from './page.ts';
import { FIRST, SAMPLES, sampleOf } from './samples.ts';
import { chosen, dropped, sample, type Source } from './sources.ts';

/** Call it once. */
export function start(): void {
  const page = new Page();

  for (const { group, samples } of SAMPLES) {
    const options = document.createElement('optgroup');
    options.label = group;
    options.append(...samples.map(({ spec, name }) => new Option(name, spec, spec === FIRST, spec === FIRST)));
    controls.sample.append(options);
  }
  controls.sample.append(Object.assign(new Option('(a file)', ''), { hidden: true }));
  // A glTF file may have its buffers in `.bin` files.
  controls.file.accept = [...FORMATS, '.gz', '.bin'].join(',');

  function open(source: Source | undefined): void {
    if (source) void page.open(source);
  }

  controls.sample.addEventListener('change', () => open(sample(sampleOf(controls.sample.value))));
  controls.file.addEventListener('change', () => {
    open(chosen([...(controls.file.files ?? [])]));
    controls.file.value = '';
  });
  for (const control of [controls.backend, controls.beta]) control.addEventListener('change', () => void page.begin());
  controls.reset.addEventListener('click', () => page.seek(0));
  controls.play.addEventListener('click', () => void page.play());
  controls.step.addEventListener('click', () => void page.step());
  controls.slider.addEventListener('input', () => page.seek(controls.slider.valueAsNumber));
  controls.wireframe.addEventListener('change', () => void page.redraw());
  controls.download.addEventListener('click', () => void page.download());
  element('cancel').addEventListener('click', () => page.cancel());
  element('dismiss').addEventListener('click', () => (element('error').hidden = true));

  // A focused element keeps the keys that it uses itself. A disabled button ignores the click.
  const keys: Record<string, { keptBy: string; act: () => void }> = {
    ' ': { keptBy: 'button, summary, a, input, select', act: () => controls.play.click() },
    ArrowRight: { keptBy: 'input, select', act: () => controls.step.click() },
    ArrowLeft: { keptBy: 'input, select', act: () => page.seekBy(-1) },
  };
  document.addEventListener('keydown', (event) => {
    const key = keys[event.key];
    if (!key || document.body.dataset.view !== 'watch' || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target instanceof Element && event.target.closest(key.keptBy)) return;
    event.preventDefault();
    key.act();
  });

  const dropHere = element('drop-here');
  document.addEventListener('dragover', (event) => {
    event.preventDefault();
    dropHere.hidden = false;
  });
  document.addEventListener('dragleave', (event) => {
    if (!event.relatedTarget) dropHere.hidden = true;
  });
  document.addEventListener('drop', (event) => {
    event.preventDefault();
    dropHere.hidden = true;
    open(dropped(event));
  });

  // A file may have been chosen before this code was loaded.
  void page.start(chosen([...(controls.file.files ?? [])]) ?? sample(sampleOf(FIRST)));
}
