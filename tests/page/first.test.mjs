// Tests the first view: the words and the mesh beside them, and the way from there to the tool. It reads target/www.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { setTimeout as pause } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import site from '../../www/vite.config.js';
import { openPage, serve, startChromium } from '../browsers.mjs';
import { EdgeflipPage, file, folder, meshFile } from './page.mjs';
import { Picture } from './picture.mjs';

/** The address of the page. */
const address = () => serve(fileURLToPath(new URL('../../target/www', import.meta.url)), site.preview.headers);

/** Opens the first view in a page of its own, after `before` has prepared it. */
async function openFirst(before, ...scripts) {
  const { page, problems } = await openPage(await startChromium(), 'about:blank');
  for (const script of scripts) await page.addInitScript(script);
  await before(page);
  // A font that is late holds the event `load` up.
  await page.goto(await address(), { waitUntil: 'domcontentloaded' });
  return new EdgeflipPage(page, problems);
}

/** Runs in the page: the browser is never idle, so that the tool is loaded only when it is asked for. */
function neverIdle() {
  window.requestIdleCallback = () => 0;
}

/** Runs in the page: counts in `window.drawn` the colours of a few pixels after each picture of the first view. */
function countColours() {
  const { drawArraysInstanced } = WebGL2RenderingContext.prototype;
  window.drawn = [];
  WebGL2RenderingContext.prototype.drawArraysInstanced = function (...args) {
    drawArraysInstanced.apply(this, args);
    const { width, height } = this.canvas;
    const row = new Uint8Array(4 * width);
    this.readPixels(0, height >> 1, width, 1, this.RGBA, this.UNSIGNED_BYTE, row);
    window.drawn.push(new Set(new Uint32Array(row.buffer)).size);
  };
}

/** Runs in the page: notes how many pictures of the first view there are 400 ms after the first of them. */
function countPictures() {
  const { drawArraysInstanced } = WebGL2RenderingContext.prototype;
  window.pictures = { all: 0, soon: undefined };
  WebGL2RenderingContext.prototype.drawArraysInstanced = function (...args) {
    drawArraysInstanced.apply(this, args);
    if (window.pictures.all++ === 0) setTimeout(() => (window.pictures.soon = window.pictures.all), 400);
  };
}

/** Runs in the page: notes the workers when a mesh is drawn, and what is loaded when the first view makes way for it. */
function watchOpening() {
  const { draw } = GPURenderPassEncoder.prototype;
  let workers = 0;
  GPURenderPassEncoder.prototype.draw = function (count, ...more) {
    if (count > 3000) window.workers ??= workers;
    return draw.call(this, count, ...more);
  };
  window.Worker = class extends Worker {
    constructor(...args) {
      super(...args);
      workers++;
    }
  };
  new MutationObserver(([{ oldValue, target }]) => {
    if (oldValue === null || target.hasAttribute('data-opening')) return;
    const loaded = performance.getEntriesByType('resource').map(({ name }) => name);
    window.loaded ??= loaded.filter((name) => /thumbs|explain/.test(name));
  }).observe(document, { attributeFilter: ['data-opening'], attributeOldValue: true, subtree: true });
}

/** The right half of the first view, where no words are. */
async function pictureOf({ page }) {
  return new Picture(await page.screenshot({ clip: { x: 800, y: 100, width: 400, height: 400 } }));
}

test('the first view says where the GPU pays, and where the CPU', async () => {
  const first = await openFirst(() => {}, neverIdle);
  const words = await first.page.textContent('.pitch p');
  assert.match(words, /on the GPU; below some tens of thousands of triangles, the CPU is faster/);
  await first.close();
});

test('with reduced motion, the first view is a still picture of the mesh', async () => {
  const first = await openFirst((page) => page.emulateMedia({ reducedMotion: 'reduce' }), neverIdle);
  await first.page.waitForSelector('#live:not([hidden])');
  assert.match(await first.page.textContent('#live'), /Motion is off/);
  const picture = await pictureOf(first);
  assert.ok(picture.colours > 100, `${picture.colours} colours`);
  await pause(200);
  assert.equal((await pictureOf(first)).differsFrom(picture), 0);
  await first.close();
});

test('the first picture of the first view has the mesh, and nothing black comes before it', async () => {
  const first = await openFirst(
    () => {},
    neverIdle,
    countColours,
    () => {
      window.black = false;
      const look = () => {
        const canvas = document.querySelector('#first canvas');
        const isSeen = canvas && getComputedStyle(canvas).visibility === 'visible';
        window.black ||= isSeen === true && window.drawn.length === 0;
        requestAnimationFrame(look);
      };
      look();
    },
  );
  await first.page.waitForFunction(() => window.drawn.length > 2);
  const [colours, isBlack] = await first.page.evaluate(() => [window.drawn[0], window.black]);
  assert.ok(colours > 20, `${colours} colours in the first picture`);
  assert.equal(isBlack, false);
  // The browser warns of what the test does.
  first.problems = first.problems.filter((problem) => !problem.includes('GPU stall due to ReadPixels'));
  await first.close();
});

