// Tests the demo page in Chromium: opens, plays, scrubs and downloads mesh files on every engine, bit for bit as in
// Node.

import assert from 'node:assert/strict';
import { truncateSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { makeDelaunay } from '../../dist/index.js';
import { readMesh, writeMesh } from '../../dist/files.js';
import { full } from '../full.mjs';
import { riggedGlb } from '../package/gltf.mjs';
import { assertPlays, assertSameMesh, expected, file, folder, meshFile, sharedPage } from './page.mjs';

const sources = [
  { how: 'chosen', name: 'sphere.ply.gz', spec: 'uvsphere 28 0.1', load: (page, path) => page.open(path) },
  { how: 'dropped', name: 'plane.off', spec: 'random 24', load: (page, path, name) => page.drop(path, name) },
];
const engines = [
  { backend: 'webgpu', engine: 'WebGPU' },
  { backend: 'webgl2', engine: 'WebGL2, in a worker' },
  { backend: 'cpu', engine: 'CPU, in a worker' },
];

for (const { how, name, spec, load } of sources) {
  // In the short run, WebGL2 plays the one and WebGPU the other.
  for (const { backend, engine } of engines.filter(
    ({ backend }) => full || backend === (how === 'chosen' ? 'webgl2' : 'webgpu'),
  )) {
    test(`a file that is ${how} plays on ${backend}, goes back to its own triangles and forward again, bit for bit as in Node`, async () => {
      const path = await meshFile(spec, name);
      const want = await expected(path);
      const { mesh, indices, rows, facts, fingerprints } = want;
      assert.ok(rows.length >= 3, 'the mesh has something to show');
      const page = await sharedPage();
      const opened = await load(page, path, name);
      assert.equal(opened.caption, name);
      await page.chooseEngine(backend);

      const input = await page.look();
      assert.equal(input.facts.Fingerprint, fingerprints[0]);
      assert.equal(input.facts.Engine, engine);
      const inputPicture = await assertPlays(page, want, engine);
      assertSameMesh(await page.download(), { ...mesh, indices }, 'of the downloaded result');

      const back = await page.scrub('Home');
      assert.deepEqual([back.at, back.facts.Fingerprint], ['0', fingerprints[0]]);
      const downloaded = await page.download();
      assert.match(downloaded.name, new RegExp(`-after-0\\${name.slice(name.indexOf('.'))}$`));
      assertSameMesh(downloaded, mesh, 'of the downloaded input');
      assert.equal((await page.picture()).differsFrom(inputPicture), 0, 'the input looks as before');

      const again = await page.scrub('End');
      assert.deepEqual([again.at, again.facts.Fingerprint], [`${rows.length}`, facts.Fingerprint]);
      await page.close();
    });
  }
}

test('the page shows the progress of reading a file, and does not read a file that is too large', async () => {
  const page = await sharedPage();
  await page.page.evaluate(() => {
    window.seen = [];
    const look = () =>
      window.seen.push([document.querySelector('#busy-text').textContent, document.querySelector('#progress').value]);
    window.observer = new MutationObserver(look);
    window.observer.observe(document.querySelector('#busy'), {
      subtree: true,
      childList: true,
      attributes: true,
    });
  });
  await page.open(await meshFile('random 400', 'large.off'));
  const seen = await page.page.evaluate(() => {
    window.observer.disconnect();
    return window.seen;
  });
  const shares = seen.filter(([text]) => text === 'Reading large.off…').map(([, share]) => share);
  assert.ok(
    shares.some((share) => share > 0 && share < 1),
    JSON.stringify(seen),
  );
  assert.ok(seen.some(([text]) => text === 'Parsing large.off…'));

  const path = file('huge.off', '');
  truncateSync(path, 2 ** 30 + 1);
  await (await page.page.$('#file')).setInputFiles(path);
  await page.page
    .locator('#error-text')
    .getByText('huge.off has 1073741825 bytes, more than the 1073741824 that a page can take')
    .waitFor();
  assert.equal((await page.look()).caption, 'large.off');
  await page.close();
});

test('a glTF file with its buffer in another file plays, and its download differs only in the indices', async () => {
  const original = { bytes: riggedGlb().bytes, name: 'rigged.glb' };
  const mesh = await readMesh(original.bytes, original.name);
  const json = JSON.parse(Buffer.from(await writeMesh(mesh, 'rigged.gltf', { original })).toString());
  const [, base64] = json.buffers[0].uri.split(',');
  json.buffers[0].uri = 'a%20b.bin';
  file('rigged.gltf', JSON.stringify(json));
  file('a b.bin', Buffer.from(base64, 'base64'));
  const page = await sharedPage();
  const alone = page.page.locator('#error-text');
  await (await page.page.$('#file')).setInputFiles(join(folder, 'rigged.gltf'));
  await alone.getByText('it is in the file `a b.bin`').waitFor();
  const opened = await page.open([join(folder, 'a b.bin'), join(folder, 'rigged.gltf')]);
  assert.equal(opened.caption, 'rigged.gltf');
  await page.chooseEngine('cpu');
  const end = await page.playToEnd();
  assert.equal(end.facts['Not Delaunay'], 'none');
  const { indices } = await makeDelaunay(mesh, { backend: 'cpu' });
  const downloaded = await page.download();
  assert.match(downloaded.name, /^rigged-after-\d+\.gltf$/);
  assertSameMesh(downloaded, { ...mesh, indices }, 'of the downloaded result');
  const written = JSON.parse(downloaded.bytes.toString());
  assert.match(written.buffers[0].uri, /^data:/);
  assert.deepEqual({ ...written, buffers: json.buffers }, json);
  await page.close();
});

test('triangles that are turned over or flat are in the numbers, and the sentence names those turned over', async () => {
  // A square whose middle vertex lies below its lower side, a quad whose edge flips, and three points on a line
  const points = ['0 0', '4 0', '4 4', '0 4', '2 -1', '10 0', '10.9 0.2', '11 1', '10 1', '20 0', '21 0', '22 0'];
  const triangles = ['0 1 4', '1 2 4', '2 3 4', '3 0 4', '5 6 7', '5 7 8', '9 10 11'];
  const lines = [...points.map((point) => `${point} 0`), ...triangles.map((triangle) => `3 ${triangle}`)];
  const page = await sharedPage();
  await page.open(file('dragged.off', `OFF\n${points.length} ${triangles.length} 0\n${lines.join('\n')}\n`));
  const { facts } = await page.playToEnd();
  assert.deepEqual([facts.Flips, facts['Turned over'], facts['Flat triangles']], ['2', '1 triangle', '1 → 1']);
  assert.match(await page.page.$eval('#status', ({ textContent }) => textContent), / 1 triangle is turned over\.$/);
  await page.scrub('Home');
  await page.close();
  const whole = await sharedPage();
  const { facts: others } = await whole.playToEnd();
  assert.deepEqual([others['Turned over'], others['Flat triangles']], [undefined, undefined]);
  await whole.close();
});
