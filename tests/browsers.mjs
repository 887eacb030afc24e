// Starts the two real browsers that tests use, each with WebGPU on a software GPU, and a static server for their pages.
// A process has one of each browser, and one server for each folder. `closeAll` ends everything that was started here: a
// test file calls `after(closeAll)`.

import { spawn } from 'node:child_process';
import { accessSync, constants } from 'node:fs';
import { delimiter, isAbsolute, join } from 'node:path';
import { setTimeout as pause } from 'node:timers/promises';
import { chromium } from 'playwright-core';
import puppeteer from 'puppeteer-core';
import { preview } from 'vite';
import { full } from './full.mjs';

/** Milliseconds that a browser may take to start. On a busy machine, Firefox takes more than the usual 30 s. */
const START = 180_000;

/** @type {(() => unknown)[]} */
const closers = [];
/** What was started, by its name. */
const started = new Map();

/** Starts something at the first call with this name, and returns it at each call. */
function once(name, start) {
  if (!started.has(name)) started.set(name, start());
  return started.get(name);
}

/** Ends every browser, server and display that was started here, in reverse order. Continues if one of them fails. */
export async function closeAll() {
  started.clear();
  const errors = [];
  for (let close = closers.pop(); close; close = closers.pop()) {
    try {
      await close();
    } catch (error) {
      errors.push(error);
    }
  }
  if (errors.length > 0) throw new AggregateError(errors, `not closed: ${errors.join('; ')}`);
}

/** The first existing program of `candidates`: paths, or names on the PATH. tools/setup.sh looks for the same ones. */
function program(what, candidates) {
  const folders = (process.env.PATH ?? '').split(delimiter);
  const paths = candidates.flatMap((name) => (isAbsolute(name) ? [name] : folders.map((folder) => join(folder, name))));
  const found = paths.find((path) => {
    try {
      accessSync(path, constants.X_OK);
      return true;
    } catch {
      return false;
    }
  });
  if (found) return found;
  throw new Error(`${what} is missing: bash tools/setup.sh installs it, or says how`);
}

/**
 * Starts Chromium without a window; its GPU is SwiftShader. Screenshots of WebGPU need all four flags for the GPU.
 *
 * @returns {Promise<import('playwright-core').Browser>}
 */
export const startChromium = () => once('Chromium', chromiumOnSoftware);

async function chromiumOnSoftware() {
  const browser = await chromium.launch({
    timeout: START,
    // Without a locale, Chromium opens no file whose name is not ASCII, and says nothing.
    env: { LANG: 'C.UTF-8', ...process.env },
    executablePath:
      process.env.CHROMIUM ??
      program('Chromium', [
        'chromium',
        'chromium-browser',
        'google-chrome',
        '/Applications/Google Chrome.app/Contents/MacOS/Google Chrome',
      ]),
    args: [
      '--no-sandbox',
      '--enable-unsafe-webgpu',
      '--enable-features=Vulkan',
      '--use-vulkan=swiftshader',
      '--use-angle=swiftshader',
      // A software GPU takes longer for the text of a page than the CPU.
      '--disable-gpu-rasterization',
      '--disable-quic',
      '--no-first-run',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
    ],
  });
  closers.push(() => browser.close());
  return browser;
}

/**
 * Starts Firefox with a window, because it has no WebGPU without one. On Linux without a display, the window is on a
 * virtual display. Its GPU is the Vulkan driver's. Each wait for the GPU takes at least 100 ms.
 *
 * @returns {Promise<import('puppeteer-core').Browser>}
 */
export const startFirefox = () => once('Firefox', firefoxOnSoftware);

async function firefoxOnSoftware() {
  const needsDisplay = process.platform === 'linux' && !process.env.DISPLAY && !process.env.WAYLAND_DISPLAY;
  const browser = await puppeteer.launch({
    browser: 'firefox',
    executablePath:
      process.env.FIREFOX ??
      program('Firefox', ['firefox-esr', 'firefox', '/Applications/Firefox.app/Contents/MacOS/firefox']),
    headless: false,
    timeout: START,
    protocolTimeout: 0, // tests have their own time limits
    env: needsDisplay ? { ...process.env, DISPLAY: await display() } : process.env,
    extraPrefsFirefox: {
      'dom.webgpu.enabled': true,
      'gfx.webgpu.ignore-blocklist': true,
      'dom.serviceWorkers.enabled': false,
    },
  });
  closers.push(() => browser.close());
  return browser;
}

