// The two real browsers that tests use, each with WebGPU on a software GPU, and a static server for their pages.
// Whatever was started here is ended by `closeAll`: `after(closeAll)` in a test file.

import { spawn } from 'node:child_process';
import { accessSync, constants } from 'node:fs';
import { delimiter, isAbsolute, join } from 'node:path';
import { chromium } from 'playwright-core';
import puppeteer from 'puppeteer-core';
import { preview } from 'vite';

/** @type {(() => unknown)[]} */
const closers = [];

/** Ends every browser, server and display that was started here, the last one first, also if one of them fails. */
export async function closeAll() {
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

/** The first program that there is: a path, or a name on the PATH. tools/setup.sh looks for the same ones. */
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
  throw new Error(`${what} is not here: bash tools/setup.sh installs it, or says what to do`);
}

/**
 * Chromium, headless; its GPU is SwiftShader. All four flags for the GPU are needed to see what WebGPU draws.
 *
 * @returns {Promise<import('playwright-core').Browser>}
 */
export async function startChromium() {
  const browser = await chromium.launch({
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
 * Firefox, with a window: it has WebGPU only so. On Linux without a display the window is on one that nobody sees.
 * Its GPU is the Vulkan driver's. What waits for its GPU waits 100 ms at least.
 *
 * @returns {Promise<import('puppeteer-core').Browser>}
 */
export async function startFirefox() {
  const needsDisplay = process.platform === 'linux' && !process.env.DISPLAY && !process.env.WAYLAND_DISPLAY;
  const browser = await puppeteer.launch({
    browser: 'firefox',
    executablePath:
      process.env.FIREFOX ??
      program('Firefox', ['firefox-esr', 'firefox', '/Applications/Firefox.app/Contents/MacOS/firefox']),
    headless: false,
    protocolTimeout: 0, // a test knows how long it waits
    env: needsDisplay ? { ...process.env, DISPLAY: await display() } : process.env,
    extraPrefsFirefox: { 'dom.webgpu.enabled': true, 'gfx.webgpu.ignore-blocklist': true },
  });
  closers.push(() => browser.close());
  return browser;
}

/** Starts an X server without a screen and gives the name of its display. */
async function display() {
  // It takes the first number that is free and writes it to the pipe 3 when clients can come.
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

/** What a page is cross-origin isolated with, so that its workers may share memory. */
export const ISOLATED = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };

/**
 * Serves the files of a folder on localhost, which browsers take for a secure context: without one there is no WebGPU.
 *
 * @param {string} folder
 * @param {Record<string, string>} [headers] - Sent with every answer.
 * @returns {Promise<string>} The address of the folder, with a slash at its end.
 */
export async function serve(folder, headers = {}) {
  const server = await preview({
    root: folder,
    configFile: false,
    appType: 'mpa', // what is not there is a 404, not index.html
    logLevel: 'error', // not that the folder is no place for a build
    build: { outDir: folder },
    preview: { host: 'localhost', port: 0, headers },
  });
  closers.push(() => server.close());
  return server.resolvedUrls.local[0];
}

/**
 * Opens a page and collects what goes wrong on it: errors and warnings on its console, exceptions that nothing
 * catches, answers of a server that are no success.
 *
 * @template {import('playwright-core').Browser | import('puppeteer-core').Browser} B
 * @param {B} browser
 * @param {string} address
 * @returns {Promise<{ page: Awaited<ReturnType<B['newPage']>>, problems: string[] }>}
 */
export async function openPage(browser, address) {
  const page = await browser.newPage();
  const problems = [];
  page.on('console', (message) => {
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

const failure = (request) => request.failure()?.errorText ?? 'no reason given';
