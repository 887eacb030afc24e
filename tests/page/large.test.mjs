// The demo page in Chromium with mesh 5 of the paper: as the native program bit for bit, and the page never waits.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { readMesh } from 'edgeflip/files';
import { startChromium } from '../browsers.mjs';
import { fingerprintOf, folder, openEdgeflip, tidyUp } from './page.mjs';
import { tasksOf } from './tasks.mjs';

const SPEC = 'uvsphere 600';
/** Milliseconds that a task of the page's thread may take, besides drawing. */
const LONGEST = 200;

let browser;
/** What the native program makes of it on its CPU engine. */
let native;

before(async () => {
  browser = await startChromium();
  const [input, output] = [join(folder, 'input.off'), join(folder, 'output.off')];
  cargo('run', '-q', '--example', 'generate', '--', SPEC, input);
  cargo('run', '-q', '--', input, '-o', output, '--backend', 'cpu');
  const fingerprint = async (path) => fingerprintOf((await readMesh(readFileSync(path), path)).indices);
  native = { input: await fingerprint(input), result: await fingerprint(output) };
});
after(tidyUp);

function cargo(...args) {
  const cwd = fileURLToPath(new URL('../..', import.meta.url));
  const { status, stderr, error } = spawnSync('cargo', args, { cwd, encoding: 'utf8' });
  assert.equal(status, 0, `cargo ${args.join(' ')}: ${error ?? ''}${stderr}`);
}

/** In the page: keeps what the browser calls a long task, of 50 ms at least. */
function watchLongTasks() {
  window.longTasks = [];
  new PerformanceObserver((list) => {
    for (const { duration } of list.getEntries()) window.longTasks.push(duration);
  }).observe({ type: 'longtask', buffered: true });
}

for (const backend of ['cpu', 'webgpu']) {
  test(`720,000 triangles play to the end on ${backend} as in the native program, and no task besides drawing takes ${LONGEST} ms`, async (t) => {
    const page = await openEdgeflip(browser, watchLongTasks);
    const trace = await tasksOf(page.page);
    const whileOpening = await page.page.evaluate(() => window.longTasks.splice(0));
    await page.chooseEngine(backend);
    await page.choose('sample', SPEC);
    const opened = await page.rest(120);
    assert.deepEqual([opened.facts.Vertices, opened.facts.Triangles], ['360,002', '720,000']);
    assert.equal(opened.facts.Fingerprint, native.input);
    const start = performance.now();
    const end = await page.playToEnd(240);
    const seconds = (performance.now() - start) / 1000;
    assert.equal(end.facts.Engine, backend === 'webgpu' ? 'WebGPU' : 'CPU, in a worker');
    assert.equal(end.facts.Fingerprint, native.result);
    assert.equal((await page.scrub('Home')).facts.Fingerprint, native.input);
    assert.equal((await page.scrub('End')).facts.Fingerprint, native.result);
    const seen = await page.page.evaluate(() => window.longTasks);

    const tasks = await trace.end();
    assert.ok(tasks.length > 100, `${tasks.length} tasks`);
    const longest = (list) => list.reduce((most, task) => (task.ms > most.ms ? task : most), { ms: 0, busy: 0, within: [] });
    const [drawing, other, foreign] = [
      longest(tasks.filter(({ draws }) => draws)),
      longest(tasks.filter(({ draws, isOfPage }) => isOfPage && !draws)),
      longest(tasks.filter(({ isOfPage }) => !isOfPage)),
    ];
    const say = ({ ms, busy, within }) => `${ms.toFixed(0)} ms, busy for ${busy.toFixed(0)} (${within.join('; ')})`;
    t.diagnostic(`${end.at} iterations in ${seconds.toFixed(1)} s`);
    t.diagnostic(`longest task besides drawing: ${say(other)}`);
    t.diagnostic(`longest task with drawing: ${say(drawing)}`);
    t.diagnostic(`longest task of the browser's own: ${say(foreign)}`);
    t.diagnostic(`long tasks of the browser's own count: ${seen.length}, at most ${Math.max(0, ...seen).toFixed(0)} ms`);
    t.diagnostic(`long tasks while the page opened: ${whileOpening.length}, at most ${Math.max(0, ...whileOpening).toFixed(0)} ms`);
    assert.ok(other.ms <= LONGEST, `a task takes ${say(other)}`);
    // The trace has seen what the page itself has.
    assert.ok(Math.max(0, ...seen) <= longest(tasks).ms + 5, 'a long task is not in the trace');
    await page.close();
  });
}
