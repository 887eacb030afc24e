// Takes screenshots of the page in target/www. `npm run screenshots` builds the page and takes every state, light and
// dark, wide and narrow, into target/screenshots. `npm run picture` takes the picture in README: docs/page.png.

import { mkdirSync } from 'node:fs';
import { resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { closeAll, serve, startChromium } from '../tests/browsers.mjs';

process.chdir(fileURLToPath(new URL('..', import.meta.url)));
const folder = 'target/screenshots';
const picture = 'docs/page.png';

const looks = [];
for (const colorScheme of ['light', 'dark']) {
  looks.push({ look: `wide-${colorScheme}`, colorScheme, viewport: { width: 1280, height: 800 } });
  looks.push({ look: `narrow-${colorScheme}`, colorScheme, viewport: { width: 390, height: 844 } });
}

const state = (page, ...states) =>
  page.waitForFunction((states) => states.includes(document.body.dataset.state), states);
const measured = (page) => page.waitForFunction(() => document.body.dataset.measured !== undefined);
const sample = async (page, spec) => {
  await page.selectOption('#sample', spec);
  await page.waitForFunction((spec) => document.querySelector('#caption').textContent === spec, spec);
  await measured(page);
};

/** The actions that reach each state, in this order on one page. */
const states = {
  ready: (page) => measured(page),
  running: async (page) => {
    await page.selectOption('#speed', '250');
    await page.click('#play');
    await page.waitForFunction(() => Number(document.querySelector('#slider').max) > 1);
  },
  done: async (page) => {
    await state(page, 'done');
    await measured(page);
  },
  'worst-case': async (page) => {
    await sample(page, 'strips 16');
    for (let i = 1; i <= 3; i++) {
      await page.click('#step');
      await page.waitForFunction((at) => document.body.dataset.measured === at, `${i}`);
    }
  },
  webgpu: async (page) => {
    await page.selectOption('#backend', 'webgpu');
    await page.waitForSelector('dd[data-fact=Adapter]');
    await page.click('#step');
    await page.waitForFunction(() => document.body.dataset.measured === '1');
  },
  loading: async (page) => {
    await page.selectOption('#backend', 'auto');
    await measured(page);
    await page.selectOption('#sample', 'uvsphere 600');
  },
  large: async (page) => {
    await page.waitForFunction(() => document.querySelector('#caption').textContent === 'uvsphere 600');
    await measured(page);
  },
  error: async (page) => {
    const buffer = Buffer.from('OFF\n3 1 0\n0 0 0\n1 0 0\n0 x 0\n3 0 1 2\n');
    await page.setInputFiles('#file', { name: 'broken.off', mimeType: 'text/plain', buffer });
    await page.waitForSelector('#error:not([hidden])');
  },
};

/** Random points in the middle of their run, light and wide. */
async function takePicture(browser, address) {
  const page = await browser.newPage({ colorScheme: 'light', viewport: { width: 1280, height: 800 } });
  await page.goto(`${address}#watch`);
  await measured(page);
  await sample(page, 'random 24');
  for (let i = 1; i <= 2; i++) {
    await page.click('#step');
    await page.waitForFunction((at) => document.body.dataset.measured === at, `${i}`);
  }
  await page.waitForTimeout(300); // until it is drawn
  await page.screenshot({ path: picture });
  console.log(picture);
}

/** Each state in each look. */
async function takeAll(browser, address) {
  mkdirSync(folder, { recursive: true });
  for (const { look, ...options } of looks) {
    const context = await browser.newContext(options);
    const page = await context.newPage();
    const shoot = async (name) => {
      await page.waitForTimeout(300); // until it is drawn
      await page.screenshot({ path: `${folder}/${look}-${name}.png`, fullPage: true });
    };
    await page.goto(`${address}#watch`);
    for (const [name, reach] of Object.entries(states)) {
      await reach(page);
      await shoot(name);
    }
    // Without the WebAssembly modules, the page has no mesh to show.
    await context.route('**/*.wasm', (route) => route.abort());
    await page.goto(`${address}#watch`);
    await page.waitForSelector('#error:not([hidden])');
    await shoot('empty');
    await context.close();
    console.log(`${folder}/${look}-*.png`);
  }
}

try {
  const address = await serve(resolve('target/www'));
  const browser = await startChromium();
  await (process.argv[2] === 'picture' ? takePicture : takeAll)(browser, address);
} finally {
  await closeAll();
}
