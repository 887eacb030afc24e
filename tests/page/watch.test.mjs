// Tests the tool of the page in Chromium: the gallery, the timeline, the inspector, before and now, the limits,
// scramble, what can be taken away, links, and keys.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { EDGE_STATES, FlipSession, makeDelaunay } from 'edgeflip';
import { angles, generate, readMesh } from 'edgeflip/files';
import { SAMPLES } from '../../www/models/samples.js';
import { assertSameMesh, expected, first, fingerprintOf, meshFile, pageForBeta, sharedPage } from './page.mjs';

const BUNNY = 'models/bunny.ply';

/** Makes the clipboard readable, and returns a function that reads it. */
async function clipboardOf({ page }) {
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  return () => page.evaluate(() => navigator.clipboard.readText());
}

const press = async (page, ...keys) => {
  await page.page.evaluate(() => document.activeElement.blur());
  for (const key of keys) await page.page.keyboard.press(key);
};

/** What the inspector says. */
const inspected = ({ page }) =>
  page.evaluate(() => {
    const box = document.getElementById('inspect');
    if (box.hidden) return undefined;
    return {
      edge: box.dataset.edge.split(' ').map(Number),
      title: box.querySelector('header').textContent,
      sum: box.querySelector('strong')?.textContent,
      parts: box.querySelector('.sum span')?.textContent,
      sentence: box.querySelector('p').textContent,
    };
  });

/** The angle at `c` of the triangle of three vertices, in degrees, as the package measures it. */
async function angleAt(mesh, a, b, c) {
  const corner = (v) => Array.from({ length: mesh.dimension }, (_, k) => mesh.positions[mesh.dimension * v + k]);
  // The other two angles of an isosceles triangle over the same angle follow from it: both legs get the same length.
  const [p, q, r] = [a, b, c].map(corner);
  const leg = (end) => {
    const length = Math.hypot(...end.map((x, k) => x - r[k]));
    return end.map((x, k) => r[k] + (x - r[k]) / length);
  };
  const positions = Float64Array.from([...leg(p), ...leg(q), ...r]);
  const found = await angles({ positions, indices: Uint32Array.from([0, 1, 2]), dimension: mesh.dimension }, 180);
  const filled = [...found.counts].flatMap((count, bin) => Array(count).fill(bin));
  // Two of the three are equal to within a bin.
  const [low, middle, high] = filled;
  return middle - low <= 1 && 180 - 2 * middle > 0 && high > middle ? high : low;
}

test('each sample opens from the gallery, by its name and with the triangles of the package', async () => {
  const page = await sharedPage();
  for (const { spec, name, beta = 10 } of SAMPLES) {
    if (/^(uvsphere 600|random 500)$/.test(spec)) continue;
    await page.choose('sample', spec);
    await page.until(
      `${spec} to open`,
      ({ caption, state }) => caption === spec.replace('models/', '') && state !== 'busy',
    );
    const seen = await page.rest();
    const path = new URL(`../../target/public/${spec}`, import.meta.url);
    const mesh = spec.startsWith('models/') ? await readMesh(readFileSync(path), spec) : await generate(spec);
    assert.equal(seen.facts.Fingerprint, fingerprintOf(mesh.indices), spec);
    assert.equal(await page.page.textContent('#caption'), name);
    assert.equal(await page.page.inputValue('#beta'), `${beta}`, spec);
    // With the row of the edges that flip, if there are states.
    assert.equal(await page.page.locator('#legend [data-state=flips]').count(), 1, spec);
    const thumb = await page.page.evaluate(
      (of) => getComputedStyle(document.querySelector(`[data-spec="${of}"] .thumb`)).maskImage,
      spec,
    );
    const url = /url\("(.*)"\)/.exec(thumb)?.[1];
    assert.equal(await page.page.evaluate((address) => fetch(address).then(({ status }) => status), url), 200, spec);
  }
  await page.close();
});

