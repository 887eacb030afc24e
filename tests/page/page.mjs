// Uses the demo page in a real browser like a user, and computes the expected results with the package in Node.
// Serves the existing target/www. Tests share a page where they can, because a software GPU takes longer to compile the
// kernels of a page than to run them.

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after } from 'node:test';
import { setTimeout as pause } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { FlipSession } from 'edgeflip';
import { angles, change, generate, measures, readMesh, writeMesh } from 'edgeflip/files';
import { SAMPLES } from '../../www/models/samples.js';
import site from '../../www/vite.config.js';
import { closeAll, openPage, serve, startChromium, startFirefox, twoFrames } from '../browsers.mjs';
import { Picture } from './picture.mjs';

/** The folder for the meshes of the tests. */
export const folder = mkdtempSync(join(tmpdir(), 'edgeflip-page-'));

after(async () => {
  await closeAll();
  rmSync(folder, { recursive: true });
});

/** Writes a file, and creates its folders. */
export function file(name, contents) {
  const path = join(folder, name);
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(path, contents);
  return path;
}

/** Writes a generated mesh to a file, in a folder for its family. */
export async function meshFile(spec, name) {
  return file(join(spec.replace(/\W+/g, '-'), name), await writeMesh(await generate(spec), name));
}

const number = new Intl.NumberFormat('en');
const degrees = new Intl.NumberFormat('en', { maximumFractionDigits: 2, minimumFractionDigits: 2 });
const digits = new Intl.NumberFormat('en', { maximumSignificantDigits: 6 });

/** The fingerprint, as the page shows it. */
export function fingerprintOf(indices) {
  return createHash('sha256').update(indices).digest('hex').slice(0, 16);
}

/** The mesh that the page shows first, and its β. */
export const first = {
  path: fileURLToPath(new URL('../../target/public/models/bunny.ply', import.meta.url)),
  maxNormalAngle: 30,
};

const results = new Map();

/** The expected facts for the mesh in this file, from the package on the CPU engine. They are computed once. */
export function expected(path, maxNormalAngle = 10) {
  const key = `${path}, ${maxNormalAngle}`;
  if (!results.has(key)) results.set(key, expect(path, maxNormalAngle));
  return results.get(key);
}

async function expect(path, maxNormalAngle) {
  const mesh = await readMesh(readFileSync(path), path);
  const session = await FlipSession.create(mesh, { backend: 'cpu', maxNormalAngle });
  const rows = [];
  const fingerprints = [fingerprintOf(mesh.indices)];
  for await (const { index, labelled, flips, blocked } of session) {
    const stopped = Object.values(blocked).reduce((sum, count) => sum + count, 0);
    rows.push([index + 1, labelled, flips, stopped].map((count) => number.format(count)));
    fingerprints.push(fingerprintOf(await session.triangles()));
  }
  const result = await session.result();
  session.free();
  const left = Object.entries(result.remaining);
  // The meshes of the tests have no edge left but creases.
  assert.ok(left.every(([reason]) => reason === 'angle'));
  const end = { ...mesh, indices: result.indices };
  const [before, after] = [await angles(mesh), await angles(end)];
  const [input, output] = [await measures(mesh), await measures(end)];
  const { moved } = await change(mesh, result.indices);
  return {
    mesh,
    indices: result.indices,
    rows,
    /** Fingerprints of the input and after each iteration. */
    fingerprints,
    facts: {
      Triangles: number.format(mesh.indices.length / 3),
      Vertices: number.format(mesh.positions.length / mesh.dimension),
      Iterations: number.format(result.iterations),
      Flips: number.format(result.flips),
      'Not Delaunay': left.map(([, count]) => `${number.format(count)} at a crease`)[0] ?? 'none',
      Fingerprint: fingerprintOf(result.indices),
      Smallest: `${degrees.format(before.min)}° → ${degrees.format(after.min)}°`,
      'Smallest on average': `${degrees.format(before.meanMin)}° → ${degrees.format(after.meanMin)}°`,
      'Mean aspect ratio': `${digits.format(input.meanAspect)} → ${digits.format(output.meanAspect)}`,
      Area: `${digits.format(input.area)} → ${digits.format(output.area)}`,
      'Changed triangles': number.format(moved.length),
    },
  };
}