/** Runs in the page: the elements whose text leaves them, and the number of lines of the headline. */
function layout() {
  const lines = (node) => {
    const range = document.createRange();
    range.selectNodeContents(node);
    return [...range.getClientRects()].filter(({ width }) => width > 0);
  };
  const out = [...document.querySelectorAll('.way, nav a, button, summary, select')].filter((element) => {
    if (!element.checkVisibility({ visibilityProperty: true })) return false;
    const box = element.getBoundingClientRect();
    return lines(element).some(
      ({ left, right, top, bottom }) =>
        left < box.left - 1 || right > box.right + 1 || top < box.top - 1 || bottom > box.bottom + 1,
    );
  });
  return {
    out: out.map((element) => element.textContent.trim()),
    lines: new Set(lines(document.querySelector('#first h1')).map(({ top }) => Math.round(top))).size,
    wide: document.documentElement.scrollWidth - innerWidth,
  };
}

const WIDTHS = [360, 390, 860, 861, 1024, 1240, 1440, 1800, 1900, 1999, 2000, 2560];

for (const isLate of [false, true]) {
  test(`the headline has two lines and no text leaves its button${isLate ? ' while the font is late' : ''}`, async () => {
    const first = await openFirst(async (page) => {
      await page.emulateMedia({ reducedMotion: 'reduce' });
      // A font that is still on its way: a failed one would be a message of the console.
      if (isLate) await page.route('**/*.woff2', () => {});
    }, neverIdle);
    await first.page.waitForSelector('#live:not([hidden])');
    assert.equal(await first.page.evaluate(() => document.fonts.check('15px Inter')), !isLate);
    const seen = {};
    for (const width of WIDTHS) {
      // In a low window the headline is smaller.
      await first.page.setViewportSize({ width, height: 1300 });
      seen[width] = await first.page.evaluate(layout);
    }
    const want = Object.fromEntries(WIDTHS.map((width) => [width, { out: [], lines: 2, wide: 0 }]));
    assert.deepEqual(seen, want);
    if (isLate) {
      // The system's font is scaled: without its metrics, the words would be up to a fifth wider.
      await first.page.setViewportSize({ width: 1440, height: 900 });
      const [late, real] = [await first.page.evaluate(widths), await (await inTime()).evaluate(widths)];
      for (const [i, { text, width }] of late.entries())
        assert.ok(Math.abs(width / real[i].width - 1) < 0.1, `${text}: ${width} and ${real[i].width} wide`);
    }
    await first.close();
  });
}

/** The page with its font. */
async function inTime() {
  const first = await openFirst((page) => page.emulateMedia({ reducedMotion: 'reduce' }), neverIdle);
  await first.page.setViewportSize({ width: 1440, height: 900 });
  await first.page.evaluate(() => document.fonts.ready);
  return first.page;
}

/** Runs in the page: how wide the words of the ways and of the bar are. */
function widths() {
  return [...document.querySelectorAll('.way, .top nav a, .pitch small')].map((element) => {
    const range = document.createRange();
    range.selectNodeContents(element);
    return { text: element.textContent.trim(), width: range.getBoundingClientRect().width };
  });
}

/** Runs in the page: notes in `window.bare` each frame in which neither the first view nor a drawn mesh is there. */
function watchFrames() {
  const { submit } = GPUQueue.prototype;
  const { draw } = GPURenderPassEncoder.prototype;
  let hasMesh = false;
  window.seen = { bare: 0, covered: 0, signs: new Set(), first: undefined };
  GPURenderPassEncoder.prototype.draw = function (count, ...more) {
    hasMesh ||= count >= 6;
    return draw.call(this, count, ...more);
  };
  GPUQueue.prototype.submit = function (...args) {
    submit.apply(this, args);
    if (hasMesh) void this.onSubmittedWorkDone().then(() => (window.seen.isDrawn = true));
  };
  const look = () => {
    const shown = (selector) => document.querySelector(selector)?.checkVisibility() === true;
    if (document.body?.dataset.view === 'watch') {
      if (shown('#first')) window.seen.covered++;
      else if (!window.seen.isDrawn) window.seen.bare++;
      const busy = document.getElementById('busy');
      if (shown('#busy') && Number(getComputedStyle(busy).opacity) > 0.9)
        window.seen.signs.add(busy.textContent.trim());
    }
    requestAnimationFrame(look);
  };
  look();
}

/** Lets the answers for the tool's code wait, so that there is time to see what the page shows meanwhile. */
const slowTool = (page) =>
  page.route('**/assets/main-*.js', async (route) => {
    await pause(900);
    await route.continue();
  });

