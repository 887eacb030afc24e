// Tests "Copy the code": what it copies runs as it stands in Node, and gives the triangles that are shown.

import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { readMesh, writeMesh } from 'edgeflip/files';
import { riggedGlb } from '../package/gltf.mjs';
import { file, fingerprintOf, meshFile, sharedPage } from './page.mjs';

/** In the repository, so that Node finds the package by its name. */
const folder = fileURLToPath(new URL('../../target/copied/', import.meta.url));
mkdirSync(folder, { recursive: true });
after(() => rmSync(folder, { recursive: true }));

let copies = 0;

/** Copies the code, and runs it beside the given files. Returns it, and the fingerprint of its result. */
async function runCopied({ page }, ...files) {
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.click('#take');
  await page.click('#code');
  await page.waitForFunction(() => document.getElementById('away-says').textContent.startsWith('Code copied.'));
  await page.keyboard.press('Escape');
  const code = await page.evaluate(() => navigator.clipboard.readText());
  const path = join(folder, `${++copies}.mjs`);
  writeFileSync(path, `${code}\nexport { indices };\n`);
  const { fetch } = globalThis;
  // Node has no folder of the page.
  globalThis.fetch = async (url) => {
    const found = files.find((each) => basename(each) === decodeURIComponent(url));
    return found ? new Response(readFileSync(found)) : fetch(url);
  };
  try {
    const { indices } = await import(pathToFileURL(path));
    return { code, fingerprint: fingerprintOf(Uint32Array.from(indices)) };
  } finally {
    globalThis.fetch = fetch;
  }
}

test('the code that is copied runs for a mesh in the plane: at the input, after an iteration, and at the end', async () => {
  const page = await sharedPage('random 24');
  const input = await runCopied(page);
  assert.doesNotMatch(input.code, /maxIterations/);
  await page.page.evaluate(() => document.activeElement.blur());
  await page.page.keyboard.press('ArrowRight');
  const one = await page.until('an iteration', ({ at, measured }) => at === '1' && measured === '1');
  const after = await runCopied(page);
  assert.match(after.code, /maxIterations: 1 /);
  assert.equal(after.fingerprint, one.facts.Fingerprint);
  const end = await page.playToEnd();
  assert.equal(input.fingerprint, end.facts.Fingerprint);
  assert.equal((await runCopied(page)).fingerprint, end.facts.Fingerprint);
  await page.close();
});

test('the code that is copied runs for samples in space, with the limits that are set', async () => {
  const page = await sharedPage('models/bunny.ply');
  const enter = async (id, text) => {
    await page.showLimits();
    await page.page.fill(`#${id}`, text);
    await page.page.press(`#${id}`, 'Tab');
    await page.until('a new run', ({ at, state }) => at === '0' && state === 'ready');
    await page.page.evaluate(() => document.getElementById('limits').hidePopover());
  };
  const plain = (await page.playToEnd()).facts.Fingerprint;
  assert.equal((await runCopied(page)).fingerprint, plain);
  await enter('deviation', '0.02');
  await enter('feature', '12');
  const limited = (await page.playToEnd()).facts.Fingerprint;
  assert.notEqual(limited, plain);
  const { code, fingerprint } = await runCopied(page);
  assert.match(code, /maxNormalAngle: 30, maxDeviation: 0\.02, lockedEdges/);
  assert.equal(fingerprint, limited);
  await enter('deviation', '');
  await enter('feature', '');

  // With materials, whose borders are kept.
  await page.choose('sample', 'models/flange.obj');
  await page.until('the flange', ({ caption, state }) => caption === 'flange.obj' && state !== 'busy');
  const flange = await page.playToEnd();
  assert.equal((await runCopied(page)).fingerprint, flange.facts.Fingerprint);

  // From above.
  await page.choose('sample', 'models/terrain.obj');
  await page.until('the terrain', ({ caption, state }) => caption === 'terrain.obj' && state !== 'busy');
  const terrain = await page.playToEnd();
  assert.equal((await runCopied(page)).fingerprint, terrain.facts.Fingerprint);
  await page.close();
});

test('the code that is copied runs beside the visitor’s files, and after a scramble beside the saved mesh', async () => {
  const page = await sharedPage();
  const own = await meshFile('roof 16', "it's #1.ply");
  await page.open(own);
  const end = await page.playToEnd();
  assert.equal((await runCopied(page, own)).fingerprint, end.facts.Fingerprint);

  const original = { bytes: riggedGlb().bytes, name: 'rigged.glb' };
  const mesh = await readMesh(original.bytes, original.name);
  const json = JSON.parse(Buffer.from(await writeMesh(mesh, 'rigged.gltf', { original })).toString());
  const [, base64] = json.buffers[0].uri.split(',');
  json.buffers[0].uri = 'a%20b.bin';
  const parts = [file('rigged.gltf', JSON.stringify(json)), file('a b.bin', Buffer.from(base64, 'base64'))];
  await page.open(parts);
  const rigged = await page.playToEnd();
  assert.equal((await runCopied(page, ...parts)).fingerprint, rigged.facts.Fingerprint);

  const rows = Array.from({ length: 60 }, (_, i) => [(i * 7) % 23, (i * i) % 31, (i * 5) % 7].join());
  const points = file('points.csv', rows.join('\n'));
  await page.open(points);
  const ofPoints = await page.playToEnd();
  assert.equal((await runCopied(page, points)).fingerprint, ofPoints.facts.Fingerprint);

  await page.choose('sample', 'regular 16');
  const before = await page.until(
    'the lattice',
    ({ caption, measured }) => caption === 'regular 16' && measured === '0',
  );
  await page.page.click('#scramble');
  await page.until('other triangles', ({ facts, state, measured }) => {
    return state === 'ready' && measured === '0' && facts.Fingerprint !== before.facts.Fingerprint;
  });
  const { name, bytes } = await page.download();
  const healed = await page.playToEnd();
  assert.equal((await runCopied(page, file(name, bytes))).fingerprint, healed.facts.Fingerprint);
  await page.close();
});
