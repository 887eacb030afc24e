// Tests the section "Three engines, one answer" in Chromium. Serves the existing target/www.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { makeDelaunay } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { build } from 'esbuild';
import site from '../../www/vite.config.js';
import { openPage, serve, startChromium } from '../browsers.mjs';
import { fingerprintOf, sharedPage } from './page.mjs';

const at = (path) => fileURLToPath(new URL(path, import.meta.url));

/** Opens the section. `worker` is the source of a script in place of the worker that times the engines. */
async function openSection({ worker, script } = {}) {
  const address = await serve(at('../../target/www'), site.preview.headers);
  const { page, problems } = await openPage(await startChromium(), 'about:blank');
  await page.emulateMedia({ reducedMotion: 'reduce' });
  if (script) await page.addInitScript(script);
  if (worker) {
    await page.route('**/assets/timing-*.js', (route) =>
      route.fulfill({ contentType: 'text/javascript', headers: site.preview.headers, body: worker }),
    );
  }
  await page.goto(`${address}#engines`);
  const [race, measure] = [page.locator('.engines-main'), page.locator('.engines-crossover .engines-button')];
  await race.waitFor();
  const close = async () => {
    assert.deepEqual(problems, []);
    await page.close();
  };
  return { page, race, measure, close };
}

/** A worker that says these times, in milliseconds by engine and triangles, and gives the mesh as the result. */
async function workerThatSays(ms, isSoftware = '() => false') {
  const contents = `
    import { expose } from 'comlink';
    const ms = ${ms};
    expose({
      generate(spec) {
        const triangles = 2 * (spec.split(' ')[1] - 1) ** 2;
        return { positions: new Float32Array(6), indices: new Uint32Array(3 * triangles), dimension: 2 };
      },
      isSoftware: ${isSoftware},
      start: async () => 1234,
      async time({ indices }, { backend, threads }, most) {
        const median = await ms({ backend, threads, triangles: indices.length / 3 });
        if (typeof median === 'string') throw new Error(median);
        const result = { indices, flips: 7, threads: backend === 'cpu' ? threads ?? 2 : 0 };
        return { median, runs: median > most ? 1 : 5, result, isSoftware: false };
      },
    });`;
  const bundle = { stdin: { contents, resolveDir: at('.') }, bundle: true, format: 'esm', write: false };
  return (await build(bundle)).outputFiles[0].text;
}

/** What a row shows. */
const resultsOf = (page) =>
  page.locator('.engines-result').evaluateAll((rows) =>
    rows.map((row) => {
      const text = (kind) => row.querySelector(`.engines-${kind}`).textContent;
      const drawn = (kind) => row.querySelector(`.engines-${kind}`)?.getAttribute('d') ?? '';
      return {
        name: row.querySelector('h3').textContent,
        where: text('where'),
        recorded: row.querySelector('.engines-recorded:not([hidden])')?.textContent,
        /** The widths of the recorded bar and of this computer's. */
        bars: [...row.querySelectorAll('.engines-track i')].map((bar) => (bar.hidden ? '' : bar.style.width)),
        time: text('time'),
        speed: text('speed'),
        why: text('why'),
        digits: text('print'),
        same: drawn('same'),
        other: drawn('other'),
        isFirst: row.classList.contains('engines-first'),
      };
    }),
  );

const squares = (path) => path.split('M').length - 1;

/** The digits that a drawing shows: `M0 0l…` goes down from the left, a 1; else it starts at the right, a 0. */
function digitsOf(path) {
  const bits = Array(64).fill(0);
  for (const [, x, y, dx] of path.matchAll(/M([\d.]+) ([\d.]+)l(-?[\d.]+)/g)) {
    const column = (Number(x) + Math.min(0, Number(dx))) / 7.5;
    bits[(8 * Number(y)) / 7.5 + column] = Number(dx) > 0 ? 1 : 0;
  }
  return bits.join('').replace(/.{4}/g, (four) => Number.parseInt(four, 2).toString(16));
}