test('the timeline has all iterations before they are run, and goes to any of them', async () => {
  const page = await sharedPage(BUNNY);
  const { facts, fingerprints, rows } = await expected(first.path, first.maxNormalAngle);
  const stops = () => page.page.evaluate(() => Number(document.getElementById('slider').max));
  await page.page.waitForFunction((count) => document.getElementById('slider').max === `${count}`, rows.length);
  assert.equal((await page.look()).newest, '0');
  const bars = await page.page.locator('#bars rect').count();
  assert.deepEqual([await stops(), bars], [rows.length, rows.length]);
  const flips = Number(rows[0][2].replaceAll(',', ''));
  const said = await page.page.locator('#bars .here').first().textContent();
  assert.equal(said, flips.toLocaleString('en'));
  for (const at of [3, 1, rows.length, 0]) {
    await page.page.evaluate((to) => {
      const slider = document.getElementById('slider');
      slider.value = `${to}`;
      slider.dispatchEvent(new Event('input', { bubbles: true }));
    }, at);
    await page.until(`iteration ${at}`, (seen) => seen.at === `${at}` && seen.measured === `${at}`);
    assert.equal((await page.look()).facts.Fingerprint, fingerprints[at], `after iteration ${at}`);
  }
  const [, labelled, firstFlips] = rows[0];
  const waits = Number(labelled.replaceAll(',', '')) - flips;
  assert.equal(
    (await page.look()).status,
    `${labelled} edges are wrong: ${firstFlips} flip first, ${waits.toLocaleString('en')} wait. Press play.`,
  );
  await page.page.evaluate(() => {
    const region = document.getElementById('announcement');
    window.announced = [];
    new MutationObserver(() => window.announced.push(region.textContent)).observe(region, { childList: true });
  });
  await press(page, 'End');
  const end = await page.until('the end', ({ state, measured, at }) => state === 'done' && measured === at);
  const [before, after] = facts['Smallest on average'].match(/[\d.]+/g).map((angle) => Math.round(Number(angle)));
  const time = /\d[\d,.]* ms/.exec(end.status);
  const [kept] = facts['Not Delaunay'].split(' ');
  assert.equal(
    end.status,
    `${facts.Flips} flips in ${facts.Iterations} iterations, ${time} on the CPU. ` +
      `Smallest angle on average ${before}° → ${after}°. ${kept} edges stay to keep the shape.`,
  );
  // It is said once, also if the state is measured again.
  await press(page, 't', 't');
  await page.rest();
  const announced = await page.page.evaluate(() => window.announced);
  assert.equal(announced.filter((text) => text.startsWith(end.status)).length, 1, announced.join('\n'));
  await page.close();
});

test('edges that flip are hot, and cool', async (t) => {
  const page = await sharedPage();
  await page.page.evaluate(() => {
    // A clock that the test slows down: a software GPU takes longer for a picture than edges are hot.
    const now = performance.now.bind(performance);
    let [last, shown] = [now(), now()];
    window.pace = 1;
    performance.now = () => {
      const time = now();
      shown += window.pace * (time - last);
      last = time;
      return shown;
    };
  });
  /** The pixels in the colour of flips, or close to it. */
  const hot = async () => {
    const { pixels } = await page.picture();
    return pixels.filter((colour) => ((colour >> 16) & 255) > 200 && ((colour >> 8) & 255) < 140).length;
  };
  const pace = (factor) => page.page.evaluate((to) => (window.pace = to), factor);
  await pace(0.01);
  await press(page, 'ArrowRight');
  await page.until('an iteration', ({ newest }) => newest === '1');
  const soon = await hot();
  await pace(1);
  let later = await hot();
  for (const end = performance.now() + 30_000; soon <= 1.1 * later && performance.now() < end; ) later = await hot();
  t.diagnostic(`${soon} pixels are hot, then ${later}`);
  assert.ok(soon > 1.1 * later && later > 0);
  await page.page.evaluate(() => delete performance.now);
  await page.close();
});

