// Tests what the playground and the first figure of the section "How a mesh becomes Delaunay" compute, without a browser.

import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { EDGE_STATES, FlipSession } from 'edgeflip';
import { build } from 'esbuild';

const folder = mkdtempSync(fileURLToPath(new URL('../../target/playground-', import.meta.url)));
after(() => rmSync(folder, { recursive: true }));

/** A file of the section. */
async function load(name) {
  const outfile = join(folder, `${name}.mjs`);
  const entry = fileURLToPath(new URL(`../../www/explain/${name}.ts`, import.meta.url));
  await build({ entryPoints: [entry], outfile, bundle: true, format: 'esm', external: ['edgeflip'], target: 'es2022' });
  return import(pathToFileURL(outfile));
}

/** Numbers from 0 to 1, always the same ones. */
function randomNumbers(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** Adds, moves and removes points at random, and calls back after each edit. In a small range, many are on one line. */
function edit({ withMoved, withoutPoint, withPoint }, random, range, edits, changed) {
  let planar = { points: [], triangles: [] };
  let anew = 0;
  for (let i = 0; i < edits; i++) {
    const { points } = planar;
    const place = [0, 1].map(() => Math.floor(random() * range));
    const [action, v] = [random(), Math.floor(random() * points.length)];
    const isFree = points.every(([x, y], other) => (other === v && action > 0.65) || x !== place[0] || y !== place[1]);
    if (action < 0.5 && points.length < 40 && isFree) planar = withPoint(planar, place);
    else if (action > 0.5 && action < 0.65 && points.length > 0) planar = withoutPoint(planar, v);
    else if (action > 0.65 && points.length > 0 && isFree) {
      const moved = withMoved(planar, v, place);
      planar = moved.planar;
      anew += moved.isJoinedAnew;
    } else continue;
    changed(planar);
  }
  return { planar, anew };
}

test('edits keep the triangles a triangulation of the outline', async () => {
  const planarModule = await load('planar');
  const random = randomNumbers(12345);
  let anew = 0;
  for (let trial = 0; trial < 80; trial++) {
    const changed = (planar) => assert.ok(planarModule.isTriangulation(planar), JSON.stringify(planar));
    anew += edit(planarModule, random, [4, 8, 30, 640][trial % 4], 60, changed).anew;
  }
  assert.ok(anew > 100, 'moves over an edge occur');
});

test('a link that joins the points in another way is no triangulation', async () => {
  const { isTriangulation, planarOf } = await load('planar');
  const points = [
    [0, 0],
    [100, 0],
    [100, 100],
    [0, 100],
  ];
  const { triangles } = planarOf(points);
  assert.ok(isTriangulation({ points, triangles }));
  for (const wrong of [
    [],
    [0, 1, 2],
    [0, 2, 1, 0, 3, 2],
    [0, 1, 2, 0, 1, 3],
    [0, 1, 2, 0, 2, 9],
    [0, 1, 2, 0, 2, -1],
  ]) {
    assert.equal(isTriangulation({ points, triangles: wrong }), false, `${wrong}`);
  }
});

test('each round labels, selects and flips as the engine does', async () => {
  const planarModule = await load('planar');
  const { runOf, relinked } = await load('phases');
  const random = randomNumbers(54321);
  let flipped = 0;
  for (let trial = 0; trial < 24; trial++) {
    const { planar } = edit(planarModule, random, [30, 640][trial % 2], 60, () => {});
    if (planar.triangles.length === 0) continue;
    const mesh = { positions: Float64Array.from(planar.points.flat()), indices: planar.triangles, dimension: 2 };
    const session = await FlipSession.create(mesh, { backend: 'cpu', threads: 1 });
    for (const round of runOf(planar)) {
      const states = [...(await session.edgeStates())].map((state) => EDGE_STATES[state]);
      for (const edge of round.inner) {
        const state = edge.rank === 0 ? 'delaunay' : round.flips.includes(edge) ? 'flips' : 'waits';
        for (const half of edge.halves) assert.equal(states[half], state);
      }
      const iteration = await session.step();
      assert.equal(iteration?.flips ?? 0, round.flips.length);
      if (!iteration) break;
      assert.deepEqual([...(await session.triangles())], round.after);
      // A flip moves two sides to the other triangle; on the outline nobody has to learn of it.
      assert.ok(relinked(round).length <= 4 * round.flips.length);
      flipped += round.flips.length;
    }
    session.free();
  }
  assert.ok(flipped > 100, `${flipped} flips`);
});

test('the errors of the first figure vanish on a fine mesh, and grow as triangles get thin', async () => {
  const { contours, heat, rasterOf, shading, slopesOf } = await load('why-measures');
  const { fine, healed, round, thinned } = await load('why-mesh');
  const errors = (mesh) => {
    const { error } = shading(mesh, rasterOf(mesh, 120, 90), slopesOf(120, 90));
    return [error, contours(mesh, [35, 70, 105]).error];
  };
  const [light, line] = errors(fine());
  assert.ok(light < 0.2 && line < 0.01, `${light}° and ${line} %`);
  const best = await round();
  const thin = thinned(best, 300);
  const before = [...errors(thin), heat(thin).error];
  const now = [...errors(best), heat(best).error];
  for (const [i, error] of before.entries()) assert.ok(error > 1.2 * now[i], `${error} and ${now[i]}`);
  assert.ok(heat(thin).backwards > 0);
  assert.equal(heat(best).backwards, 0);
  const again = await healed(thin);
  assert.equal(heat(again).error.toFixed(6), heat(best).error.toFixed(6));
});