/** Opens a page of Chromium or Firefox at a part of the tool, and waits for its mesh. */
async function openAt(hash, browser, scripts) {
  const address = await serve(fileURLToPath(new URL('../../target/www', import.meta.url)), site.preview.headers);
  const { page, problems } = await openPage(browser, 'about:blank');
  for (const script of scripts) await page.addInitScript(script);
  // Requests to other servers; `data:` and `blob:` are the page's own.
  page.on('request', (request) => {
    if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(address))
      problems.push(`asked for ${request.url()}`);
  });
  await page.goto(`${address}${hash}`);
  const edgeflip = new EdgeflipPage(page, problems);
  await edgeflip.rest();
  return edgeflip;
}

/**
 * Opens a new page and waits for its first mesh.
 *
 * @param browser - Chromium of playwright-core or Firefox of puppeteer-core.
 * @param {(() => void)[]} scripts - Functions that run in the page before its own scripts (Chromium).
 */
export const openEdgeflip = (browser, ...scripts) => openAt('#watch', browser, scripts);

/** A page that tests share. */
class Shared {
  #open;
  page;

  constructor(open) {
    this.#open = open;
  }

  /** The page as a link to a sample opens it, with the engine `auto` and the β that suits the sample. */
  async show(mesh) {
    // A test that failed may have left the page in any state.
    if (this.page?.isInUse) {
      await this.page.page.close();
      this.page = undefined;
    }
    const beta = SAMPLES.find(({ spec }) => spec === mesh)?.beta ?? 10;
    const link = `#watch?${new URLSearchParams({ mesh, engine: 'auto', beta: `${beta}` })}`;
    if (this.page) await this.page.follow(link);
    else this.page = await this.#open(link);
    this.page.isInUse = true;
    return this.page;
  }
}

const inChromium = new Shared(async (link) => openAt(link, await startChromium(), [keepDevices, holdWorkers]));
/** After a β was entered, a page keeps it for all meshes. */
const withOwnBeta = new Shared(async (link) => openAt(link, await startChromium(), [holdWorkers]));
const inFirefox = new Shared(async (link) => openAt(link, await startFirefox(), []));

/** The page of Chromium that tests share, at a sample. Its GPU devices are in `window.devices`. */
export const sharedPage = (mesh = 'random 24') => inChromium.show(mesh);

/** The page of Chromium that tests share if they enter a β. It shows a surface, which has one. */
export const pageForBeta = () => withOwnBeta.show('roof 16');

/** The page of Firefox that tests share. */
export const pageInFirefox = () => inFirefox.show('random 24');

/** For `openEdgeflip`: keeps the GPU devices of the page in `window.devices`, so that a test can lose them. */
export function keepDevices() {
  const { requestDevice } = GPUAdapter.prototype;
  window.devices = [];
  GPUAdapter.prototype.requestDevice = async function (...args) {
    const device = await requestDevice.apply(this, args);
    window.devices.push(device);
    return device;
  };
}

/** Loses the device of a page that has `keepDevices`. Returns the number of its devices so far. */
export function loseDevice({ page }) {
  return page.evaluate(() => {
    window.devices.at(-1).destroy();
    return window.devices.length;
  });
}

/** For `openEdgeflip`: holds back the messages to workers, by the name of the method, until they are released. */
export function holdWorkers() {
  const { postMessage } = Worker.prototype;
  const held = new Set();
  const waiting = [];
  window.hold = (method) => held.add(method);
  window.waiting = () => waiting.length;
  window.letGo = () => {
    held.clear();
    for (const send of waiting.splice(0)) send();
  };
  Worker.prototype.postMessage = function (message, ...more) {
    const send = () => postMessage.call(this, message, ...more);
    if (held.has(message.path?.at(-1))) waiting.push(send);
    else send();
  };
}

export class EdgeflipPage {
  constructor(page, problems) {
    this.page = page;
    /** Messages of the console, exceptions and failed requests. */
    this.problems = problems;
    /** Whether a test has the page, if tests share it. */
    this.isInUse = undefined;
  }

  /** Closes the page, or leaves it to the next test. Fails if it had a problem. */
  async close() {
    assert.deepEqual(this.problems, []);
    if (this.isInUse) this.isInUse = false;
    else await this.page.close();
  }