const NAMES = ['CPU, 1 thread', 'CPU, threads', 'WebGPU', 'WebGL2'];
const namesOf = (rows) => rows.map(({ name }) => name.replace(/\d+ threads/, 'threads'));

test('the open mesh races: every engine here gives the triangles of the package in Node', async () => {
  const { indices, flips } = await makeDelaunay(await generate('random 24'), { backend: 'cpu' });
  const edgeflip = await sharedPage('random 24');
  const { page } = edgeflip;
  await page.evaluate(() => document.getElementById('engines').scrollIntoView());
  await page.locator('.engines-open').click();
  await page.locator('.engines-open', { hasText: 'Race' }).waitFor({ timeout: 400_000 });
  const rows = await resultsOf(page);
  assert.deepEqual(namesOf(rows), NAMES);
  const ran = rows.filter(({ why }) => why === '');
  for (const { name, time, digits, same, other, recorded } of ran) {
    assert.equal(digits, fingerprintOf(indices), name);
    assert.deepEqual([digitsOf(same), squares(other)], [digits, 0], name);
    assert.match(time, /^[\d.,]+ m?s$/);
    assert.equal(recorded, undefined, 'the record is of another mesh');
  }
  assert.equal(ran.length, 3);
  assert.match(rows[1].why, /A mesh this small runs on one thread/);
  assert.match(await page.locator('.engines-verdict').textContent(), /All three are equal, bit for bit/);
  assert.match(rows[2].where, /Software GPU/);
  const numbers = `${(indices.length / 3).toLocaleString('en')} triangles, ${flips.toLocaleString('en')} flips`;
  assert.match(await page.locator('.engines-lede').textContent(), new RegExp(numbers));
  await edgeflip.close();
});