test('an edge under the pointer is inspected: its state and its angles are those of the package', async () => {
  const page = await sharedPage(BUNNY);
  const mesh = await readMesh(readFileSync(first.path), first.path);
  const session = await FlipSession.create(mesh, { backend: 'cpu', maxNormalAngle: first.maxNormalAngle });
  const states = await session.edgeStates();
  session.free();
  const { x, y, width, height } = await (await page.page.$('#view')).boundingBox();
  const next = (h) => (h % 3 === 2 ? h - 2 : h + 1);
  let found = 0;
  for (const [u, v] of [
    [0.42, 0.5],
    [0.38, 0.42],
    [0.46, 0.6],
    [0.5, 0.66],
  ]) {
    await page.page.mouse.move(x + u * width, y + v * height);
    await page.page.waitForTimeout(100);
    const seen = await inspected(page);
    assert.ok(seen, `an edge at ${u}, ${v}`);
    const [a, b] = seen.edge;
    const halves = mesh.indices
      .map((_, h) => h)
      .filter((h) => {
        const ends = [mesh.indices[h], mesh.indices[next(h)]];
        return ends.includes(a) && ends.includes(b);
      });
    assert.equal(halves.length, 2, `edge ${a}–${b} of the mesh`);
    const opposite = [...halves].map((h) => mesh.indices[next(next(h))]);
    const sizes = await Promise.all(opposite.map((c) => angleAt(mesh, a, b, c)));
    const shown = seen.parts.match(/\d+/g).map(Number);
    for (const size of sizes)
      assert.ok(
        shown.some((angle) => Math.abs(angle - size) <= 1.5),
        `${seen.parts}: ${sizes}`,
      );
    const state = EDGE_STATES[states[halves[0]]];
    const words = { delaunay: /^Delaunay/, flips: /^Flips now/, waits: /^Waits/, angle: /^Kept: crease/ };
    assert.match(seen.title, words[state], state);
    const isMore = Number.parseInt(seen.sum, 10) > 180;
    assert.equal(isMore, state !== 'delaunay', `${seen.sum}, ${state}`);
    if (state === 'flips') assert.match(seen.sentence, /more than 180°, so this edge flips in the next iteration/);
    found++;
  }
  assert.equal(found, 4);

  await press(page, 'n');
  const wrong = await inspected(page);
  assert.doesNotMatch(wrong.title, /^Delaunay/);
  await press(page, 'n');
  assert.notDeepEqual((await inspected(page)).edge, wrong.edge);
  await press(page, 'Shift+N');
  assert.deepEqual((await inspected(page)).edge, wrong.edge);
  await press(page, 'Escape');
  assert.equal(await inspected(page), undefined);
  await page.close();
});

test('before and now: the left of the cut is the input, the right is the shown state', async () => {
  const page = await sharedPage(BUNNY);
  await press(page, 'e');
  await page.rest();
  const input = await page.picture();
  await press(page, 'End');
  await page.until('the end', ({ state, measured, at }) => state === 'done' && measured === at);
  const result = await page.picture();
  assert.ok(input.differsFrom(result) > 0.005);
  await press(page, 'c');
  const cut = (value) =>
    page.page.evaluate((to) => {
      const control = document.getElementById('cut');
      control.value = to;
      control.dispatchEvent(new Event('input', { bubbles: true }));
      document.getElementById('halves').style.opacity = '0';
    }, value);
  await cut('1000');
  assert.ok((await page.picture()).differsFrom(input) < 0.001, 'all of it is the input');
  await cut('0');
  assert.ok((await page.picture()).differsFrom(result) < 0.001, 'all of it is the result');
  await cut('430');
  const both = await page.picture();
  assert.ok(both.differsFrom(input) > 0.001 && both.differsFrom(result) > 0.001, 'one half of each');
  await press(page, 'c');
  assert.ok((await page.picture()).differsFrom(result) < 0.001);
  await page.page.evaluate(() => (document.getElementById('halves').style.opacity = ''));
  await page.close();
});

