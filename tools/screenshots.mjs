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
  for (const [width, height] of [
    [390, 844],
    [1440, 900],
    [2560, 1300],
  ]) {
    looks.push({ look: `${width}-${colorScheme}`, colorScheme, viewport: { width, height } });
  }
}

const state = (page, ...states) =>
  page.waitForFunction((states) => states.includes(document.body.dataset.state), states);
const measured = (page) => page.waitForFunction(() => document.body.dataset.measured !== undefined);
const pick = async (page, spec) => {
  // On a narrow screen, the gallery is behind the name.
  const choose = page.locator('#choose');
  if (await choose.isVisible()) await choose.click();
  await page.click(`#gallery [data-spec="${spec}"]`);
};
const sample = async (page, spec) => {
  await pick(page, spec);
  await named(page, spec);
  await measured(page);
};
const moving = async (page, kind) => {
  await pick(page, `moving ${kind}`);
  await state(page, 'moving');
  await page.waitForTimeout(2000); // until edges have flipped
};
const named = (page, spec) =>
  page.waitForFunction((name) => document.body.dataset.mesh === name, spec.replace('models/', ''));
const chooseEngine = async (page, backend) => {
  await page.evaluate(() => (document.getElementById('details').open = true));
  await page.selectOption('#backend', backend);
};
const press = async (page, key) => {
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press(key);
};

/** Presses at one place and moves to another, in shares of the part of the picture that is free. */
const drag = async (page, ...places) => {
  const [width, height] = await page.evaluate(() => {
    const [canvas, side] = ['#view canvas', '.side'].map((name) =>
      document.querySelector(`#watch ${name}`).getBoundingClientRect(),
    );
    return [side.left > innerWidth / 2 ? side.left : canvas.width, canvas.height];
  });
  const [from, to] = places.map(([x, y]) => [x * width, y * height]);
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move(...to, { steps: 5 });
};

/** The actions that reach each state, in this order on one page. */
const states = {
  input: (page) => measured(page),
  inspected: (page) => press(page, 'n'),
  middle: async (page) => {
    await press(page, 'Escape');
    await press(page, 'ArrowRight');
    await page.waitForFunction(() => document.body.dataset.measured === '1');
  },
  done: async (page) => {
    await press(page, 'End');
    await state(page, 'done');
    await measured(page);
  },
  'before-now': (page) => press(page, 'c'),
  limits: async (page) => {
    await press(page, 'c');
    await press(page, 'l');
  },
  away: async (page) => {
    await press(page, 'Escape');
    await press(page, 's');
  },
  keys: async (page) => {
    await press(page, 'Escape');
    await press(page, '?');
  },
  details: async (page) => {
    await page.keyboard.press('Escape');
    await page.evaluate(() => {
      const details = document.getElementById('details');
      details.open = true;
      details.scrollIntoView({ block: 'nearest' });
    });
  },
  plane: async (page) => {
    await page.evaluate(() => (document.getElementById('details').open = false));
    await sample(page, 'random 24');
    await press(page, 'n');
  },
  drawing: async (page) => {
    await press(page, 'Escape');
    await press(page, 'd');
    await drag(page, [0.4, 0.4], [0.6, 0.6]);
  },
  drawn: async (page) => {
    await page.mouse.up();
    await state(page, 'done');
    await measured(page);
    await press(page, 'Escape');
  },
  'worst-case': async (page) => {
    await sample(page, 'strips 200');
    await press(page, 'ArrowRight');
    await page.waitForFunction(() => document.body.dataset.measured === '1');
  },
  webgpu: async (page) => {
    await sample(page, 'models/terrain.obj');
    await chooseEngine(page, 'webgpu');
    await page.waitForSelector('dd[data-fact=Adapter]', { state: 'attached' });
    await measured(page);
  },
  loading: async (page) => {
    await chooseEngine(page, 'auto');
    await measured(page);
    await page.evaluate(() => (document.getElementById('details').open = false));
    await page.evaluate(() => document.querySelector('[data-spec="uvsphere 600"]').click());
    await page.waitForSelector('#busy:not([hidden])');
  },
  large: async (page) => {
    await named(page, 'uvsphere 600');
    await measured(page);
  },
  twisting: (page) => moving(page, 'sheet'),
  waving: (page) => moving(page, 'waves'),
  relaxing: (page) => moving(page, 'relax'),
  error: async (page) => {
    const buffer = Buffer.from('OFF\n3 1 0\n0 0 0\n1 0 0\n0 x 0\n3 0 1 2\n');
    await page.setInputFiles('#file', { name: 'broken.off', mimeType: 'text/plain', buffer });
    await page.waitForSelector('#error:not([hidden])');
  },
};

/** The first sample in the middle of its run, light and wide. */
async function takePicture(browser, address) {
  const page = await browser.newPage({ colorScheme: 'light', viewport: { width: 1440, height: 900 } });
  await page.goto(`${address}#watch`);
  await measured(page);
  await press(page, 'ArrowRight');
  await page.waitForFunction(() => document.body.dataset.measured === '1');
  await press(page, 'n');
  await page.waitForTimeout(300); // until it is drawn
  await page.screenshot({ path: picture });
  console.log(picture);
}

/** Each state in each look. */
async function takeAll(browser, address) {
  mkdirSync(folder, { recursive: true });
  for (const { look, ...options } of looks) {
    const context = await browser.newContext({ ...options, serviceWorkers: 'block' });
    const page = await context.newPage();
    const shoot = async (name) => {
      await page.waitForTimeout(300); // until it is drawn
      await page.screenshot({ path: `${folder}/${look}-${name}.png` });
    };
    await page.goto(address);
    await page.waitForSelector('#live:not([hidden])');
    await shoot('first');
    for (const section of ['explain', 'engines', 'paper', 'package']) {
      await page.goto(`${address}#${section}`);
      await page.waitForTimeout(1500); // until its figures are there
      await shoot(section);
    }
    await page.goto(`${address}#watch`);
    for (const [name, reach] of Object.entries(states)) {
      await reach(page);
      await shoot(name);
    }
    // Without the WebAssembly modules, the page has no mesh to show.
    await context.route('**/*.wasm', (route) => route.abort());
    await page.reload();
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