/** The recorded milliseconds of a mesh by engine. */
function recordOf(mesh) {
  const text = readFileSync(at('../../benches/results/2026-11-30-h200-auto-bb6ecde.md'), 'utf8');
  const [, table] = text.split(/^## Chromium 148, ready.*$/m);
  const cells = (start) =>
    table
      .split('\n')
      .find((line) => line.startsWith(`| ${start} |`))
      .split('|');
  const names = cells('mesh').map((name) => name.trim());
  const ms = (name) => Number(cells(mesh)[names.indexOf(name)]);
  return { cpu: ms('cpu ms'), webgpu: ms('webgpu ms'), webgl2: ms('webgl2 ms') };
}

test('a recorded run is there at once, and this computer’s lanes come over it', async () => {
  const record = recordOf('random 269');
  const most = Math.max(...Object.values(record));
  const worker = await workerThatSays(`({ backend, threads }) => ({ cpu: threads === 1 ? 300 : 100 }[backend] ?? 30)`);
  const { page, race, close } = await openSection({ worker });
  const digits = (ms) => (ms < 10 ? ms.toFixed(2) : ms < 100 ? ms.toFixed(1) : ms.toFixed(0));
  // The row has the threads of this computer in its name; the record was on others.
  const on = { cpu: ' on 16 threads' };
  const texts = ['cpu', 'webgpu', 'webgl2'].map(
    (engine) => `Recorded${on[engine] ?? ''}: ${digits(record[engine])} ms`,
  );
  const before = await resultsOf(page);
  assert.deepEqual(namesOf(before), NAMES);
  assert.deepEqual(
    before.map(({ recorded }) => recorded),
    ['Not recorded', ...texts],
  );
  assert.deepEqual(before[0].bars, ['', '']);
  const share = (ms, all) => `${Number(((100 * ms) / all).toFixed(3))}%`;
  const rounded = (width) => width && share(Number.parseFloat(width), 100);
  assert.deepEqual(before[2].bars.map(rounded), [share(record.webgpu, most), '']);
  const source = page.locator('.engines-source');
  assert.match(
    await source.textContent(),
    /^Grey: an NVIDIA H200 .* Chromium 148, 30 November 2026, medians of 5 runs\./,
  );
  assert.match(
    await source.locator('a').getAttribute('href'),
    /^benches\/results\/2026-11-30-h200-auto-bb6ecde\.html#chromium-148-ready-/,
  );
  // The recorded lines are there too.
  assert.equal(await page.locator('.engines-chart .engines-old').count(), 3);

  await race.click();
  await page.locator('.engines-main', { hasText: 'Race again' }).waitFor();
  const after = await resultsOf(page);
  assert.deepEqual(after[2].bars.map(rounded), [share(record.webgpu, 300), share(30, 300)]);
  assert.deepEqual(after[0].bars.map(rounded), ['', '100%']);
  assert.match(await page.locator('.engines-lede').textContent(), /143,648 triangles, 7 flips\./);
  // The start is no part of the time.
  assert.equal(after[2].time, '30.0 ms');
  assert.match(after[2].where, /Start: 1,234 ms$/);
  await close();
});

test('the CPU races first, and an engine that takes over 5 s is stopped and says so', async () => {
  const worker = await workerThatSays('() => new Promise(() => {})');
  const script = () => {
    const { setTimeout } = window;
    // Nobody waits for 5 s here.
    window.setTimeout = (call, ms, ...args) => setTimeout(call, ms === 5000 ? 300 : ms, ...args);
    window.notes = [];
    document.addEventListener('DOMContentLoaded', () =>
      new MutationObserver(() => {
        const note = document.querySelector('.engines-note')?.textContent;
        if (note !== window.notes.at(-1)) window.notes.push(note);
      }).observe(document.body, { subtree: true, childList: true }),
    );
  };
  const { page, race, close } = await openSection({ worker, script });
  await race.click();
  await page.locator('.engines-main', { hasText: 'Race again' }).waitFor();
  const notes = await page.evaluate(() => window.notes);
  const order = notes.flatMap((note) => note?.match(/^(.*) runs\.$/)?.[1] ?? []);
  assert.deepEqual(namesOf(order.map((name) => ({ name }))), NAMES);
  for (const { name, why, time } of await resultsOf(page)) {
    assert.match(why, /^Stopped after 5\ss\.$/, name);
    assert.equal(time, '–', name);
  }
  await close();
});

test('a result that differs stands out, and an engine that fails says why', async () => {
  const worker = await workerThatSays(`({ backend, threads }) =>
    backend === 'webgl2' ? 'the context was lost' : backend === 'webgpu' ? 4 : threads === 1 ? 80 : 20`);
  // The third fingerprint, that of WebGPU, is wrong in its first bits.
  const script = () => {
    const digest = crypto.subtle.digest.bind(crypto.subtle);
    let calls = 0;
    crypto.subtle.digest = async (...args) => {
      const bytes = new Uint8Array(await digest(...args));
      if (calls++ === 2) bytes[0] ^= 0b10100000;
      return bytes.buffer;
    };
  };
  const { page, race, close } = await openSection({ worker, script });
  await race.click();
  await page.locator('.engines-main', { hasText: 'Race again' }).waitFor();
  const [one, threads, webgpu, webgl2] = await resultsOf(page);
  assert.deepEqual(
    [webgpu, threads, one].map(({ time, speed }) => [time, speed]),
    [
      ['4.00 ms', '20.0×'],
      ['20.0 ms', '4.0×'],
      ['80.0 ms', '1×'],
    ],
  );
  assert.equal(webgl2.why, 'The context was lost.');
  assert.deepEqual(
    [webgpu, threads, one].map(({ other }) => squares(other)),
    [2, 0, 0],
  );
  assert.equal(digitsOf(webgpu.same + webgpu.other), webgpu.digits);
  assert.deepEqual([webgpu.isFirst, threads.isFirst, one.isFirst], [true, false, false]);
  assert.match(await page.locator('.engines-verdict').textContent(), /^Not equal: WebGPU\./);
  await close();
});

test('the headline and the table have what was measured', async () => {
  // The lines cross at 10,000 triangles.
  const worker = await workerThatSays(`({ backend, triangles }) =>
    backend === 'webgpu' ? 5 : backend === 'webgl2' ? triangles / 100 : triangles / 2000`);
  const { page, measure, close } = await openSection({ worker });
  await measure.click();
  await page.locator('.engines-crossover .engines-button', { hasText: 'again' }).waitFor();
  const title = page.locator('.engines-crossover .engines-title');
  assert.equal(await title.textContent(), 'From 10,000 triangles on, the GPU is first on this computer');
  const rows = await page
    .locator('.engines-details tr')
    .evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
  assert.deepEqual(
    rows.slice(1).map(([triangles, ...times]) => [triangles, ...times]),
    [
      ['200', '0.10 ms', '5.00 ms', '2.00 ms'],
      ['722', '0.36 ms', '5.00 ms', '7.22 ms'],
      ['2,738', '1.37 ms', '5.00 ms', '27.4 ms'],
      ['10,368', '5.18 ms', '5.00 ms', '104 ms'],
      ['38,642', '19.3 ms', '5.00 ms', '386 ms'],
      ['143,648', '71.8 ms', '5.00 ms', '1,436 ms'],
      // A run on WebGL2 took more than 1 s before.
      ['500,000', '250 ms', '5.00 ms', '–'],
    ],
  );
  assert.equal(await page.locator('.engines-dot').count(), 20);
  assert.equal(await page.locator('.engines-at').textContent(), '10,000 triangles');
  await close();
});

test('without a GPU that is faster, the CPU is first', async () => {
  const slow = await workerThatSays(`({ backend, triangles }) => (backend === 'cpu' ? 0.01 : 0.02) * triangles`);
  const emulated = await workerThatSays('() => 1', "({ backend }) => backend !== 'cpu'");
  for (const [worker, headline] of [
    [slow, 'On this computer the CPU is first at every size measured'],
    [emulated, 'Only the CPU was measured on this computer'],
  ]) {
    const { page, measure, close } = await openSection({ worker });
    await measure.click();
    await page.locator('.engines-crossover .engines-button', { hasText: 'again' }).waitFor();
    assert.equal(await page.locator('.engines-crossover .engines-title').textContent(), headline);
    assert.equal(await page.locator('.engines-notes li').count(), worker === slow ? 0 : 2);
    await close();
  }
});

test('a measurement stops when asked, and another can begin', async () => {
  const worker = await workerThatSays('() => new Promise(() => {})');
  const { page, race, measure, close } = await openSection({ worker });
  await race.click();
  assert.equal(await race.textContent(), 'Stop');
  assert.ok(await measure.isDisabled());
  await race.click();
  await page.locator('.engines-note', { hasText: 'Stopped.' }).waitFor();
  assert.ok(await measure.isEnabled());
  assert.equal(await page.locator('.engines-running').count(), 0);
  await close();
});

test('the section says from which size on `auto` takes the GPU', async () => {
  const rates = readFileSync(at('../../src/session/cost.rs'), 'utf8').split('#[cfg(target_arch = "wasm32")]')[1];
  const value = (name) => Number(rates.match(new RegExp(`\\b${name}: ([\\d.]+)`))[1]);
  const [plane, space] = rates
    .match(/cpu: \[([\d., ]+)\]/)[1]
    .split(',')
    .map(Number);
  const margin = 2.5;
  // On one thread, the CPU is as fast as the GPU and its margin.
  const limit = (cpu) => (1e6 * (value('gpu') + margin)) / (cpu - value('gpu_triangle'));
  const thousands = (cpu) => `${Math.round(limit(cpu) / 1000)},000`;
  const { page, close } = await openSection();
  const [rule] = await page.locator('.engines-rules li').allTextContents();
  assert.equal(
    rule,
    `Up to about ${thousands(space)} triangles in space, or ${thousands(plane)} in the plane: the CPU.`,
  );
  // Both sizes of the plane are in one sentence.
  const [, recorded] = (await page.textContent('.engines-crossover .engines-note')).match(
    /from ([\d,]+) triangles on\.$/,
  );
  const note = await page.textContent('.engines-auto .engines-note');
  assert.ok(
    note.startsWith(`In the recorded run, the GPU was first in the plane from ${recorded} triangles on; “auto”`),
    note,
  );
  assert.ok(note.includes(`saves ${margin} ms`), note);
  await close();
});