  /** Closes what is open on the page, and follows a link. The engine, the limits and the speed become those of a new page. */
  async follow(link) {
    await this.page.evaluate(async (to) => {
      for (const open of document.querySelectorAll(':popover-open')) open.hidePopover();
      document.getElementById('keys').close();
      document.getElementById('details').open = false;
      for (const id of ['speed', 'many']) {
        const choice = document.getElementById(id);
        choice.value = (choice.querySelector('[selected]') ?? choice.options[0]).value;
      }
      document.activeElement.blur();
      // A message, the inspector, and what lies under it.
      for (let i = 0; i < 3; i++)
        document.dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape', bubbles: true }));
      scrollTo({ top: 0, behavior: 'instant' });
      // The address has to change, also if the same link was followed before.
      history.replaceState(null, '', '#watch');
      await new Promise((resolve) => {
        addEventListener('hashchange', resolve, { once: true });
        location.hash = to;
      });
    }, link);
    return this.rest();
  }

  /** The texts and the state of the page. */
  look() {
    return this.page.evaluate(() => {
      const text = (id) => {
        const found = document.getElementById(id);
        return found.hidden ? '' : found.textContent;
      };
      return {
        state: document.body.dataset.state,
        measured: document.body.dataset.measured,
        at: document.getElementById('slider').value,
        newest: document.body.dataset.newest,
        backend: document.getElementById('backend').value,
        error: text('error'),
        note: text('note'),
        status: text('status'),
        /** The name of its file or sample. */
        caption: document.body.dataset.mesh,
        facts: Object.fromEntries(
          [...document.querySelectorAll('dd[data-fact]')].map((dd) => [dd.dataset.fact, dd.textContent]),
        ),
        rows: [...document.querySelectorAll('#rows tr')].map((row) => [...row.cells].map((cell) => cell.textContent)),
      };
    });
  }

  /** Waits until the condition holds for the page, and returns its texts then. */
  async until(what, isSo, seconds = 120) {
    const end = performance.now() + 1000 * seconds;
    for (;;) {
      const seen = await this.look();
      if (isSo(seen)) return seen;
      assert.ok(
        performance.now() < end,
        `not after ${seconds} s: ${what}; the page says ${JSON.stringify({ ...seen, rows: seen.rows.length })}`,
      );
      await pause(30);
    }
  }

  /** Waits until the page is idle and has measured the shown triangles. */
  rest(seconds) {
    return this.until(
      'a page at rest',
      ({ state, measured, at }) => /^(ready|done)$/.test(state) && measured === at,
      seconds,
    );
  }

  async open(path) {
    const input = await this.page.$('#file');
    await (input.setInputFiles ?? input.uploadFile).call(input, path);
    return this.rest();
  }

