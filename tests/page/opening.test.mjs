// Tests the demo page in Chromium while it opens a mesh: choices meanwhile, files that change or vanish, folders.

import assert from 'node:assert/strict';
import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { before, test } from 'node:test';
import { makeDelaunay } from '../../dist/index.js';
import { readMesh, writeMesh } from '../../dist/files.js';
import { riggedGlb } from '../package/gltf.mjs';
import { startChromium } from '../browsers.mjs';
import {
  assertSameMesh,
  expected,
  file,
  folder,
  loseDevice,
  meshFile,
  openEdgeflip,
  pageForBeta,
  sharedPage,
} from './page.mjs';

let sphere;
let roof;
before(async () => {
  sphere = await meshFile('uvsphere 28 0.1', 'sphere.off');
  roof = await meshFile('roof 16', 'roof.ply');
});

const BROKEN = 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 one 0\n3 0 1 2\n';

async function choose(page, ...paths) {
  await (await page.page.$('#file')).setInputFiles(paths);
}

/** Waits until this number of messages is held back. */
async function held(page, method, ask, count = 1) {
  await page.page.evaluate((name) => window.hold(name), method);
  await ask();
  await page.page.waitForFunction((many) => window.waiting() >= many, count);
  assert.equal((await page.look()).state, 'busy');
}

const letGo = (page) => page.page.evaluate(() => window.letGo());

const setBeta = (page, text) => page.setBeta(text);

const betaOf = (page) => page.page.inputValue('#beta');

/** The steps of opening a mesh: `read` reads its file, `open` prepares its run. */
for (const [method, when] of [
  ['read', 'a file is read'],
  ['open', 'its run is prepared'],
]) {
  test(`an engine and β that are chosen while ${when} take effect`, async () => {
    const page = await pageForBeta();
    await page.open(roof);
    await held(page, method, () => choose(page, sphere));
    for (const engine of ['webgl2', 'auto', 'cpu']) await page.choose('backend', engine);
    await setBeta(page, '45');
    assert.equal((await page.look()).state, 'busy');
    await letGo(page);
    const opened = await page.rest();
    assert.deepEqual(
      [opened.caption, opened.error, opened.backend, await betaOf(page)],
      ['sphere.off', '', 'cpu', '45'],
    );
    assert.deepEqual([opened.facts.Engine, opened.facts['Crease limit β']], ['CPU, in a worker', '45°']);
    const mesh = (await expected(sphere)).mesh;
    const { indices } = await makeDelaunay(mesh, { backend: 'cpu', maxNormalAngle: 45 });
    await page.playToEnd();
    assertSameMesh(await page.download(), { ...mesh, indices }, 'of the result');
    await page.close();
  });

  test(`cancelling while ${when} also discards the choices made meanwhile`, async () => {
    const page = await pageForBeta();
    await page.open(roof);
    await page.chooseEngine('cpu');
    const opened = await page.rest();
    await held(page, method, () => choose(page, sphere));
    await page.choose('backend', 'webgl2');
    await setBeta(page, '45');
    await page.page.click('#cancel');
    await letGo(page);
    const after = await page.rest();
    assert.deepEqual([after.caption, after.error, after.backend, await betaOf(page)], ['roof.ply', '', 'cpu', '10']);
    assert.deepEqual(after.facts, opened.facts);
    await page.close();
  });
}

test('after a broken file, the previous mesh stays with its settings', async () => {
  const page = await pageForBeta();
  const opened = await page.open(roof);
  await held(page, 'read', () => choose(page, file('broken.off', BROKEN)));
  await page.choose('backend', 'cpu');
  await setBeta(page, '45');
  await letGo(page);
  const after = await page.until('a message', ({ error, state }) => error !== '' && state !== 'busy');
  assert.match(after.error, /^\s*broken\.off: line 5: /);
  assert.deepEqual([after.caption, after.backend, await betaOf(page)], ['roof.ply', opened.backend, '10']);
  assert.deepEqual((await page.rest()).facts, opened.facts);
  await page.close();
});

