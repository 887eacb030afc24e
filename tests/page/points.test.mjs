// Tests points on the page in Chromium: those of the sample are dragged across the hull, with a mouse and with a finger,
// and those of files become meshes. The triangles are those of `triangulate` in Node, bit for bit.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { PointSession, triangulate } from 'edgeflip/points';
import { file, folder, openEdgeflip, sharedPage } from './page.mjs';
import { startChromium } from '../browsers.mjs';

/** The sample reaches so far from the middle, and the camera leaves some room around it. */
const REACH = 1.15 * 0.7 * 1.05;

async function showPoints(page) {
  await page.choose('sample', 'moving points');
  await page.until(
    'points that move',
    ({ state, facts }) => state === 'moving' && Number(facts['New edges a frame']) > 0,
  );
}

async function pauseAll(page) {
  await page.page.click('#play');
  await page.until(
    'a pause',
    ({ state, status }) => state === 'paused' && status.startsWith('Every edge is Delaunay.'),
  );
}

/** Where a place of the scene is on the screen. */
async function mapOf(page) {
  const [left, right, top, bottom] = await page.page.evaluate(() => {
    const box = (selector) => document.querySelector(selector).getBoundingClientRect();
    return [
      box('#gallery').right + 16,
      box('#watch .side').left,
      box('#about').bottom + 12,
      box('#status').bottom - 48,
    ];
  });
  const scale = Math.min(right - left, bottom - top) / (2 * REACH);
  return ([x, y]) => [(left + right) / 2 + scale * x, (top + bottom) / 2 - scale * y];
}

/** What the page saves, which is what it draws. Its triangles and the hull are those of its points. */
async function saved(page) {
  const { positions, indices, dimension } = await page.download();
  assert.equal(dimension, 2);
  const want = await triangulate(positions);
  assert.deepEqual(indices, want.triangles);
  const { facts } = await page.until(
    'the hull in the numbers',
    (seen) => seen.facts['Points on the hull'] === `${want.hull.length}`,
  );
  assert.equal(facts.Triangles.replace(',', ''), `${indices.length / 3}`);
  return { positions, at: (v) => [...positions.subarray(2 * v, 2 * v + 2)], hull: [...want.hull] };
}

/** The points that are not where they were. */
const movedFrom = (before, after) =>
  [...Array(before.positions.length / 2).keys()].filter((v) =>
    before.at(v).some((x, k) => Math.abs(x - after.at(v)[k]) > 1e-6),
  );

const near = ([x, y], [wantX, wantY], within = 0.01) =>
  assert.ok(Math.hypot(x - wantX, y - wantY) < within, `${[x, y]}, not ${[wantX, wantY]}`);

async function dragWithMouse(page, from, to) {
  await page.page.mouse.move(...from);
  await page.page.mouse.down();
  await page.page.mouse.move(...to, { steps: 8 });
  await page.page.mouse.up();
}

async function dragWithFinger(page, [x, y], [toX, toY]) {
  const session = await page.page.context().newCDPSession(page.page);
  const touch = (type, share) =>
    session.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: type === 'touchEnd' ? [] : [{ x: x + share * (toX - x), y: y + share * (toY - y) }],
    });
  await touch('touchStart', 0);
  for (let i = 1; i <= 8; i++) await touch('touchMove', i / 8);
  await touch('touchEnd', 1);
  await session.detach();
}

test('points are dragged across the hull, inwards and outwards, and the triangles are those of the points', async () => {
  const page = await sharedPage();
  await showPoints(page);
  assert.equal(await page.page.textContent('#about'), '600 points. Drag any of them, also across the hull.');
  assert.deepEqual([await page.page.isVisible('#many'), await page.page.isVisible('#backend')], [false, false]);
  await pauseAll(page);
  const onScreen = await mapOf(page);
  const picture = await page.picture();
  let before = await saved(page);

  // From the hull to the middle.
  const inwards = before.hull[0];
  await dragWithMouse(page, onScreen(before.at(inwards)), onScreen([0.2, 0.1]));
  let after = await saved(page);
  assert.deepEqual(movedFrom(before, after), [inwards]);
  near(after.at(inwards), [0.2, 0.1]);
  assert.ok(!after.hull.includes(inwards));
  assert.ok((await page.picture()).differsFrom(picture) > 0, 'the picture has changed');
  before = after;

  // From the middle over the hull.
  await dragWithFinger(page, onScreen(before.at(inwards)), onScreen([-0.4, 0.68]));
  after = await saved(page);
  assert.deepEqual(movedFrom(before, after), [inwards]);
  near(after.at(inwards), [-0.4, 0.68]);
  assert.ok(after.hull.includes(inwards));
  before = after;

  // Another one, along the hull and over the first.
  const other = before.hull.find((v) => v !== inwards && Math.abs(before.at(v)[0]) < 0.7 && before.at(v)[1] < 0);
  await dragWithMouse(page, onScreen(before.at(other)), onScreen([-0.45, 0.75]));
  after = await saved(page);
  assert.deepEqual(movedFrom(before, after), [other]);
  assert.ok(after.hull.includes(other));

  // Beside the points, the pointer moves the picture.
  const [x, y] = onScreen([0.78, -0.78]);
  await dragWithMouse(page, [x, y], [x - 30, y - 20]);
  assert.deepEqual(movedFrom(after, await saved(page)), []);

  // All orbit again but one, which the pointer holds.
  await page.page.keyboard.press('f');
  await page.page.evaluate(() => document.activeElement.blur());
  await page.page.mouse.move(...onScreen(after.at(other)));
  await page.page.mouse.down();
  await page.page.keyboard.press('Space');
  await page.until('points that move', ({ state }) => state === 'moving');
  await page.page.mouse.move(...onScreen([0.6, 0.65]), { steps: 8 });
  await page.page.waitForTimeout(1000);
  await page.page.mouse.up();
  await page.page.keyboard.press('Space');
  await page.until('a pause', ({ state, status }) => state === 'paused' && status.startsWith('Every edge'));
  const moved = await saved(page);
  assert.ok(movedFrom(after, moved).length > 500, 'most have moved');
  near(moved.at(other), [0.6, 0.65], 0.1);
  await page.close();
});

