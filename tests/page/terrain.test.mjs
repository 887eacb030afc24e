// Tests the sample of a terrain: its triangles are judged from above, its breaklines stay, and its heights are kept.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { before, test } from 'node:test';
import { makeDelaunay } from 'edgeflip';
import { angles, readMesh } from 'edgeflip/files';
import { fingerprintOf, sharedPage } from './page.mjs';

const SPEC = 'models/terrain.obj';
const number = new Intl.NumberFormat('en');

/** The heights decide nothing: these are the two coordinates that do. */
const planOf = ({ positions, indices }) => ({
  positions: Float32Array.from(
    { length: (positions.length / 3) * 2 },
    (_, i) => positions[3 * (i >> 1) + 2 - 2 * (i % 2)],
  ),
  indices,
  dimension: 2,
});

let mesh;
let want;
before(async () => {
  const bytes = readFileSync(new URL(`../../target/public/${SPEC}`, import.meta.url));
  mesh = await readMesh(bytes, SPEC, { dimension: 3 });
  want = await makeDelaunay(planOf(mesh), { backend: 'cpu', groups: mesh.groups });
});

test('a terrain ends Delaunay from above on every engine, and its file keeps all heights', async () => {
  assert.deepEqual([want.inverted, want.flat], [0, 0]);
  assert.ok(want.flips > 500 && want.remaining.locked > 0, JSON.stringify(want.remaining));
  const surface = await makeDelaunay({ ...mesh }, { backend: 'cpu', groups: mesh.groups, maxNormalAngle: 180 });
  assert.notEqual(fingerprintOf(surface.indices), fingerprintOf(want.indices), 'the heights would decide otherwise');
  const page = await sharedPage(SPEC);
  for (const engine of ['cpu', 'webgl2', 'webgpu']) {
    await page.chooseEngine(engine);
    const end = await page.playToEnd();
    assert.equal(end.facts.Fingerprint, fingerprintOf(want.indices), engine);
    assert.deepEqual(
      [end.facts.Vertices, end.facts.Flips, end.facts['Not Delaunay'], end.facts['Turned over']],
      [
        number.format(mesh.positions.length / 3),
        number.format(want.flips),
        `${number.format(want.remaining.locked)} locked`,
        undefined,
      ],
    );
    const file = await page.download();
    assert.deepEqual(new Uint32Array(file.positions.buffer), new Uint32Array(mesh.positions.buffer), engine);
    assert.deepEqual(
      [file.name, fingerprintOf(file.indices)],
      [`terrain-after-${want.iterations}.obj`, fingerprintOf(want.indices)],
    );
    assert.deepEqual(file.groups, mesh.groups, engine);
    const input = await page.scrub('Home');
    assert.equal(input.facts.Fingerprint, fingerprintOf(mesh.indices), engine);
  }
  await page.close();
});

test('an edge of a terrain has its angles from above', async () => {
  const page = await sharedPage(SPEC);
  const end = await page.playToEnd();
  const { min } = await angles({ ...planOf(mesh), indices: want.indices });
  assert.match(end.facts.Smallest, new RegExp(`→ ${min.toFixed(2)}°$`));
  await page.page.evaluate(() => document.activeElement.blur());
  await page.page.keyboard.press('n');
  await page.page.locator('#inspect').waitFor();
  const [a, b] = (await page.page.getAttribute('#inspect', 'data-edge')).split(' ').map(Number);
  const at = (v) => [mesh.positions[3 * v + 2], mesh.positions[3 * v]];
  const found = [];
  for (let t = 0; t < want.indices.length; t += 3) {
    const corners = [...want.indices.subarray(t, t + 3)];
    if (!corners.includes(a) || !corners.includes(b)) continue;
    const [x, y] = at(corners.find((v) => v !== a && v !== b));
    const [from, to] = [a, b].map((v) => Math.atan2(at(v)[1] - y, at(v)[0] - x));
    const turn = Math.abs(from - to);
    found.push((Math.min(turn, 2 * Math.PI - turn) * 180) / Math.PI);
  }
  assert.equal(found.length, 2);
  const shown = await page.page.textContent('#inspect .sum');
  assert.ok(shown.startsWith(`${Math.round(found[0] + found[1])}°`), `${shown}, not ${found}`);
  await page.page.locator('#inspect').getByText('It is a border of the attribute “usemtl” (materials)').waitFor();
  await page.close();
});

test('a terrain is scrambled as seen from above, and edges are drawn into it', async () => {
  const page = await sharedPage(SPEC);
  const done = await page.playToEnd();
  await page.page.click('#scramble');
  await page.until(
    'other triangles',
    ({ state, measured, facts }) =>
      state === 'ready' &&
      measured === '0' &&
      facts.Fingerprint !== done.facts.Fingerprint &&
      facts.Fingerprint !== '…',
  );
  const healed = await page.playToEnd();
  assert.equal(healed.facts['Turned over'], undefined);
  assert.equal(healed.facts.Smallest.split(' → ')[1], done.facts.Smallest.split(' → ')[1]);
  await page.page.click('#draw');
  // Between the ridge and the river.
  const places = await page.page.evaluate(() => {
    const [left, right] = ['.what', '.side'].map(
      (name) => document.querySelector(`#watch ${name}`).getBoundingClientRect().x,
    );
    return [(left + right) / 2, 0.42 * innerHeight];
  });
  await page.page.mouse.move(places[0] - 60, places[1]);
  await page.page.mouse.down();
  await page.page.mouse.move(places[0] + 60, places[1] - 10, { steps: 4 });
  await page.page.mouse.up();
  await page.until(
    'the edge to come in',
    ({ state, facts }) => state === 'done' && facts.Fingerprint !== healed.facts.Fingerprint,
  );
  const drawn = await page.rest();
  assert.equal(drawn.facts['Turned over'], undefined);
  assert.deepEqual((await page.download()).positions, mesh.positions);
  await page.close();
});
