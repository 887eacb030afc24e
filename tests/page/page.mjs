// Uses the demo page in a real browser like a user, and computes the expected results with the package in Node.
// Serves the existing target/www.

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as pause } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { FlipSession } from 'edgeflip';
import { angles, change, generate, measures, readMesh, writeMesh } from 'edgeflip/files';
import site from '../../www/vite.config.js';
import { closeAll, openPage, serve } from '../browsers.mjs';
import { Picture } from './picture.mjs';

/** The folder for the meshes of a test file. */
export const folder = mkdtempSync(join(tmpdir(), 'edgeflip-page-'));

/** For `after`: ends the browsers and removes the meshes. */
export async function tidyUp() {
  await closeAll();
  rmSync(folder, { recursive: true });
}

/** Writes a generated mesh to a file. */
export async function meshFile(spec, name) {
  const path = join(folder, name);
  writeFileSync(path, await writeMesh(await generate(spec), name));
  return path;
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

/** The expected facts for the mesh in this file, from the package on the CPU engine. */
export async function expected(path, maxNormalAngle = 10) {
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
      'Mean smallest': `${degrees.format(before.meanMin)}° → ${degrees.format(after.meanMin)}°`,
      'Mean aspect ratio': `${digits.format(input.meanAspect)} → ${digits.format(output.meanAspect)}`,
      Area: `${digits.format(input.area)} → ${digits.format(output.area)}`,
      'Changed triangles': number.format(moved.length),
    },
  };
}

let address;

/**
 * Opens the page and waits for its first mesh.
 *
 * @param browser - Chromium of playwright-core or Firefox of puppeteer-core.
 * @param {(() => void)[]} scripts - Functions that run in the page before its own scripts (Chromium).
 */
export async function openEdgeflip(browser, ...scripts) {
  address ??= await serve(fileURLToPath(new URL('../../target/www', import.meta.url)), site.preview.headers);
  const { page, problems } = await openPage(browser, 'about:blank');
  for (const script of scripts) await page.addInitScript(script);
  // Requests to other servers; `data:` and `blob:` are the page's own.
  page.on('request', (request) => {
    if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(address))
      problems.push(`asked for ${request.url()}`);
  });
  await page.goto(`${address}#watch`);
  const edgeflip = new EdgeflipPage(page, problems);
  await edgeflip.rest();
  return edgeflip;
}

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

export class EdgeflipPage {
  constructor(page, problems) {
    this.page = page;
    /** Messages of the console, exceptions and failed requests. */
    this.problems = problems;
  }

  /** Closes the page, and fails if it had a problem. */
  async close() {
    assert.deepEqual(this.problems, []);
    await this.page.close();
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
  async dropPaths(paths) {
    const session = await this.page.context().newCDPSession(this.page);
    const { x, y, width, height } = await (await this.page.$('#view')).boundingBox();
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

  /** A picture of the canvas, without what lies on it. */
  async picture() {
    const show = (opacity) =>
      this.page.evaluate((how) => {
        for (const part of document.querySelectorAll('.top, #watch > :not(#stage), #thread')) part.style.opacity = how;
        return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done())));
      }, opacity);
    await show('0');
    const canvas = await this.page.$('#view canvas');
    const picture = new Picture(await canvas.screenshot());
    await show('');
    return picture;
  }

  /** The picture of the canvas once it stands still: edges that have flipped are cool by then. */
  async stillPicture() {
    let before = await this.picture();
    for (const end = performance.now() + 60_000; performance.now() < end; ) {
      await pause(100);
      const now = await this.picture();
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
