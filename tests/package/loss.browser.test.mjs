// 'auto' starts on the CPU, moves to the GPU when it is ready, and continues on the CPU after the device is destroyed
// during a run with locked edges. A lost WebGL2 context is an error of one session. The browser's software GPU pretends
// to be a hardware GPU here. Uses the existing dist/.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { closeAll, serve, startChromium } from '../browsers.mjs';
import { full } from '../full.mjs';

const repository = fileURLToPath(new URL('../..', import.meta.url));

after(closeAll);

/** A mesh that `auto` gives to a GPU. */
const SPEC = full ? 'random 200' : 'random 150';

/** Runs in the page before its scripts. */
function passForReal() {
  Object.defineProperty(GPUAdapterInfo.prototype, 'isFallbackAdapter', { get: () => false });
}

async function openPage() {
  const browser = await startChromium();
  const page = await browser.newPage();
  await page.addInitScript(passForReal);
  await page.goto(`${await serve(repository)}tests/engines.html`);
  return page;
}

/** Runs in the page: returns every iteration of the run, and the differences from the CPU. */
async function runAndLose(spec) {
  const { FlipSession, makeDelaunay } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  const mesh = await generate(spec);
  // Locks an edge of every seventh triangle.
  const options = { maxIterations: 4, lockedEdges: mesh.indices.filter((_, i) => i % 21 < 2) };
  const first = await makeDelaunay(mesh, options);
  let second = first;
  // A run that has a fallback began on the CPU, even if it ended on the GPU.
  while (second.fallback) {
    await new Promise((resolve) => setTimeout(resolve, 100));
    second = await makeDelaunay(mesh, options);
  }
  const isSame = second.indices.every((vertex, i) => vertex === first.indices[i]);
  const begun = [first, second].map(({ backend, fallback }) => ({ backend, fallback }));

  const cpu = await FlipSession.create(mesh, { ...options, backend: 'cpu' });
  const session = await FlipSession.create(mesh, options);
  const engines = [];
  for (;;) {
    const iteration = await session.step();
    await cpu.step();
    engines.push(await session.backend());
    const wanted = await cpu.triangles();
    if ((await session.triangles()).some((vertex, i) => vertex !== wanted[i]))
      return `iteration ${engines.length} is wrong`;
    if (!iteration) break;
    if (engines.length === 2) (await session.gpu()).device.destroy();
  }
  const { fallback, status, remaining } = await session.result();
  const counted = (await cpu.result()).remaining;
  // The next session starts while a new device is prepared.
  const { backend: again } = await makeDelaunay(mesh, options);
  return { begun, isSame, engines, fallback, status, remaining, counted, again };
}

test('auto does not wait for the GPU, moves to it when it is ready, and a lost GPU changes no result', async () => {
  const page = await openPage();
  const { begun, isSame, engines, fallback, status, remaining, counted, again } = await page.evaluate(runAndLose, SPEC);
  assert.deepEqual(begun, [
    { backend: 'cpu', fallback: 'the gpu was not ready; it starts up during this run' },
    { backend: 'webgpu', fallback: undefined },
  ]);
  assert.ok(isSame);
  assert.deepEqual(engines, ['webgpu', 'webgpu', 'cpu', 'cpu', 'cpu']);
  assert.match(fallback, /^the device failed during the run: /);
  assert.deepEqual([status, remaining, again], ['stopped', counted, 'cpu']);
  assert.ok(remaining.locked > 0);
});

/**
 * Runs in the page: runs that begin before the GPU is ready. The first iteration decides whether a run changes to the
 * GPU. If the machine is busy just then, the run seems to be nearly done and stays on the CPU; the next one may change.
 */
async function runAndChange(spec) {
  const { FlipSession, makeDelaunay } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  const mesh = await generate(spec);
  const sessions = [];
  for (let i = 0; i < 6; i++) sessions.push(await FlipSession.create(mesh));
  const begun = await Promise.all(sessions.map((session) => session.backend()));
  while ((await makeDelaunay(mesh, { maxIterations: 1 })).backend === 'cpu')
    await new Promise((resolve) => setTimeout(resolve, 100));
  const cpu = await makeDelaunay(mesh, { backend: 'cpu' });
  let found;
  for (const session of sessions) {
    const progress = [];
    const result = await session.run({ onProgress: ({ iterations }) => progress.push(iterations) });
    const { backend, fallback } = result;
    const isSame =
      cpu.indices.every((vertex, i) => vertex === result.indices[i]) &&
      `${cpu.flipsPerIteration}` === `${result.flipsPerIteration}`;
    const isSorted = progress.every((n, i) => i === 0 || n >= progress[i - 1]);
    found = { begun: [...new Set(begun)].join(), backend, fallback, first: progress[0], isSorted, isSame };
    if (backend === 'webgpu' || !isSame) break;
  }
  return found;
}

test('a run that starts on the CPU continues on the GPU when it is ready', async () => {
  const found = await (await openPage()).evaluate(runAndChange, full ? 'random 300' : 'random 200');
  const fallback = 'the cpu began, until the gpu was ready';
  assert.deepEqual(found, { begun: 'cpu', backend: 'webgpu', fallback, first: 1, isSorted: true, isSame: true });
});

/** Runs in the page. */
async function loseContext() {
  const { FlipSession, makeDelaunay } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  const { getContext } = OffscreenCanvas.prototype;
  let context;
  OffscreenCanvas.prototype.getContext = function (type, options) {
    return (context = getContext.call(this, type, options));
  };
  const mesh = await generate('random 40');
  const session = await FlipSession.create(mesh, { backend: 'webgl2' });
  await session.step();
  context.getExtension('WEBGL_lose_context').loseContext();
  const error = await session.step().catch(({ code, message }) => ({ code, message }));
  // The next session gets a new context.
  const { indices } = await makeDelaunay(mesh, { backend: 'webgl2' });
  const cpu = await makeDelaunay(mesh, { backend: 'cpu' });
  return { error, isSame: cpu.indices.every((vertex, i) => vertex === indices[i]) };
}

test('a lost context is an error of its session alone', async () => {
  const { error, isSame } = await (await openPage()).evaluate(loseContext);
  assert.equal(error.code, 'device-failed');
  assert.match(error.message, /context was lost/);
  assert.ok(isSame);
});
