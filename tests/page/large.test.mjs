// Tests the demo page in Chromium with mesh 5 of the paper: it equals the package in Node bit for bit, in the full run the
// native program, and never blocks.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { makeDelaunay } from 'edgeflip';
import { generate, readMesh } from 'edgeflip/files';
import { startChromium } from '../browsers.mjs';
import { full } from '../full.mjs';
import { fingerprintOf, folder, meshFile, openEdgeflip } from './page.mjs';
import { tasksOf } from './tasks.mjs';

const SPEC = 'uvsphere 600';
/** The most milliseconds of a task of the page's thread, except for drawing. */
const LONGEST = 200;

/** The fingerprints of the mesh and of its result on the CPU engine. */
let expected;

before(async () => {
  expected = full ? await natively() : await inNode();
});

async function inNode() {
  const mesh = await generate(SPEC);
  const { indices } = await makeDelaunay(mesh, { backend: 'cpu' });
  return { input: fingerprintOf(mesh.indices), result: fingerprintOf(indices) };
}

/** With the program that cargo builds with its tests. */
async function natively() {
  const built = process.env.CARGO_TARGET_DIR ?? fileURLToPath(new URL('../../target', import.meta.url));
  const program = join(built, 'debug/edgeflip');
  const [input, output] = [await meshFile(SPEC, 'input.off'), join(folder, 'output.off')];
  const { status, stderr, error } = spawnSync(program, [input, '-o', output, '--backend', 'cpu'], { encoding: 'utf8' });
  assert.equal(status, 0, `${program}: ${error ?? ''}${stderr}`);
  const fingerprint = async (path) => fingerprintOf((await readMesh(readFileSync(path), path)).indices);
  return { input: await fingerprint(input), result: await fingerprint(output) };
}

/**
 * Runs in the page: stores long tasks (of at least 50 ms), and the longest delay of a timer of 5 ms. The browser may
 * tell of a task long after its end.
 */
function watchLongTasks() {
  window.longTasks = [];
  window.stillFor = 0;
  let last = performance.now();
  setInterval(() => {
    const now = performance.now();
    window.stillFor = Math.max(window.stillFor, now - last);
    last = now;
  }, 5);
  new PerformanceObserver((list) => {
    for (const { startTime, duration } of list.getEntries()) window.longTasks.push({ startTime, duration });
  }).observe({ type: 'longtask', buffered: true });
}

// A software GPU takes minutes.
for (const backend of full ? ['cpu', 'webgpu'] : ['cpu']) {
  test(`720,000 triangles play to the end on ${backend} as outside the page, and no task besides drawing takes ${LONGEST} ms`, async (t) => {
    const page = await openEdgeflip(await startChromium(), watchLongTasks);
    const trace = await tasksOf(page.page);
    const opening = await page.page.evaluate(() => performance.now());
    await page.chooseEngine(backend);
    await page.choose('sample', SPEC);
    const opened = await page.rest(120);
    await page.page.evaluate(() => (window.stillFor = 0));
    assert.deepEqual([opened.facts.Vertices, opened.facts.Triangles], ['360,002', '720,000']);
    assert.equal(opened.facts.Fingerprint, expected.input);
    const start = performance.now();
    const end = await page.playToEnd(240);
    const seconds = (performance.now() - start) / 1000;
    assert.equal(end.facts.Engine, backend === 'webgpu' ? 'WebGPU' : 'CPU, in a worker');
    assert.equal(end.facts.Fingerprint, expected.result);
    assert.equal((await page.scrub('Home')).facts.Fingerprint, expected.input);
    assert.equal((await page.scrub('End')).facts.Fingerprint, expected.result);
    const { longTasks, stillFor } = await page.page.evaluate(() => ({
      longTasks: window.longTasks,
      stillFor: window.stillFor,
    }));
    const [whileOpening, seen] = [true, false].map((isOpening) =>
      longTasks.filter(({ startTime }) => startTime < opening === isOpening),
    );

    const tasks = await trace.end();
    assert.ok(tasks.length > 100, `${tasks.length} tasks`);
    const longest = (list) =>
      list.reduce((most, task) => (task.ms > most.ms ? task : most), { ms: 0, busy: 0, within: [] });
    const besidesDrawing = tasks.filter(({ draws, isOfPage }) => isOfPage && !draws);
    const [drawing, other, foreign] = [
      longest(tasks.filter(({ draws }) => draws)),
      longest(besidesDrawing),
      longest(tasks.filter(({ isOfPage }) => !isOfPage)),
    ];
    const say = ({ ms, busy, within }) => `${ms.toFixed(0)} ms, busy for ${busy.toFixed(0)} (${within.join('; ')})`;
    t.diagnostic(`${end.at} iterations in ${seconds.toFixed(1)} s`);
    t.diagnostic(`no timer for at most ${stillFor.toFixed(0)} ms while it played and was scrubbed, drawing included`);
    t.diagnostic(`longest task besides drawing: ${say(other)}`);
    t.diagnostic(`longest task with drawing: ${say(drawing)}`);
    t.diagnostic(`longest task of the browser's own: ${say(foreign)}`);
    const most = (list) => Math.max(0, ...list.map(({ duration }) => duration)).toFixed(0);
    t.diagnostic(`long tasks of the browser's own count: ${seen.length}, at most ${most(seen)} ms`);
    t.diagnostic(`long tasks while the page opened: ${whileOpening.length}, at most ${most(whileOpening)} ms`);
    // Not the duration, which depends on the load of this machine.
    const busiest = besidesDrawing.reduce((most, task) => (task.busy > most.busy ? task : most));
    assert.ok(busiest.busy <= LONGEST, `a task takes ${say(busiest)}`);
    // The trace has every long task that the page itself reports. Both have the same end; the page was seen to count
    // from up to 56 ms before the trace.
    for (const { startTime, duration } of seen) {
      const isHere = ({ end, ms }) => Math.abs(end - (startTime + duration)) <= 5 && ms >= duration / 2;
      assert.ok(tasks.some(isHere), `a long task of ${duration} ms at ${startTime} is not in the trace`);
    }
    await page.close();
  });
}
