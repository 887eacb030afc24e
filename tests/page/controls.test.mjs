// Tests the controls and the errors of the demo page in Chromium: cancelling, broken input, no GPU, a lost GPU, keys.

import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { generate, writeMesh } from 'edgeflip/files';
import { startChromium } from '../browsers.mjs';
import { full } from '../full.mjs';
import { expected, file, loseDevice, meshFile, openEdgeflip, pageForBeta, sharedPage } from './page.mjs';

/** Long enough to lose a GPU during its run. */
const STRIPS = full ? 'strips 40' : 'strips 20';

let small;
before(async () => (small = await meshFile('strips 16', 'small.off')));

/** Opens a file that is refused, and returns the texts of the page. */
async function openRefused(page, path) {
  await (await page.page.$('#file')).setInputFiles(path);
  await page.until('a message', ({ error }) => error !== '');
  return page.rest();
}

/** Plays to the end on the chosen engine, and compares each iteration with Node. */
async function playAndCompare(page, path) {
  const { rows, facts, fingerprints } = await expected(path);
  const end = await page.playToEnd();
  assert.deepEqual(
    end.rows.map((row) => row.slice(0, 4)),
    rows,
  );
  assert.equal(end.facts.Fingerprint, facts.Fingerprint);
  let seen = await page.scrub('Home');
  assert.equal(seen.facts.Fingerprint, fingerprints[0]);
  for (const fingerprint of fingerprints.slice(1, 5)) {
    seen = await page.scrub('ArrowRight');
    assert.equal(seen.facts.Fingerprint, fingerprint, `after iteration ${seen.at}`);
  }
}

test('opening can be cancelled: the previous mesh stays, and plays', async () => {
  const page = await sharedPage();
  const opened = await page.open(small);
  await page.chooseEngine('cpu');
  await page.choose('sample', 'random 500');
  await page.until('a mesh being opened', ({ state }) => state === 'busy');
  // The message appears slowly, and the mesh may be there before it stands still.
  await page.page.evaluate(() => document.getElementById('cancel').click());
  const after = await page.rest();
  assert.deepEqual([after.caption, after.error], ['small.off', '']);
  assert.equal(after.facts.Fingerprint, opened.facts.Fingerprint);
  await playAndCompare(page, small);
  await page.close();
});

test('a mesh that is chosen while another is being opened replaces it', async () => {
  const page = await sharedPage();
  await page.choose('sample', 'random 500');
  await page.until('a mesh being opened', ({ state }) => state === 'busy');
  const seen = await page.open(small);
  assert.deepEqual([seen.caption, seen.error], ['small.off', '']);
  await playAndCompare(page, small);
  await page.close();
});

test('a run on the CPU pauses at its iteration, and continues', async () => {
  const page = await sharedPage();
  const path = await meshFile(full ? 'strips 80' : 'strips 40', 'long.off');
  const { rows, fingerprints, facts } = await expected(path);
  await page.open(path);
  await page.chooseEngine('cpu');
  await page.choose('speed', '50');
  await page.page.click('#play');
  await page.until('a few iterations', ({ state, at }) => state === 'playing' && Number(at) > 3);
  await page.page.click('#play');
  const paused = await page.rest();
  assert.ok(Number(paused.at) < rows.length && paused.state === 'ready', `${paused.state} at ${paused.at}`);
  assert.equal(paused.facts.Fingerprint, fingerprints[paused.at]);
  assert.match(paused.facts['Not Delaunay'], /can flip/);
  const end = await page.playToEnd();
  assert.deepEqual([end.at, end.facts.Fingerprint], [`${rows.length}`, facts.Fingerprint]);
  await page.close();
});