for (const [what, act] of [
  ['Watch it work', ({ page }) => page.click('.way.first')],
  [
    'opening a file',
    async ({ page }) => (await page.$('#file')).setInputFiles(await meshFile('random 24', 'mine.off')),
  ],
  [
    'a drop of a folder',
    async (first) => {
      file('early/square.off', 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n');
      await first.dropPaths([join(folder, 'early')], '.pitch');
    },
  ],
]) {
  test(`the first view stays until the mesh is drawn, after ${what}, and a sign says that it is on its way`, async () => {
    // The answers for the tool's code wait until the page says that it is being loaded.
    let release;
    const isSeen = new Promise((resolve) => (release = resolve));
    const holdTool = (page) =>
      page.route('**/assets/main-*.js', async (route) => {
        await isSeen;
        await route.continue();
      });
    const first = await openFirst(holdTool, neverIdle, watchFrames);
    await first.page.waitForSelector('#live:not([hidden])');
    await act(first);
    await first.page.waitForFunction(() => window.seen.signs.size > 0);
    release();
    const shown = await first.rest();
    const { bare, covered, signs } = await first.page.evaluate(() => ({
      ...window.seen,
      signs: [...window.seen.signs],
    }));
    assert.ok(covered > 3, `${covered} frames`);
    assert.equal(bare, 0);
    assert.match(signs[0] ?? '', /Loading the tool/);
    assert.equal(await first.page.evaluate(() => 'opening' in document.body.dataset), false);
    assert.equal(await first.page.isVisible('#first'), false);
    assert.equal(
      shown.caption,
      { 'Watch it work': 'bunny.ply', 'opening a file': 'mine.off', 'a drop of a folder': 'square.off' }[what],
    );
    await first.close();
  });
}

test('the first view stands still while the tool is loaded ahead, and then moves', async () => {
  const first = await openFirst(slowTool, countPictures);
  await first.page.waitForFunction(() => window.pictures.all > 2);
  assert.equal((await first.page.evaluate(() => window.pictures)).soon, 1);
  await first.close();
});

test('the mesh comes before the pictures of the gallery, the sections, and the worker that measures', async () => {
  const first = await openFirst(slowTool, watchOpening);
  await first.page.waitForSelector('#live:not([hidden])');
  await first.page.click('.way.first');
  await first.rest();
  // One worker reads the mesh, and one runs it.
  assert.deepEqual(await first.page.evaluate(() => [window.workers, window.loaded]), [2, []]);
  await first.page.waitForFunction(
    () => performance.getEntriesByType('resource').filter(({ name }) => /thumbs/.test(name)).length > 5,
  );
  await first.close();
});

test('the tool is loaded when the browser is idle, and the first view stays', async () => {
  const first = await openFirst(() => {});
  await first.page.waitForFunction(() => document.body.dataset.state === 'ready');
  assert.equal(await first.page.evaluate(() => document.body.dataset.view), 'first');
  assert.equal(await first.page.isVisible('.way.first'), true);
  const asked = () =>
    first.page.evaluate(
      () =>
        new Set(
          performance
            .getEntriesByType('resource')
            .map(({ name }) => name)
            .filter((name) => /\.(js|wasm|ply)$/.test(name)),
        ).size,
    );
  const before = await asked();
  await first.page.click('.way.first');
  await first.rest();
  // Nothing that it needs is loaded after the click. Workers load their scripts once more, from the cache.
  assert.equal(await first.page.evaluate(() => document.body.dataset.mesh), 'bunny.ply');
  assert.ok((await asked()) - before <= 3, 'loaded after the click');
  await first.close();
});

test('the pointer on “Watch it work” loads the tool, unless the visitor saves data', async () => {
  for (const saves of [false, true]) {
    const first = await openFirst(() => {}, neverIdle, saves ? saveData : () => {});
    await first.page.waitForSelector('#live:not([hidden])');
    await first.page.hover('.way.first');
    const hasTool = () => first.page.evaluate(() => document.body.dataset.state !== undefined);
    if (saves) {
      await pause(500);
      assert.equal(await hasTool(), false);
    } else await first.page.waitForFunction(() => document.body.dataset.state !== undefined);
    await first.close();
  }
});

/** Runs in the page: the visitor wants to save data. */
function saveData() {
  Object.defineProperty(Navigator.prototype, 'connection', { get: () => ({ saveData: true }) });
}

test('a link to the tool does not load the first view', async () => {
  const { page, problems } = await openPage(await startChromium(), 'about:blank');
  await page.addInitScript(countColours);
  await page.goto(`${await address()}#watch?mesh=random+24`);
  const edgeflip = new EdgeflipPage(page, problems);
  await edgeflip.rest();
  assert.equal(await page.evaluate(() => window.drawn.length), 0);
  assert.equal(
    await page.evaluate(() => performance.getEntriesByType('resource').some(({ name }) => /hero-/.test(name))),
    false,
  );
  await edgeflip.close();
});