/** Starts an X server without a screen and returns the name of its display. */
async function display() {
  // The server takes the first free number, and writes it to pipe 3 when it accepts clients.
  const options = ['-displayfd', '3', '-screen', '0', '1280x1024x24', '-nolisten', 'tcp'];
  const server = spawn(program('Xvfb', ['Xvfb']), options, { stdio: ['ignore', 'ignore', 'pipe', 'pipe'] });
  const kill = () => server.kill();
  process.once('exit', kill);
  const ended = new Promise((resolve) => server.once('close', resolve));
  closers.push(() => {
    process.off('exit', kill);
    kill();
    return ended;
  });
  let messages = '';
  server.stderr.setEncoding('utf8').on('data', (text) => (messages += text));
  const number = await new Promise((resolve, reject) => {
    server.stdio[3].setEncoding('utf8').once('data', resolve);
    server.once('error', reject);
    server.once('close', () => reject(new Error(`Xvfb ended: ${messages}`)));
  });
  return `:${number.trim()}`;
}

/** The headers of a cross-origin isolated page, whose workers can share memory. */
export const ISOLATED = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };

/**
 * Serves the files of a folder on localhost. For browsers, localhost is a secure context, which WebGPU needs.
 *
 * @param {string} folder
 * @param {Record<string, string>} [headers] - Sent with every answer.
 * @returns {Promise<string>} The URL of the folder, with a slash at its end.
 */
export const serve = (folder, headers = {}) =>
  once(`${folder} ${JSON.stringify(headers)}`, () => serverOf(folder, headers));

async function serverOf(folder, headers) {
  const server = await preview({
    root: folder,
    configFile: false,
    appType: 'mpa', // a missing file is a 404, not index.html
    logLevel: 'error', // no warning about the output folder
    build: { outDir: folder },
    preview: { host: 'localhost', port: 0, headers },
  });
  closers.push(() => server.close());
  return server.resolvedUrls.local[0];
}

/**
 * Opens a page and collects its problems: errors and warnings on the console, uncaught exceptions, and failed requests.
 *
 * @template {import('playwright-core').Browser | import('puppeteer-core').Browser} B
 * @param {B} browser
 * @param {string} address
 * @param {boolean} isKept - Whether the page may keep its files for visits without a network. Each page would load all
 *   of them again.
 * @returns {Promise<{ page: Awaited<ReturnType<B['newPage']>>, problems: string[] }>}
 */
export async function openPage(browser, address, isKept = false) {
  // In the short run a software GPU draws a quarter of the pixels, and fewer frames. Firefox takes no options.
  const page = await browser.newPage(full ? undefined : { deviceScaleFactor: 0.5 });
  if (!full) await page.addInitScript?.(fewerFrames);
  // Firefox has a setting for this.
  if (!isKept) await page.addInitScript?.(() => delete Navigator.prototype.serviceWorker);
  const problems = [];
  page.on('console', (message) => {
    // Chromium tells so of each call that waits for WebGL2, and an update that untangles has to.
    if (message.text().endsWith('GPU stall due to ReadPixels') || message.text().includes('ReadPixels (this message'))
      return;
    if (['error', 'warn', 'warning'].includes(message.type())) problems.push(`${message.type()}: ${message.text()}`);
  });
  page.on('pageerror', (error) => problems.push(`not caught: ${error}`));
  page.on('response', (response) => {
    if (response.status() >= 400) problems.push(`${response.status()}: ${response.url()}`);
  });
  page.on('requestfailed', (request) => problems.push(`failed: ${request.url()}: ${failure(request)}`));
  await page.goto(address);
  return { page, problems };
}

/**
 * Runs in the page: it gets at most 16 frames a second. Callbacks run in the order in which they were asked for, as in
 * any browser: the page relies on it.
 */
function fewerFrames() {
  const { requestAnimationFrame } = window;
  /** What the next frame runs. */
  const asked = new Map();
  let [last, count, isDue] = [0, 0, false];
  const draw = (now) => {
    [last, isDue] = [now, false];
    // What these ask for belongs to the frame after this one. They may cancel each other.
    for (const id of [...asked.keys()]) {
      const callback = asked.get(id);
      asked.delete(id);
      try {
        callback?.(now);
      } catch (error) {
        reportError(error);
      }
    }
  };
  window.requestAnimationFrame = (callback) => {
    asked.set(++count, callback);
    if (!isDue) setTimeout(() => requestAnimationFrame(draw), last + 60 - performance.now());
    isDue = true;
    return count;
  };
  window.cancelAnimationFrame = (id) => void asked.delete(id);
}

/**
 * Waits until a page has drawn two frames: the second shows what was changed before the call. It asks again and again:
 * Chromium 148 may collect the promise of a page that a test awaits (mended in V8 by its commit 5177b10891e6).
 */
export async function twoFrames(page) {
  await page.evaluate(() => {
    window.hasDrawn = false;
    requestAnimationFrame(() => requestAnimationFrame(() => (window.hasDrawn = true)));
  });
  for (const end = performance.now() + 60_000; !(await page.evaluate(() => window.hasDrawn)); await pause(10))
    if (performance.now() > end) throw new Error('the page draws no two frames for 60 s');
}

const failure = (request) => request.failure()?.errorText ?? 'no reason given';