test('the error of a broken file names the line, and the previous mesh stays', async () => {
  const page = await sharedPage();
  const opened = await page.open(small);
  for (const [name, text, message] of [
    ['broken.off', 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 one 0\n3 0 1 2\n', /^\s*broken\.off: line 5: /],
    ['broken.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n', /^\s*broken\.obj: line 4: /],
    ['mesh.ply', 'ply\n', /^\s*mesh\.ply: line 1: .* end_header/],
    ['mesh.txt', 'a text\n', /use one of: \.off/],
    ['empty.off', 'OFF\n0 0 0\n', /There are no triangles in empty\.off/],
  ]) {
    const seen = await openRefused(page, file(name, text));
    assert.match(seen.error, message);
    assert.deepEqual([seen.caption, seen.state, seen.facts], ['small.off', 'ready', opened.facts]);
    await page.page.click('#dismiss');
    assert.equal((await page.look()).error, '');
  }
  await playAndCompare(page, small);
  await page.close();
});

test('a file whose name says another kind than it is: the message says what it seems to be, and what to do', async () => {
  const page = await sharedPage();
  const mesh = await generate('roof 4');
  const [glb, ply, stl, obj, off] = await Promise.all(
    ['a.glb', 'a.ply', 'a.stl', 'a.obj', 'a.off'].map((name) => writeMesh(mesh, name)),
  );
  const zeros = new Uint8Array(200);
  for (const [name, bytes, message] of [
    ['a.off', glb, /^\s*a\.off seems to be a glTF file\. Rename it to a\.glb, and open it again\./],
    ['b.obj', ply, /^\s*b\.obj seems to be a PLY file\. Rename it to b\.ply/],
    ['c.ply', stl, /^\s*c\.ply seems to be an STL file\. Rename it to c\.stl/],
    ['d.stl', obj, /^\s*d\.stl seems to be an OBJ file\. Rename it to d\.obj/],
    ['e.txt', off, /^\s*e\.txt seems to be an OFF file\. Rename it to e\.off/],
    ['f.off.gz', gzipSync(ply), /^\s*f\.off\.gz seems to be a PLY file\. Rename it to f\.ply\.gz/],
    [
      'g.obj',
      Uint8Array.of(0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10),
      /^\s*g\.obj seems to be a PNG image, and no mesh\./,
    ],
    [
      'h.glb',
      '<!doctype html><title>Not found</title>',
      /^\s*h\.glb seems to be a web page, and no mesh\. Open .*\.off/,
    ],
    ['i.ply', zeros, /^\s*i\.ply seems to be a binary file, and no mesh\./],
    // Of its kind, but broken.
    ['j.stl', stl.subarray(0, 300), /^\s*j\.stl: byte /],
  ]) {
    const { error } = await openRefused(page, file(name, bytes));
    assert.match(error, message);
    assert.doesNotMatch(error, /\\x/);
    await page.page.click('#dismiss');
  }
  await page.close();
});

test('a β that is not an angle is refused, and a valid β changes the result', async () => {
  const page = await pageForBeta();
  await page.open(await meshFile('uvsphere 28 0.1', 'sphere.off'));
  const setBeta = (text) => page.setBeta(text);
  for (const wrong of ['181', '-1', '']) {
    await setBeta(wrong);
    const { error } = await page.until('a message', ({ error, state }) => error !== '' && state !== 'busy');
    assert.match(error, /β is an angle from 0 to 180/);
    await page.page.click('#dismiss');
  }
  await setBeta('10');
  await page.rest();
  const ten = await page.playToEnd();
  await setBeta('180');
  await page.until('a new run', ({ at }) => at === '0');
  await page.rest();
  const all = await page.playToEnd();
  assert.notEqual(all.facts.Fingerprint, ten.facts.Fingerprint);
  assert.doesNotMatch(all.facts['Not Delaunay'], /crease/);
  await page.close();
});

test('a β that is being typed stays while the page works, and takes effect when it is entered', async () => {
  const page = await pageForBeta();
  await page.open(await meshFile('uvsphere 28 0.1', 'sphere.off'));
  await page.choose('speed', '1000');
  await page.page.click('#play');
  await page.showLimits();
  await page.page.focus('#beta');
  await page.page.keyboard.press('ControlOrMeta+A');
  await page.page.keyboard.type('4');
  const { newest } = await page.look();
  await page.until('another iteration', (seen) => Number(seen.newest) > Number(newest));
  await page.page.keyboard.type('5');
  await page.page.keyboard.press('Tab');
  await page.until('a new run', ({ at, state }) => at === '0' && state === 'ready');
  const { facts } = await page.rest();
  assert.equal(facts['Crease limit β'], '45°');
  await page.close();
});

test('an engine that is chosen while a run is being prepared is the engine of the run', async () => {
  const page = await sharedPage();
  await page.page.evaluate(() => {
    for (const backend of ['webgpu', 'cpu']) {
      const choice = document.getElementById('backend');
      choice.value = backend;
      choice.dispatchEvent(new Event('change'));
    }
  });
  const { backend, facts } = await page.rest();
  assert.deepEqual([backend, facts.Engine], ['cpu', 'CPU, in a worker']);
  await page.close();
});

test('without WebGPU the page says so, plays on the CPU and draws with WebGL2', async () => {
  const page = await openEdgeflip(await startChromium(), () => {
    delete Navigator.prototype.gpu;
    for (const name of Object.getOwnPropertyNames(window)) if (/^GPU[A-Z]/.test(name)) delete window[name];
    // The kind of the canvas.
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
      const context = getContext.call(this, kind, ...more);
      if (context && kind !== '2d') this.dataset.kind = kind;
      return context;
    };
  });
  const opened = await page.open(small);
  assert.equal(opened.facts.Engine, 'CPU, in a worker');
  assert.match(opened.note, /On the CPU: this browser has no WebGPU/);
  assert.equal(await page.page.evaluate(() => document.querySelector('#view canvas').dataset.kind), 'webgl2');
  const input = await page.picture();
  assert.ok(input.colours > 3, `${input.colours} colours of the input`);

  await page.choose('backend', 'webgpu');
  const refused = await page.until('a message', ({ error }) => error !== '');
  assert.match(refused.error, /The WebGPU engine is not available: this browser has no WebGPU/);
  await page.page.click('#dismiss');
  await page.choose('backend', 'auto');
  await page.rest();
  await playAndCompare(page, small);
  await page.scrub('End');
  const end = await page.picture();
  assert.ok(end.colours > 3, `${end.colours} colours of the result`);
  assert.ok(end.differsFrom(input) > 0.01, 'the result looks like the input');
  await page.close();
});