test('a β that is not an angle is refused while a file is read, and the file opens', async () => {
  const page = await pageForBeta();
  await held(page, 'read', () => choose(page, sphere));
  await setBeta(page, '181');
  assert.match((await page.look()).error, /β is an angle from 0 to 180/);
  await letGo(page);
  const { caption, facts } = await page.rest();
  assert.deepEqual([caption, facts['Crease limit β'], await betaOf(page)], ['sphere.off', '10°', '10']);
  await page.close();
});

test('of several meshes chosen while others are read, the last opens, and no worker is left', async () => {
  const page = await sharedPage();
  const workers = page.page.workers().length;
  const wanted = [
    ['roof.ply', () => choose(page, roof)],
    ['random 24', () => page.choose('sample', 'random 24')],
    ['sphere.off', () => page.dropPaths([sphere])],
  ];
  for (let last = 0; last < wanted.length; last++) {
    const order = [...wanted.slice(last + 1), ...wanted.slice(0, last + 1)];
    await page.page.evaluate(() => window.hold('generate'));
    await held(
      page,
      'read',
      async () => {
        for (const [, ask] of order) await ask();
      },
      order.length,
    );
    await page.choose('backend', 'cpu');
    await letGo(page);
    const { caption, error, facts } = await page.rest();
    assert.deepEqual([caption, error, facts.Engine], [wanted[last][0], '', 'CPU, in a worker']);
    const marked = await page.page.evaluate(() => document.querySelector('#gallery [aria-pressed=true]')?.dataset.spec);
    assert.equal(marked, caption === 'random 24' ? caption : undefined);
  }
  // A worker ends a moment after it was told to.
  for (let i = 0; i < 100 && page.page.workers().length > workers; i++) await page.page.waitForTimeout(50);
  assert.equal(page.page.workers().length, workers);
  await page.close();
});

test('a file that is chosen before the GPU is open replaces the sample', async () => {
  const page = await openEdgeflip(await startChromium(), () => {
    const { requestAdapter } = GPU.prototype;
    const isChosen = new Promise((resolve) => {
      addEventListener('DOMContentLoaded', () => {
        const files = new DataTransfer();
        files.items.add(new File(['OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n'], 'early.off'));
        const input = document.getElementById('file');
        input.files = files.files;
        input.dispatchEvent(new Event('change'));
        resolve();
      });
    });
    GPU.prototype.requestAdapter = async function (...args) {
      await isChosen;
      return requestAdapter.apply(this, args);
    };
  });
  const { caption, error, note } = await page.rest();
  assert.deepEqual([caption, error], ['early.off', '']);
  assert.match(note, /On the CPU: no hardware GPU found/);
  await page.close();
});

test('after a GPU is lost while a file is read, the file opens', async () => {
  const page = await sharedPage();
  // SwiftShader takes long to compile the kernels for surfaces.
  const strips = await meshFile('strips 16', 'strips.off');
  await page.open(strips);
  await page.chooseEngine('webgpu');
  await held(page, 'read', async () => choose(page, await meshFile('strips 16', 'meanwhile.off')));
  const devices = await loseDevice(page);
  await page.page.locator('#busy-text').getByText('The GPU was lost').waitFor();
  await page.page.waitForFunction((many) => window.devices.length === many, devices + 1);
  await letGo(page);
  const { caption, error, facts } = await page.rest();
  assert.deepEqual([caption, facts.Engine], ['meanwhile.off', 'WebGPU']);
  assert.match(error, /The GPU was lost \(.*\)\. The mesh was opened nevertheless\./);
  const end = await page.playToEnd();
  assert.equal(end.facts.Fingerprint, (await expected(strips)).facts.Fingerprint);
  await page.close();
});

