// Tests the demo page in Chromium while its GPU compiles: a run starts on the CPU, and moves to WebGPU when it pauses.

import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { startChromium } from '../browsers.mjs';
import { full } from '../full.mjs';
import { expected, first, meshFile, openEdgeflip } from './page.mjs';

let strips;
before(async () => (strips = await meshFile('strips 80', 'strips.off')));

const UNTIL_READY = 'CPU, until WebGPU is ready';

/**
 * Runs in the page. Its GPU pretends to be a hardware GPU. No kernel is compiled before `compile` is called, and none
 * after `refuse`. `seen` has the time of the first event of each kind, in milliseconds, and the number of requested
 * kernels.
 */
function holdKernels() {
  Object.defineProperty(GPUAdapterInfo.prototype, 'isFallbackAdapter', { get: () => false });
  const seen = { kernels: 0, devices: [], busy: 0 };
  window.seen = seen;
  const first = (what) => (seen[what] ??= performance.now());
  const held = new Promise((resolve) => (window.compile = resolve));
  window.refuse = () => {
    // A validation error, because the package checks for it.
    const { createComputePipeline } = GPUDevice.prototype;
    GPUDevice.prototype.createComputePipeline = function ({ compute, ...more }) {
      return createComputePipeline.call(this, { ...more, compute: { ...compute, entryPoint: 'none' } });
    };
    window.compile();
  };
  const { createComputePipelineAsync, createBuffer } = GPUDevice.prototype;
  GPUDevice.prototype.createComputePipelineAsync = async function (...args) {
    first('kernel');
    seen.kernels++;
    await held;
    first('compiled');
    return createComputePipelineAsync.apply(this, args);
  };
  GPUDevice.prototype.createBuffer = function (...args) {
    if (args[0].label === 'shown triangles') first('behind');
    return createBuffer.apply(this, args);
  };
  const { requestDevice } = GPUAdapter.prototype;
  GPUAdapter.prototype.requestDevice = async function (...args) {
    const device = await requestDevice.apply(this, args);
    seen.devices.push(device);
    return device;
  };
  for (const { prototype } of [GPURenderPassEncoder, GPURenderBundleEncoder]) {
    const { draw } = prototype;
    prototype.draw = function (...args) {
      first('picture');
      return draw.apply(this, args);
    };
  }
  const { postMessage } = Worker.prototype;
  Worker.prototype.postMessage = function (message, ...more) {
    if (message.path?.at(-1) === 'measure') first('measured');
    return postMessage.call(this, message, ...more);
  };
  addEventListener('DOMContentLoaded', () => {
    const busy = document.getElementById('busy');
    new MutationObserver(() => (seen.busy += busy.hidden ? 0 : 1)).observe(busy, { attributeFilter: ['hidden'] });
  });
}

/** Runs in the page, after `holdKernels`. Frames come late until the first picture, as on a busy machine. */
function delayFrames() {
  const { requestAnimationFrame } = window;
  const isLate = () => window.seen.picture === undefined;
  window.requestAnimationFrame = (callback) =>
    isLate() ? setTimeout(() => requestAnimationFrame(callback), 500) : requestAnimationFrame(callback);
}

const seen = (page) => page.page.evaluate(() => ({ ...window.seen, devices: window.seen.devices.length }));
const announcement = (page) => page.page.textContent('#announcement');
const focus = (page) => page.page.evaluate(() => document.activeElement.id);
const columns = ({ rows }) => rows.map((row) => row.slice(0, 4));
const onWebGpu = (page) =>
  page.until('WebGPU', ({ facts, measured, at }) => facts.Engine === 'WebGPU' && measured === at);

test('the first mesh is drawn before any kernel is requested, plays on the CPU, and moves to WebGPU after the compilation', async (t) => {
  const { rows, facts, fingerprints } = await expected(first.path, first.maxNormalAngle);
  const page = await openEdgeflip(await startChromium(), holdKernels, delayFrames);
  const opened = await page.look();
  assert.deepEqual([opened.backend, opened.facts.Engine, opened.note], ['auto', UNTIL_READY, '']);
  await page.page.waitForFunction(() => window.seen.kernels > 0);
  const { picture, kernel, measured } = await seen(page);
  t.diagnostic(
    `picture after ${picture.toFixed(0)} ms, measured from ${measured.toFixed(0)} ms, kernels from ${kernel.toFixed(0)} ms`,
  );
  assert.ok(
    picture < kernel && picture < measured,
    `picture at ${picture}, kernels at ${kernel}, measured at ${measured}`,
  );

  const end = await page.playToEnd();
  assert.deepEqual([end.facts.Engine, columns(end), end.facts.Fingerprint], [UNTIL_READY, rows, facts.Fingerprint]);
  await page.scrub('Home');
  const before = await page.scrub('ArrowRight');
  const picturedBefore = await page.picture();
  const { compiled, busy } = await seen(page);
  assert.deepEqual([before.at, before.facts.Engine, compiled], ['1', UNTIL_READY, undefined]);

  await page.page.evaluate(() => window.compile());
  const after = await onWebGpu(page);
  assert.match(after.facts.Adapter, /\S/);
  assert.equal(await announcement(page), 'Now on WebGPU.');
  const same = ({ at, newest, state, status, error, note, caption, facts: { Fingerprint, Smallest, Area } }) => ({
    at,
    newest,
    state,
    status,
    error,
    note,
    caption,
    Fingerprint,
    Smallest,
    Area,
  });
  assert.deepEqual(same(after), same(before));
  assert.deepEqual(columns(after), rows);
  assert.deepEqual([await focus(page), (await seen(page)).busy], ['slider', busy]);
  assert.equal((await page.picture()).differsFrom(picturedBefore), 0, 'the picture has changed');

  for (let at = 2; at < fingerprints.length; at++) {
    assert.equal((await page.scrub('ArrowRight')).facts.Fingerprint, fingerprints[at], `after iteration ${at}`);
  }
  assert.deepEqual([(await page.look()).state, (await page.look()).at], ['done', `${rows.length}`]);

  // A mesh of the same form starts on WebGPU, with the same kernels.
  const { kernels } = await seen(page);
  const next = await page.open(await meshFile('roof 16', 'roof.off'));
  assert.deepEqual([next.caption, next.facts.Engine, (await seen(page)).kernels], ['roof.off', 'WebGPU', kernels]);
  await page.close();
});