test('auto does not use a software GPU, and says why', async () => {
  const page = await sharedPage();
  const seen = await page.open(small);
  assert.deepEqual([seen.backend, seen.facts.Engine], ['auto', 'CPU, in a worker']);
  assert.match(seen.note, /On the CPU: no hardware GPU found/);
  await page.close();
});

test('a GPU that is lost during a run is replaced, and the result is the same', async () => {
  const page = await sharedPage();
  const path = await meshFile(STRIPS, 'strips.off');
  const { facts, rows } = await expected(path);
  await page.open(path);
  await page.chooseEngine('webgpu');
  await page.choose('speed', '50');
  await page.page.click('#play');
  await page.until('a few iterations', ({ state, at }) => state === 'playing' && Number(at) > 2);
  const devices = await loseDevice(page);
  const { error } = await page.until('a message', ({ error, state }) => error !== '' && state !== 'busy');
  assert.match(error, /The GPU was lost/);
  const recovered = await page.rest();
  assert.ok(Number(recovered.at) > 2, `at ${recovered.at}`);
  assert.equal(await page.page.evaluate(() => window.devices.length), devices + 1);
  const end = await page.playToEnd();
  assert.deepEqual(
    end.rows.map((row) => row.slice(0, 4)),
    rows,
  );
  assert.deepEqual([end.facts.Engine, end.facts.Fingerprint], ['WebGPU', facts.Fingerprint]);
  assert.ok((await page.picture()).colours > 3);
  assert.equal(await page.page.evaluate(() => document.querySelectorAll('#view canvas').length), 1);
  await page.close();
});

/** Runs in a worker before its own code: stores its WebGL2 contexts. */
function watchContexts() {
  self.contexts = [];
  const { getContext } = OffscreenCanvas.prototype;
  OffscreenCanvas.prototype.getContext = function (kind, options) {
    const context = getContext.call(this, kind, options);
    self.contexts.push(context);
    return context;
  };
}

/** Watches all workers that start later, until the returned function is called. */
async function watchWorkers({ page }) {
  const scripts = '**/mesh-worker-*.js';
  await page.route(scripts, async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, body: `(${watchContexts})();${await response.text()}` });
  });
  return () => page.unroute(scripts);
}

/** Plays a few iterations on WebGL2; then loses the context. */
async function loseContext(page) {
  await page.choose('speed', '50');
  await page.page.click('#play');
  await page.until('a few iterations', ({ state, at }) => state === 'playing' && Number(at) > 2);
  const lost = await Promise.all(
    page.page.workers().map((worker) =>
      worker.evaluate(() => {
        const context = self.contexts?.at(-1);
        context?.getExtension('WEBGL_lose_context').loseContext();
        return context?.isContextLost() ?? false;
      }),
    ),
  );
  assert.equal(lost.filter(Boolean).length, 1, 'contexts that are lost');
}

test('after a WebGL2 context is lost during a run, the CPU repeats the run, and the result is the same', async () => {
  const page = await sharedPage();
  const unwatch = await watchWorkers(page);
  const path = await meshFile(STRIPS, 'strips.off');
  const { facts, rows } = await expected(path);
  await page.open(path);
  await page.chooseEngine('webgl2');
  await loseContext(page);
  const { error } = await page.until('a message', ({ error, state }) => error !== '' && state !== 'busy');
  assert.match(error, /The GPU was lost \(.*the WebGL2 context was lost\)\. The run was repeated/);
  const recovered = await page.rest();
  assert.ok(Number(recovered.at) > 2 && Number(recovered.at) < rows.length, `at ${recovered.at}`);
  assert.deepEqual([recovered.backend, recovered.facts.Engine], ['cpu', 'CPU, in a worker']);
  const end = await page.playToEnd();
  assert.deepEqual(
    end.rows.map((row) => row.slice(0, 4)),
    rows,
  );
  assert.equal(end.facts.Fingerprint, facts.Fingerprint);
  await unwatch();
  await page.close();
});

