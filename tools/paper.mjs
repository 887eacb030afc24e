// Writes docs/paper.md and its plots: `npm run paper`, or `node tools/paper.mjs --from FILE.json` with measurements of
// another machine. It measures with benches/paper.rs, and keeps the measurements in benches/results.

import { execFileSync } from 'node:child_process';
import { mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { document } from './paper/document.mjs';
import * as plots from './paper/plots.mjs';

const PLOTS = {
  times: plots.times,
  figure10: plots.figure10,
  figure11: plots.figure11,
  figure12: plots.figure12,
  'figure12-1000': plots.figure12Large,
  crossover: plots.crossover,
};

const { values } = parseArgs({ options: { from: { type: 'string' }, to: { type: 'string', default: '.' } } });

const text = values.from ? readFileSync(values.from, 'utf8') : measured();
const data = JSON.parse(text);
data.date ??= new Date().toISOString().slice(0, 10);
const file = kept();
write('docs/paper.md', document(data, file));
for (const [name, plot] of Object.entries(PLOTS)) write(`docs/paper/${name}.svg`, plot(data));

function measured() {
  const arguments_ = ['bench', '--quiet', '-p', 'benches', '--bench', 'paper'];
  return execFileSync('cargo', arguments_, {
    encoding: 'utf8',
    maxBuffer: 2 ** 28,
    stdio: ['ignore', 'pipe', 'inherit'],
  });
}

/** Keeps the measurements, in place of those of the same machine. Returns the path of the file. */
function kept() {
  const folder = 'benches/results';
  const { threads, software, adapter } = data.machine;
  const machine = software ? `${threads}cores` : (/\w*\d\w*/.exec(adapter)?.[0] ?? 'gpu').toLowerCase();
  mkdirSync(join(values.to, folder), { recursive: true });
  for (const name of readdirSync(join(values.to, folder)))
    if (name.includes(`-${machine}-paper-`)) rmSync(join(values.to, folder, name));
  const path = `${folder}/${data.date}-${machine}-paper-${data.commit}.json`;
  write(path, `${JSON.stringify(data)}\n`);
  return path;
}

function write(path, content) {
  const target = join(values.to, path);
  mkdirSync(join(target, '..'), { recursive: true });
  writeFileSync(target, content);
  console.log(`paper: wrote ${target}`);
}
