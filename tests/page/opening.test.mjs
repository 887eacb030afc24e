// The demo page in Chromium while it opens a mesh: what is chosen meanwhile, files that change or go, folders.

import assert from 'node:assert/strict';
import { mkdirSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { after, before, test } from 'node:test';
import { startChromium } from '../browsers.mjs';
import { folder, openEdgeflip, tidyUp } from './page.mjs';

let browser;
before(async () => (browser = await startChromium()));
after(tidyUp);

const BROKEN = 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 one 0\n3 0 1 2\n';

/** Writes a file, and the folders that it is in. */
function file(name, text) {
  const path = join(folder, name);
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(path, text);
  return path;
}

async function choose(page, ...paths) {
  await (await page.page.$('#file')).setInputFiles(paths);
}

test('the name of a file is shown as it is', async () => {
  const page = await openEdgeflip(browser);
  for (const name of ['a.txt', 'äpfel.off', 'ßeta.off', 'Upper.off']) {
    await choose(page, file(name, BROKEN));
    const { error } = await page.until('a message', (seen) => seen.error !== '' && seen.state !== 'busy');
    assert.ok(error.trim().startsWith(name), error);
    await page.page.click('#dismiss');
  }
  await page.close();
});