for (const [how, load] of [
  ['chosen', (page, paths) => choose(page, ...paths)],
  ['dropped', (page, paths) => page.dropPaths(paths)],
]) {
  test(`a file that was ${how} and has changed or vanished since is downloaded as it was read`, async () => {
    const { mesh, indices } = await expected(sphere);
    const path = await meshFile('uvsphere 28 0.1', `${how}.off`);
    const page = await sharedPage();
    await load(page, [path]);
    await page.until('the file', ({ caption }) => caption === `${how}.off`);
    await page.rest();
    await page.playToEnd();
    writeFileSync(path, BROKEN);
    assertSameMesh(await page.download(), { ...mesh, indices }, 'after the file has changed');
    rmSync(path);
    const end = await page.rest();
    assertSameMesh(await page.download(), { ...mesh, indices }, 'after the file has gone');
    assert.equal(end.error, '');
    await page.close();
  });

  test(`the error of a file that was ${how} and cannot be read names it and says what to do; the previous mesh stays`, async () => {
    const path = file(`gone-${how}.off`, BROKEN);
    const page = await sharedPage();
    const opened = await page.open(roof);
    await held(page, 'read', () => load(page, [path]));
    rmSync(path);
    await letGo(page);
    const { error, caption } = await page.until('a message', (seen) => seen.error !== '' && seen.state !== 'busy');
    assert.match(error, new RegExp(`^\\s*gone-${how}\\.off could not be read: it was moved, .*Choose it again\\.`));
    assert.equal(caption, 'roof.ply');
    assert.deepEqual((await page.rest()).facts, opened.facts);
    await page.close();
  });
}

/** Writes a glTF file and the file of its buffer into the folder `name`. */
async function gltfFolder(name, uri, path) {
  const original = { bytes: riggedGlb().bytes, name: 'rigged.glb' };
  const mesh = await readMesh(original.bytes, original.name);
  const json = JSON.parse(Buffer.from(await writeMesh(mesh, 'rigged.gltf', { original })).toString());
  const [, base64] = json.buffers[0].uri.split(',');
  json.buffers[0].uri = uri;
  file(`${name}/rigged.gltf`, JSON.stringify(json));
  file(`${name}/${path}`, Buffer.from(base64, 'base64'));
  return mesh;
}

test('a glTF file with its buffer in a folder below plays, and can be downloaded after the folder has vanished', async () => {
  const page = await sharedPage();
  for (const [name, uri, path] of [
    ['scene', 'data/a%20b.bin', 'data/a b.bin'],
    ['dots', './a.bin', 'a.bin'],
    ['above/below', 'deep/er/a.bin', 'deep/er/a.bin'],
  ]) {
    const mesh = await gltfFolder(name, uri, path);
    // It is not read, because it is not a buffer.
    file(`${name}/data/large.png`, 'no picture');
    await page.dropPaths([join(folder, name.split('/')[0])]);
    await page.until(
      `the mesh of ${name}`,
      ({ error, state, measured, note }) =>
        (state === 'ready' && measured === '0' && !/other/.test(note)) || error !== '',
    );
    const opened = await page.rest();
    assert.deepEqual([opened.caption, opened.error], ['rigged.gltf', '']);
    await page.chooseEngine('cpu');
    await page.playToEnd();
    const { indices } = await makeDelaunay(mesh, { backend: 'cpu' });
    rmSync(join(folder, name), { recursive: true });
    assertSameMesh(await page.download(), { ...mesh, indices }, `of ${name}`);
    await page.choose('sample', 'random 24');
    await page.until('a sample', ({ caption }) => caption === 'random 24');
    await page.rest();
  }
  await page.close();
});