test('a link opens the points, and the code for them runs', async () => {
  const page = await openEdgeflip(await startChromium());
  await page.page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  const clipboard = () => page.page.evaluate(() => navigator.clipboard.readText());
  await page.page.emulateMedia({ reducedMotion: 'reduce' });
  await page.choose('sample', 'moving points');
  await page.until('a still', ({ state, facts }) => state === 'paused' && facts.Points === '600');
  await page.page.click('#take');
  await page.page.click('#link');
  await page.page.locator('#away-says', { hasText: 'Link copied' }).waitFor();
  const link = await clipboard();
  await page.page.click('#code');
  await page.page.locator('#away-says', { hasText: 'Code copied' }).waitFor();
  const code = (await clipboard()).replace(/^import.*$/gm, '');
  const run = new Function('PointSession', `return (async () => { ${code} return [triangles, points]; })()`);
  const [triangles, points] = await run(PointSession);
  points.set([50, 0]);
  assert.deepEqual(triangles, (await triangulate(points)).triangles);
  await page.page.emulateMedia({ reducedMotion: null });
  await page.page.goto('about:blank');
  await page.page.goto(link);
  await page.until(
    'points that move',
    ({ state, caption }) => state === 'moving' && caption === 'Points that move freely',
  );
  await page.close();
});

test('the points of a file become a mesh, with their heights and their colours', async () => {
  const page = await sharedPage();
  const rows = Array.from({ length: 40 }, (_, i) => [(i * 7) % 23, (i * 11) % 40, (i % 5) / 8]);
  const csv = ['x,y,height', ...rows, rows[3], rows[9]].join('\n');
  const opened = await page.drop(file('hills.csv', csv), 'hills.csv');
  const positions = Float32Array.from([...rows, rows[3], rows[9]].flat());
  const want = await triangulate(positions, { stride: 3 });
  assert.deepEqual([opened.caption, opened.facts.Vertices], ['hills.csv', '42']);
  assert.match(opened.note, /Triangulated from 42 points by x and y\. 2 points repeat the x and y of others\./);
  // Heights do not count, and edges can be drawn.
  assert.match(opened.status, /^Already Delaunay\./);
  assert.equal(await page.page.isVisible('#draw'), true);
  const mesh = await page.download();
  assert.deepEqual([mesh.name, mesh.dimension], ['hills-after-0.off', 3]);
  assert.deepEqual([mesh.indices, Float32Array.from(mesh.positions)], [want.triangles, positions]);

  // In the plane there is nothing left to flip.
  const flat = rows.map(([x, y]) => `v ${x} ${y} 0`).join('\n');
  const { note, status, error } = await page.open(file('flat.obj', flat));
  assert.match(note, /^Every edge is Delaunay\. Triangulated from 40 points\. /);
  assert.equal(error, '');
  assert.match(status, /^Already Delaunay\./);
  assert.deepEqual((await page.download()).indices, (await triangulate(rows.map(([x, y]) => [x, y]))).triangles);

  // Colours are drawn, but not written.
  const header = [
    'ply',
    'format ascii 1.0',
    'element vertex 40',
    ...[...'xyz'].map((name) => `property float ${name}`),
  ];
  const channels = ['red', 'green', 'blue'].map((name) => `property uchar ${name}`);
  const lines = rows.map((row, i) => `${row.join(' ')} ${6 * i} 90 ${250 - 6 * i}`);
  await page.open(file('coloured.ply', [...header, ...channels, 'end_header', ...lines, ''].join('\n')));
  await page.page.locator('#surface-label').waitFor();
  assert.match((await page.look()).note, /Not kept: [^.]*\. Triangulated from 40 points by x and y\./);
  assert.equal((await page.download()).name, 'coloured-after-0.ply');

  // Points on a line have no triangle, and the mesh before stays.
  await (await page.page.$('#file')).setInputFiles(file('line.xyz', '0 0\n1 1\n2 2\n'));
  const seen = await page.until('a message', ({ error }) => error !== '');
  assert.match(seen.error, /^\s*line\.xyz: All points are on one line, so there is no triangle\./);
  assert.equal(seen.caption, 'coloured.ply');
  assert.match(await page.page.getAttribute('#file', 'accept'), /\.csv,\.xyz,/);
  await page.close();
});

test('a folder opens with its points if it has no mesh', async () => {
  const page = await sharedPage();
  file('survey/a.csv', 'x;y\n0;0\n4;0\n0;3\n4;4\n');
  const drop = async (caption) => {
    await page.dropPaths([join(folder, 'survey')]);
    await page.until(caption, (seen) => seen.caption === caption);
    return page.rest();
  };
  const { facts } = await drop('a.csv');
  assert.deepEqual([facts.Vertices, facts.Triangles], ['4', '2']);
  file('survey/mesh.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n');
  const { note } = await drop('mesh.obj');
  assert.doesNotMatch(note, /not opened/);
  await page.close();
});
