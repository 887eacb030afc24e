// The pages in examples/, served by `examples/vite.config.js`, in Chromium. Uses the existing dist/.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { createServer } from 'vite';
import { closeAll, openPage, startChromium, startFirefox } from '../browsers.mjs';
import { full } from '../full.mjs';
import { repository } from './project.mjs';

/** Frames of each moving example. */
const frames = Number(process.env.EDGEFLIP_FRAMES ?? (full ? 12 : 6));

let server;
before(async () => {
  const configFile = join(repository, 'examples/vite.config.js');
  server = await createServer({ configFile, logLevel: 'warn', server: { port: 0 } });
  await server.listen();
});
after(async () => {
  await closeAll();
  await server.close();
});

const open = async (name) => openPage(await startChromium(), `${server.resolvedUrls.local[0]}${name}`);
const stateOf = (page, pattern) =>
  page
    .waitForFunction(
      (pattern) => {
        const { value } = document.querySelector('output');
        return new RegExp(pattern).test(value) && value;
      },
      pattern,
      { timeout: 60_000 },
    )
    .then((handle) => handle.jsonValue());

test('a worker flips, and the page shows its progress', async () => {
  const { page, problems } = await open('worker.html?size=100');
  await page.click('#run:enabled');
  assert.match(await stateOf(page, '^done'), /^done: \d{4,} flips in \d+ iterations on cpu$/);
  assert.ok(await page.isDisabled('#run'));
  assert.deepEqual(problems, []);
  await page.close();
});

for (const [name, button, pattern] of [
  ['three', 'flip', /^\d{3,} flips on (cpu|webgpu)$/],
  [
    'terrain',
    'bring',
    /^\d{2,} edges made way for the water, \d+ flips made the rest Delaunay; the lake has \d{2,} triangles$/,
  ],
]) {
  test(`three.js draws what became Delaunay: ${name}.html`, async () => {
    const { page, problems } = await open(`${name}.html`);
    await page.waitForSelector(`#${button}:enabled`);
    const picture = () => page.locator('canvas').screenshot();
    /** The first picture that differs, because the software GPU takes its time. */
    const pictureAfter = async (old) => {
      for (const start = performance.now(); performance.now() - start < 30_000; await page.waitForTimeout(200)) {
        const now = await picture();
        if (!now.equals(old)) return now;
      }
      return old;
    };
    await page.waitForTimeout(1000);
    const before = await picture();
    assert.deepEqual(await picture(), before);
    await page.click(`#${button}`);
    assert.match(await stateOf(page, ' flips '), pattern);
    assert.notDeepEqual(await pictureAfter(before), before);
    assert.deepEqual(problems, []);
    await page.close();
  });
}

/**
 * Runs in the page: draws a frame, gives its positions to a session on the CPU, which must give the same, and audits the
 * triangles. Returns the flips so far.
 */
async function checkedFrame(frame) {
  const { session, mesh, frame: draw, iterations } = globalThis.example;
  const FlipSession = session.constructor;
  const options = { backend: 'cpu', maxNormalAngle: mesh.dimension === 3 ? 30 : 10 };
  if (!globalThis.cpu) {
    globalThis.cpu = await FlipSession.create(mesh, options);
    await cpu.run();
  }
  draw(frame / 30);
  const counters = await session.counters();
  const { device, positions } = await session.gpu();
  const size = mesh.positions.byteLength;
  const staging = device.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  const encoder = device.createCommandEncoder();
  encoder.copyBufferToBuffer(positions, 0, staging, 0, size);
  device.queue.submit([encoder.finish()]);
  await staging.mapAsync(GPUMapMode.READ);
  const moved = new Float32Array(staging.getMappedRange().slice(0));
  staging.destroy();
  cpu.update({ positions: moved, iterations });
  const [triangles, expected] = [await session.triangles(), await cpu.triangles()];
  if (triangles.some((vertex, i) => vertex !== expected[i])) throw new Error(`frame ${frame}: other triangles`);
  const counted = [counters, await cpu.counters()].map((counters) => JSON.stringify(counters));
  if (counted[0] !== counted[1]) throw new Error(`frame ${frame}: ${counted}`);
  const check = await FlipSession.create({ ...mesh, positions: moved, indices: triangles }, options);
  const { clean } = await check.verify();
  check.free();
  if (!clean) throw new Error(`frame ${frame}: the audit finds a violation`);
  return counters.flips;
}

/** Draws frames of an example, and checks each. */
async function checkFrames(page, count) {
  await page.waitForFunction(() => globalThis.example);
  let flips = 0;
  for (let frame = 0; frame < count; frame++) flips = await page.evaluate(checkedFrame, frame);
  return flips;
}

for (const [name, size] of [
  ['sheet', full ? 101 : 51],
  ['waves', full ? 100 : 50],
  ['relax', full ? 101 : 51],
  ['flock', full ? 101 : 51],
  ['cloth', full ? 81 : 41],
]) {
  test(`${name}: the mesh moves and is checked in every frame`, async () => {
    const { page, problems } = await open(`${name}.html?paused&size=${size}`);
    const flips = await checkFrames(page, frames);
    assert.ok(flips > (full ? 100 : 10), `${flips} flips`);
    assert.deepEqual(problems, []);
    await page.close();
  });
}

test('flock: walks find the neighbours that brute force finds, and no bird leaves the box', async () => {
  const size = full ? 101 : 51;
  const { page, problems } = await open(`flock.html?paused&size=${size}`);
  await page.waitForFunction(() => globalThis.example);
  for (let frame = 0; frame < frames; frame++) {
    const { sums, counters } = await page.evaluate(async () => {
      const { check, session } = globalThis.example;
      return { sums: await check(1), counters: await session.counters() };
    });
    const { found, ...faults } = sums;
    assert.deepEqual(faults, { lost: 0, wrong: 0 });
    assert.ok(found > 5 * size ** 2, `${found} neighbours`);
    assert.deepEqual([counters.inverted, counters.remaining.stopped ?? 0], [0, 0]);
  }
  assert.match(await page.textContent('#check'), /^[\d,]+ neighbours are those that a search among all birds finds$/);
  const outside = await page.evaluate(async () => [...(await globalThis.example.session.problems()).outside]);
  assert.deepEqual(outside, []);
  assert.deepEqual(problems, []);
  await page.close();
});

if (full) {
  test('the sheet moves in Firefox', async () => {
    const firefox = await startFirefox();
    const { page, problems } = await openPage(firefox, `${server.resolvedUrls.local[0]}sheet.html?paused&size=101`);
    assert.ok((await checkFrames(page, frames)) > 100);
    assert.deepEqual(problems, []);
    await page.close();
  });
}

test('an example plays by itself', async () => {
  const { page, problems } = await open('sheet.html?size=20');
  assert.match(await stateOf(page, ' frames a second'), /^\d+ frames a second, \d+ flips a frame, \d+ edges left$/);
  assert.deepEqual(problems, []);
  await page.close();
});