test('a run that plays while the kernels become ready moves to the GPU when it is paused, at the same iteration', async () => {
  const { rows, facts, fingerprints } = await expected(strips);
  const page = await openEdgeflip(await startChromium(), holdKernels);
  await page.open(strips);
  await page.choose('speed', '250');
  await page.page.click('#play');
  await page.page.evaluate(() => window.compile());
  await page.page.waitForFunction(() => window.seen.behind !== undefined);
  const { at, state } = await page.look();
  assert.equal(state, 'playing');
  const later = await page.until(
    'a few more iterations',
    (seen) => Number(seen.at) >= Number(at) + 4 || seen.state !== 'playing',
  );
  assert.deepEqual([later.state, later.facts.Engine], ['playing', UNTIL_READY]);
  await page.page.click('#play');
  const paused = await page.until('the pause', ({ state }) => state === 'ready');
  const after = await onWebGpu(page);
  assert.ok(Number(after.at) - Number(paused.at) <= 1 && after.at === after.newest, `from ${paused.at} to ${after.at}`);
  assert.equal(after.facts.Fingerprint, fingerprints[after.at]);
  assert.deepEqual(columns(after), rows.slice(0, after.at));
  await page.page.click('#step');
  const next = `${Number(after.at) + 1}`;
  const stepped = await page.until('an iteration', ({ at, measured }) => at === next && measured === next);
  assert.deepEqual([stepped.facts.Engine, stepped.facts.Fingerprint], ['WebGPU', fingerprints[next]]);
  if (full) {
    const end = await page.playToEnd();
    assert.deepEqual([end.facts.Engine, columns(end), end.facts.Fingerprint], ['WebGPU', rows, facts.Fingerprint]);
  }
  await page.close();
});

test('if the GPU refuses the kernels, the run stays on the CPU and says why', async () => {
  const path = await meshFile(full ? 'strips 80' : 'strips 16', 'refused.off');
  const { rows, facts } = await expected(path);
  const page = await openEdgeflip(await startChromium(), holdKernels);
  await page.open(path);
  await page.page.click('#step');
  const before = await page.until('an iteration', ({ at, measured }) => at === '1' && measured === '1');
  assert.deepEqual([before.facts.Engine, before.note], [UNTIL_READY, '']);
  await page.page.evaluate(() => window.refuse());
  const after = await page.until('the reason', ({ note, measured }) => note !== '' && measured === '1');
  assert.match(after.note, /^On the CPU: .*it refuses the kernels.*\.$/s);
  assert.match(await announcement(page), /On the CPU: /);
  assert.deepEqual(
    [after.backend, after.error, after.at, after.facts.Engine, after.facts.Adapter],
    ['auto', '', '1', 'CPU, in a worker', undefined],
  );
  assert.equal(after.facts.Fingerprint, before.facts.Fingerprint);
  const end = await page.playToEnd();
  assert.deepEqual([columns(end), end.facts.Fingerprint], [rows, facts.Fingerprint]);
  await page.close();
});

test('a GPU that is lost while it compiles is replaced, and the run on the CPU is at the same iteration', async () => {
  const { fingerprints } = await expected(strips);
  const page = await openEdgeflip(await startChromium(), holdKernels);
  await page.open(strips);
  for (const at of ['1', '2', '3']) {
    await page.page.click('#step');
    await page.until('an iteration', (seen) => seen.at === at && seen.measured === at);
  }
  await page.scrub('ArrowLeft');
  for (const [devices, backend, engine] of [
    [2, 'auto', UNTIL_READY],
    [3, 'cpu', 'CPU, in a worker'],
  ]) {
    await page.page.evaluate(() => window.seen.devices.at(-1).destroy());
    await page.page.waitForFunction((many) => window.seen.devices.length === many, devices);
    await page.until(
      'a message',
      ({ error, state }) => /The GPU was lost.*The run was repeated/.test(error) && state !== 'busy',
    );
    const { at, newest, facts, ...seen } = await page.rest();
    assert.deepEqual(
      [seen.backend, facts.Engine, at, newest, facts.Fingerprint],
      [backend, engine, '2', '3', fingerprints[2]],
    );
    assert.ok((await page.picture()).colours > 3);
    await page.page.click('#dismiss');
  }
  await page.close();
});
