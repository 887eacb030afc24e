// A run with locked edges under 'auto' whose device is destroyed, and whose context is lost after that, ends with the right bits from
// another engine each time. The software GPUs of the browsers pass for real ones here. Takes the dist/ that is there.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { closeAll, serve, startChromium } from '../browsers.mjs';

const repository = fileURLToPath(new URL('../..', import.meta.url));

after(closeAll);

/** Runs in the page before its scripts. */
function passForReal() {
  Object.defineProperty(GPUAdapterInfo.prototype, 'isFallbackAdapter', { get: () => false });
  const { getContext } = OffscreenCanvas.prototype;
  window.contexts = [];
  OffscreenCanvas.prototype.getContext = function (type, options) {
    const context = getContext.call(this, type, { ...options, failIfMajorPerformanceCaveat: false });
    window.contexts.push(context);
    return context;
  };
  const { getParameter } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.getParameter = function (parameter) {
    const value = getParameter.call(this, parameter);
    return typeof value === 'string' ? 'a GPU' : value;
  };
}

/** Runs in the page: what the run gives after every iteration, and what of that the CPU does not. */
async function runAndLose() {
  const { FlipSession, makeDelaunay } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  const mesh = await generate('random 120');
  // An edge of every seventh triangle.
  const lockedEdges = mesh.indices.filter((_, i) => i % 21 < 2);
  const cpu = await FlipSession.create(mesh, { backend: 'cpu', lockedEdges });
  const session = await FlipSession.create(mesh, { backend: 'auto', lockedEdges });
  const engines = [];
  for (;;) {
    const iteration = await session.step();
    await cpu.step();
    engines.push((await session.result()).backend);
    const wanted = await cpu.triangles();
    if ((await session.triangles()).some((vertex, i) => vertex !== wanted[i])) return `iteration ${engines.length} is wrong`;
    if (!iteration) break;
    if (engines.length === 2) (await session.gpu()).device.destroy();
    if (engines.length === 4) window.contexts.at(-1).getExtension('WEBGL_lose_context').loseContext();
  }
  const { fallback, status, remaining } = await session.result();
  const counted = (await cpu.result()).remaining;
  // The context is gone, so a new session gets a new one; the device likewise.
  const again = await makeDelaunay(mesh, { backend: 'webgl2', lockedEdges });
  const wanted = await cpu.triangles();
  const isSame = again.indices.every((vertex, i) => vertex === wanted[i]);
  return { engines, fallback, status, remaining, counted, again: [again.backend, isSame] };
}

test('a lost device and a lost context change no result', async () => {
  const browser = await startChromium();
  const page = await browser.newPage();
  await page.addInitScript(passForReal);
  await page.goto(`${await serve(repository)}tests/engines.html`);
  const { engines, fallback, remaining, counted, ...result } = await page.evaluate(runAndLose);
  assert.deepEqual(engines.slice(0, 6), ['webgpu', 'webgpu', 'webgl2', 'webgl2', 'cpu', 'cpu']);
  assert.ok(engines.slice(6).every((engine) => engine === 'cpu'));
  assert.match(fallback, /the device failed during the run: .*; the device failed during the run: .*context was lost/);
  assert.deepEqual(result, { status: 'done', again: ['webgl2', true] });
  assert.deepEqual(remaining, counted);
  assert.ok(remaining.locked > 0);
});