test('limits: β, deviation, features and borders change the run as the options of the package do', async () => {
  const page = await sharedPage(BUNNY);
  const mesh = await readMesh(readFileSync(first.path), first.path);
  const enter = async (id, text) => {
    await page.showLimits();
    await page.page.fill(`#${id}`, text);
    await page.page.press(`#${id}`, 'Tab');
    await page.until('a new run', ({ at, state }) => at === '0' && state === 'ready');
    await page.rest();
    await page.page.evaluate(() => document.getElementById('limits').hidePopover());
  };
  const result = async (options) => {
    const end = await page.playToEnd();
    const { indices, remaining } = await makeDelaunay(mesh, { backend: 'cpu', maxNormalAngle: 30, ...options });
    assert.equal(end.facts.Fingerprint, fingerprintOf(indices));
    return remaining;
  };
  await enter('deviation', '0.02');
  assert.ok((await result({ maxDeviation: 0.02 })).deviation > 0);
  await enter('deviation', '');
  await enter('feature', '12');
  const session = await FlipSession.create(mesh, { backend: 'cpu' });
  const { v1, v2, ta, tb } = await session.edges();
  session.free();
  const normal = (h) => {
    const [p, q, r] = [0, 1, 2].map((k) => {
      const v = mesh.indices[h - (h % 3) + k];
      return [0, 1, 2].map((axis) => mesh.positions[3 * v + axis]);
    });
    const [u, w] = [q, r].map((end) => end.map((value, axis) => value - p[axis]));
    return [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
  };
  const lockedEdges = [...ta].flatMap((first, e) => {
    if (tb[e] === 0xffffffff) return [];
    const [m, n] = [normal(first), normal(tb[e])];
    const cosine = m.reduce((sum, value, axis) => sum + value * n[axis], 0) / (Math.hypot(...m) * Math.hypot(...n));
    return Math.acos(Math.min(1, cosine)) * (180 / Math.PI) > 12 ? [v1[e], v2[e]] : [];
  });
  assert.ok((await result({ lockedEdges })).locked > 0);
  for (const [id, text] of [
    ['deviation', '-1'],
    ['feature', '200'],
  ]) {
    await page.showLimits();
    await page.page.fill(`#${id}`, text);
    await page.page.press(`#${id}`, 'Tab');
    const { error } = await page.until('a message', ({ error }) => error !== '');
    assert.match(error, /Leave it empty/);
    await page.page.evaluate(() => document.getElementById('limits').hidePopover());
    await page.page.click('#dismiss');
  }
  await page.close();
});

test('scramble keeps the points and the number of triangles, and the mesh heals', async () => {
  const page = await sharedPage();
  await page.choose('sample', 'regular 16');
  const before = await page.rest();
  assert.deepEqual([before.state, before.newest], ['done', '0']);
  assert.match(before.status, /Already Delaunay/);
  assert.match(await page.page.textContent('#announcement'), /Already Delaunay/);
  const mesh = await generate('regular 16');
  await page.page.click('#scramble');
  await page.until(
    'other triangles',
    ({ facts, state }) =>
      state === 'ready' && facts.Fingerprint !== before.facts.Fingerprint && facts.Fingerprint !== '…',
  );
  await page.rest();
  const scrambled = await page.download();
  assert.deepEqual(scrambled.positions, mesh.positions);
  assert.equal(scrambled.indices.length, mesh.indices.length);
  assert.notDeepEqual(scrambled.indices, mesh.indices);
  const end = await page.playToEnd();
  assert.equal(end.facts['Not Delaunay'], 'none');
  assert.ok(Number(end.facts.Flips.replaceAll(',', '')) > 40, end.facts.Flips);
  await page.close();
});

test('a mesh is saved in every format, and opens again with the same triangles', async () => {
  const page = await sharedPage();
  await page.open(await meshFile('roof 16', 'roof.ply'));
  const end = await page.playToEnd();
  let again;
  for (const format of ['PLY', 'OBJ', 'GLB', 'OFF']) {
    await page.page.click('#take');
    const [download] = await Promise.all([
      page.page.waitForEvent('download'),
      page.page.click(`#formats button:text-is("${format}")`),
    ]);
    await page.page.keyboard.press('Escape');
    assert.match(download.suggestedFilename(), new RegExp(`^roof-after-\\d+\\.${format.toLowerCase()}$`));
    const saved = await download.path();
    const mesh = await readMesh(readFileSync(saved), download.suggestedFilename());
    assert.equal(fingerprintOf(mesh.indices), end.facts.Fingerprint, format);
    if (format === 'OBJ') again = readFileSync(saved);
  }
  await page.page.click('#take');
  const [picture] = await Promise.all([page.page.waitForEvent('download'), page.page.click('#picture')]);
  const png = readFileSync(await picture.path());
  assert.equal(png.toString('latin1', 1, 4), 'PNG');
  assert.ok(png.length > 5000, `${png.length} bytes`);
  await page.page.setInputFiles('#file', { name: 'again.obj', mimeType: '', buffer: again });
  const seen = await page.until('the mesh', ({ caption, state }) => caption === 'again.obj' && state !== 'busy');
  assert.equal(seen.error, '');
  assert.equal((await page.rest()).facts.Fingerprint, end.facts.Fingerprint);
  await page.close();
});

test('a link opens the same mesh, engine, limit, iteration and view', async () => {
  const page = await pageForBeta();
  const clipboard = await clipboardOf(page);
  await page.choose('sample', 'uvsphere 28 0.1');
  await page.rest();
  await page.chooseEngine('cpu');
  await page.setBeta('45');
  await page.until('a new run', ({ facts, state }) => facts['Crease limit β'] === '45°' && state === 'ready');
  await page.rest();
  await press(page, 'ArrowRight');
  await page.until('one iteration', ({ at, measured }) => at === '1' && measured === '1');
  await page.page.mouse.move(600, 450);
  await page.page.mouse.down();
  await page.page.mouse.move(700, 420, { steps: 5 });
  await page.page.mouse.up();
  await press(page, 'Escape');
  const picture = await page.stillPicture();
  const before = await page.rest();
  await press(page, 'k');
  const notice = page.page.locator('#notice');
  await notice.getByText('Link copied').waitFor({ state: 'visible' });
  const link = await clipboard();
  assert.match(link, /#watch\?mesh=uvsphere\+28\+0\.1&at=1&engine=cpu&beta=45&view=/);

  // A worker whose script is still on its way would count as a failed request.
  await page.page.waitForLoadState('networkidle');
  await page.page.goto('about:blank');
  await page.page.goto(link);
  const after = await page.until(
    'the iteration',
    ({ at, measured, caption }) => at === '1' && measured === '1' && caption === 'uvsphere 28 0.1',
  );
  assert.deepEqual(
    [after.facts.Fingerprint, after.facts['Crease limit β'], after.backend],
    [before.facts.Fingerprint, '45°', 'cpu'],
  );
  const differs = (await page.stillPicture()).differsFrom(picture);
  assert.ok(differs < 0.005, `another view: ${differs}`);

  await page.open(await meshFile('roof 16', 'own.ply'));
  await press(page, 'k');
  await notice.getByText('samples only').waitFor({ state: 'visible' });
  await page.close();
});

test('the keys are listed, and Escape closes what is open', async () => {
  const page = await sharedPage(BUNNY);
  await press(page, '?');
  const listed = await page.page.locator('#keys kbd').allTextContents();
  for (const key of ['Space', 'C', 'N, Shift N', 'K', 'Esc']) assert.ok(listed.includes(key), `${key}: ${listed}`);
  await page.page.keyboard.press('Escape');
  assert.equal(await page.page.evaluate(() => document.getElementById('keys').open), false);
  const isShown = (id) => page.page.evaluate((name) => document.getElementById(name).matches(':popover-open'), id);
  for (const [key, id] of [
    ['l', 'limits'],
    ['s', 'away'],
  ]) {
    await press(page, key);
    assert.equal(await isShown(id), true, id);
    await page.page.keyboard.press('Escape');
    assert.equal(await isShown(id), false, id);
  }
  await press(page, '2');
  await page.until('the second sample', ({ caption, state }) => caption === 'flange.obj' && state !== 'busy');
  assertSameMesh(
    await page.download(),
    await readMesh(readFileSync(first.path.replace('bunny.ply', 'flange.obj')), 'flange.obj'),
    'of sample 2',
  );
  await page.close();
});