  /** Drops a file onto the page. */
  async drop(path, name) {
    const bytes = readFileSync(path, 'base64');
    await this.page.evaluate(
      ([base64, file]) => {
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([Uint8Array.from(atob(base64), (char) => char.charCodeAt(0))], file));
        for (const type of ['dragover', 'drop']) {
          document
            .getElementById('view')
            .dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
        }
      },
      [bytes, name],
    );
    return this.rest();
  }

  /** Drops files and folders from the disk onto the page, as a file manager does (Chromium). */
  async dropPaths(paths, onto = '#view') {
    const session = await this.page.context().newCDPSession(this.page);
    const { x, y, width, height } = await (await this.page.$(onto)).boundingBox();
    const drag = { x: x + width / 2, y: y + height / 2, data: { items: [], files: paths, dragOperationsMask: 1 } };
    for (const type of ['dragEnter', 'dragOver', 'drop'])
      await session.send('Input.dispatchDragEvent', { type, ...drag });
    await session.detach();
  }

  /** Chooses an engine, a speed or a sample. */
  async choose(id, value) {
    if (id === 'sample') return this.page.click(`#gallery [data-spec="${value}"]`);
    if (id === 'backend') await this.page.evaluate(() => (document.getElementById('details').open = true));
    await (this.page.selectOption ?? this.page.select).call(this.page, `#${id}`, value);
  }

  async chooseEngine(backend) {
    if ((await this.look()).backend === backend) return;
    await this.choose('backend', backend);
    await this.rest();
  }

  /** Shows the limits, which hide when another part of the page is clicked. */
  showLimits() {
    return this.page.evaluate(() => document.getElementById('limits').showPopover());
  }

  /** Enters a β. */
  async setBeta(text) {
    assert.ok(this !== inChromium.page, 'this page would keep the β for the tests after this one; take `pageForBeta`');
    await this.showLimits();
    await this.page.fill('#beta', text);
    await this.page.press('#beta', 'Tab');
    await this.page.evaluate(() => document.getElementById('limits').hidePopover());
  }

  /** Plays to the end, as fast as possible. */
  async playToEnd(seconds) {
    await this.choose('speed', '0');
    await this.page.click('#play');
    await this.until('the end of the run', ({ state }) => state === 'done', seconds);
    return this.rest(seconds);
  }

  /** Moves the slider to one of its ends. */
  async scrub(key) {
    await this.page.focus('#slider');
    await this.page.keyboard.press(key);
    return this.rest();
  }

  /** A picture of the middle of the canvas, a share of its width and height, without what lies on it. */
  async picture(share = 0.5) {
    const show = async (opacity) => {
      const others = await this.page.$$('.top, #watch > :not(#stage), #thread');
      for (const part of others) await part.evaluate(({ style }, how) => (style.opacity = how), opacity);
      await twoFrames(this.page);
    };
    await show('0');
    const { x, y, width, height } = await (await this.page.$('#view canvas')).boundingBox();
    const [left, top] = [x + ((1 - share) / 2) * width, y + ((1 - share) / 2) * height].map(Math.round);
    const clip = { x: left, y: top, width: Math.round(share * width), height: Math.round(share * height) };
    const picture = new Picture(await this.page.screenshot({ clip }));
    await show('');
    return picture;
  }

  /** The picture of the canvas once it stands still: edges that have flipped are cool by then. */
  async stillPicture(share) {
    let before = await this.picture(share);
    for (const end = performance.now() + 60_000; performance.now() < end; ) {
      await pause(100);
      const now = await this.picture(share);
      if (now.differsFrom(before) === 0) return now;
      before = now;
    }
    return assert.fail('the picture does not stand still for 60 s');
  }

  /** The mesh in the file that the page writes. */
  async download() {
    await this.page.click('#take');
    const [download] = await Promise.all([this.page.waitForEvent('download'), this.page.click('#download')]);
    await this.page.keyboard.press('Escape');
    const bytes = readFileSync(await download.path());
    return { ...(await readMesh(bytes, download.suggestedFilename())), name: download.suggestedFilename(), bytes };
  }
}

/**
 * Plays to the end. Asserts that the page shows the results of the package in Node, names the GPU if there is one, and
 * draws another picture than before.
 *
 * @param {EdgeflipPage} page - At the input.
 * @param want - The result of `expected` for its mesh.
 * @param {string} engine - The engine's name on the page.
 * @returns The picture of the input.
 */
export async function assertPlays(page, { rows, facts }, engine) {
  const inputPicture = await page.picture();
  assert.ok(inputPicture.colours > 3, `${inputPicture.colours} colours of the input`);
  const end = await page.playToEnd();
  assert.deepEqual(
    end.rows.map((row) => row.slice(0, 4)),
    rows,
  );
  assert.equal(end.at, `${rows.length}`);
  for (const [fact, value] of Object.entries(facts)) assert.equal(end.facts[fact], value, fact);
  assert.equal(end.facts.Engine, engine);
  if (!engine.startsWith('CPU')) {
    assert.match(end.facts.Adapter, /\S/);
    assert.ok(
      Number(end.facts.Dispatches.replaceAll(',', '')) >= 3 * rows.length,
      `${end.facts.Dispatches} dispatches`,
    );
  } else {
    assert.deepEqual([end.facts.Adapter, end.facts.Dispatches], [undefined, undefined]);
  }
  const endPicture = await page.picture();
  assert.ok(endPicture.colours > 3, `${endPicture.colours} colours of the result`);
  assert.ok(endPicture.differsFrom(inputPicture) > 0.01, 'the result looks like the input');
  return inputPicture;
}

/** Asserts that two meshes are equal, bit for bit. */
export function assertSameMesh(actual, { positions, indices }, what) {
  const bits = (floats) => new Uint32Array(floats.buffer, floats.byteOffset, floats.length);
  assert.deepEqual(actual.indices, indices, `indices ${what}`);
  assert.deepEqual(bits(actual.positions), bits(positions), `positions ${what}`);
}