test('without WebGPU, auto uses the CPU and says why', async () => {
  const page = await openEdgeflip(await startChromium(), () => delete Navigator.prototype.gpu);
  const path = await meshFile('random 110', 'random.off');
  const { facts, fingerprints, rows } = await expected(path);
  const opened = await page.open(path);
  assert.deepEqual([opened.backend, opened.facts.Engine], ['auto', 'CPU, in a worker']);
  assert.match(opened.note, /On the CPU: this browser has no WebGPU/);
  const end = await page.playToEnd();
  assert.deepEqual(
    end.rows.map((row) => row.slice(0, 4)),
    rows,
  );
  assert.equal(end.facts.Fingerprint, facts.Fingerprint);
  assert.equal((await page.scrub('Home')).facts.Fingerprint, fingerprints[0]);
  await page.close();
});

for (const backend of full ? ['webgpu', 'cpu'] : ['webgpu']) {
  test(`keys play, pause and step on ${backend}, also in fast succession`, async () => {
    const page = await sharedPage();
    const { fingerprints, rows } = await expected(small);
    await page.open(small);
    await page.chooseEngine(backend);
    await page.page.evaluate(() => document.activeElement.blur());
    await page.page.keyboard.press('ArrowRight');
    const first = await page.until('one iteration', ({ at, measured }) => at === '1' && measured === '1');
    assert.equal(first.facts.Fingerprint, fingerprints[1]);
    await page.page.keyboard.press('ArrowLeft');
    const back = await page.until('the input', ({ at, measured }) => at === '0' && measured === '0');
    assert.equal(back.facts.Fingerprint, fingerprints[0]);

    await page.page.evaluate(() => {
      for (let i = 0; i < 4; i++)
        document.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight', bubbles: true }));
    });
    const stepped = await page.until(
      'an iteration',
      ({ at, measured, newest }) => Number(at) >= 1 && measured === at && at === newest,
    );
    assert.equal(stepped.facts.Fingerprint, fingerprints[stepped.at]);

    await page.choose('speed', '50');
    await page.page.evaluate(() => document.activeElement.blur());
    await page.page.keyboard.press(' ');
    await page.until('it to play', ({ state }) => state === 'playing');
    await page.page.keyboard.press(' ');
    const paused = await page.rest();
    assert.equal(paused.state, 'ready');
    await page.page.keyboard.press(' ');
    const end = await page.until('the end', ({ state, measured, at }) => state === 'done' && measured === at);
    assert.deepEqual(
      end.rows.map((row) => row.slice(0, 4)),
      rows,
    );
    await page.scrub('Home');
    for (const fingerprint of fingerprints.slice(1)) {
      const seen = await page.scrub('ArrowRight');
      assert.equal(seen.facts.Fingerprint, fingerprint, `after iteration ${seen.at}`);
    }
    await page.close();
  });

  test(`a slider that is moved during play on ${backend} stays at its new position`, async () => {
    const page = await sharedPage();
    const path = await meshFile(backend === 'cpu' ? 'strips 40' : STRIPS, 'strips.off');
    const { fingerprints, facts } = await expected(path);
    await page.open(path);
    await page.chooseEngine(backend);
    await page.choose('speed', '0');
    await page.page.click('#play');
    await page.until('a few iterations', ({ state, at }) => state === 'playing' && Number(at) > 3);
    await page.page.evaluate(() => {
      const slider = document.getElementById('slider');
      slider.value = '2';
      slider.dispatchEvent(new Event('input', { bubbles: true }));
    });
    // The page keeps the iteration that was running, so look again after it.
    const seen = await page.rest();
    await page.page.waitForTimeout(500);
    const later = await page.rest();
    for (const { at, state, facts } of [seen, later]) {
      assert.deepEqual([at, state, facts.Fingerprint], ['2', 'ready', fingerprints[2]]);
    }
    const end = await page.playToEnd();
    assert.equal(end.facts.Fingerprint, facts.Fingerprint);
    await page.close();
  });
}

test('the page makes no request to other servers, and its policy forbids them', async () => {
  const page = await sharedPage();
  const refused = await page.page.evaluate(() => {
    const violation = new Promise((done) =>
      document.addEventListener('securitypolicyviolation', (event) => done(event.effectiveDirective), { once: true }),
    );
    fetch('https://example.com/').catch(() => {});
    return violation;
  });
  assert.equal(refused, 'connect-src');
  // The console has a message about this request only.
  const [tried, rest] = [
    page.problems.filter((problem) => /example\.com/.test(problem)),
    page.problems.filter((problem) => !/example\.com/.test(problem)),
  ];
  assert.ok(tried.length > 0);
  page.problems.splice(0, Infinity, ...rest);
  await page.close();
});
