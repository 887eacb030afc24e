// A recorded run of a hardware GPU in Chromium, from benches/results, for the section of the engines.

import { readFileSync } from 'node:fs';
import { anchorOf } from '../documents/markdown.js';

const NAME = '2026-11-30-h200-auto-bb6ecde';

/** The device, the browser, the date, and the milliseconds of each engine by mesh. Its source is its part of a page. */
export function recordedRun() {
  const text = readFileSync(new URL(`../../benches/results/${NAME}.md`, import.meta.url), 'utf8');
  const [, device, cores] = text.match(/^(NVIDIA \w+), .*?(\d+) cores\./m);
  const [section] = text.match(/^## Chromium \d+, ready[^]*?(?=^## )/m);
  const [, browser, runs] = section.match(/^## (Chromium \d+), ready: `benches\/crossover.html` with (\d+) runs/);
  const heading = section.slice(3, section.indexOf('\n'));
  const lines = section.split('\n').filter((line) => line.startsWith('|'));
  const [names, , ...rows] = lines.map((line) =>
    line
      .split('|')
      .slice(1, -1)
      .map((cell) => cell.trim()),
  );
  const meshes = rows.map((row) => {
    const cell = (name) => row[names.indexOf(name)];
    const ms = { cpu: Number(cell('cpu ms')), webgpu: Number(cell('webgpu ms')), webgl2: Number(cell('webgl2 ms')) };
    return { spec: cell('mesh'), triangles: Number(cell('triangles')), ms };
  });
  const [date] = NAME.match(/^\d{4}-\d\d-\d\d/);
  return {
    device,
    cores: Number(cores),
    browser,
    date,
    runs: Number(runs),
    meshes,
    source: `benches/results/${NAME}.html#${anchorOf(heading)}`,
  };
}