test('of many meshes the first opens, and the page says how many others were not opened', async () => {
  const bytes = await writeMesh(await readMesh(Buffer.from(BROKEN.replace('one', '1')), 'a.off'), 'a.off');
  const paths = Array.from({ length: 50 }, (_, i) => file(`many/mesh ${i + 1}.off`, bytes));
  file('many/a/first.off', bytes);
  file('many/._mesh 1.off', 'of macOS');
  file('many/notes.txt', 'no mesh');
  const page = await sharedPage();
  for (const [ask, name, note] of [
    [() => choose(page, ...paths), 'mesh 1.off', '49 other mesh files were not opened.'],
    [() => page.dropPaths(paths.slice(3, 5)), 'mesh 4.off', '1 other mesh file was not opened.'],
    [() => page.dropPaths([join(folder, 'many')]), 'mesh 1.off', '50 other mesh files were not opened.'],
    [() => page.dropPaths([paths[6], join(folder, 'many/a')]), 'mesh 7.off', '1 other mesh file was not opened.'],
    [() => page.dropPaths([join(folder, 'many/a'), join(folder, 'many/notes.txt')]), 'first.off', ''],
  ]) {
    await page.choose('sample', 'random 24');
    await page.until('a sample', ({ caption }) => caption === 'random 24');
    await page.rest();
    await ask();
    await page.until(name, ({ caption }) => caption === name);
    const seen = await page.rest();
    assert.equal(seen.error, '');
    if (note) assert.ok(seen.note.includes(note), seen.note);
    else assert.doesNotMatch(seen.note, /not opened/);
  }
  // The buffer of a glTF file does not count as a mesh, whatever its name.
  const mesh = await gltfFolder('odd', 'the%20buffer.off', 'the buffer.off');
  await page.dropPaths([join(folder, 'odd')]);
  await page.until('the glTF file', ({ caption }) => caption === 'rigged.gltf');
  const odd = await page.rest();
  assert.equal(odd.facts.Triangles, `${mesh.indices.length / 3}`);
  assert.doesNotMatch(odd.note, /not opened/);
  await page.close();
});

test('the page says that a folder has no mesh', async () => {
  const page = await sharedPage();
  const opened = await page.open(roof);
  mkdirSync(join(folder, 'empty'));
  file('texts/a.txt', 'no mesh');
  for (const [names, message] of [
    [['empty'], /^\s*empty is a folder without a mesh file\. .*\.off, \.obj/],
    [['texts'], /^\s*texts is a folder without a mesh file\./],
    [['empty', 'texts'], /^\s*empty and texts are folders without a mesh file\./],
  ]) {
    await page.dropPaths(names.map((name) => join(folder, name)));
    const { error, caption } = await page.until('a message', (seen) => seen.error !== '' && seen.state !== 'busy');
    assert.match(error, message);
    assert.equal(caption, 'roof.ply');
    assert.deepEqual((await page.rest()).facts, opened.facts);
    await page.page.click('#dismiss');
  }
  await page.close();
});

test('the name of a file is shown unchanged', async () => {
  const page = await sharedPage();
  for (const name of ['a.txt', 'äpfel.off', 'ßeta.off', 'Upper.off']) {
    await choose(page, file(name, BROKEN));
    const { error } = await page.until('a message', (seen) => seen.error !== '' && seen.state !== 'busy');
    assert.ok(error.trim().startsWith(name), error);
    await page.page.click('#dismiss');
  }
  await page.close();
});

test('the memory of workers is freed when other meshes are opened', async () => {
  const page = await openEdgeflip(await startChromium(), () => {
    window.workers = [];
    window.Worker = class extends Worker {
      constructor(...args) {
        super(...args);
        window.workers.push(new WeakRef(this));
      }
    };
  });
  for (const path of [sphere, roof, sphere, roof]) await page.open(path);
  await page.download();
  const session = await page.page.context().newCDPSession(page.page);
  const counts = async () => {
    await session.send('HeapProfiler.collectGarbage');
    return page.page.evaluate(() => [window.workers.length, window.workers.filter((worker) => worker.deref()).length]);
  };
  // The worker that measures, and the worker of the run.
  const end = performance.now() + 30_000;
  let [made, kept] = await counts();
  while (kept > 2 && performance.now() < end) [made, kept] = await counts();
  assert.ok(made > 10 && kept <= 2, `${kept} of ${made} workers are held`);
  await page.close();
});
