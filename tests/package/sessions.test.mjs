// Sessions that get any calls, right and wrong ones, without waiting for the answers, in Node. Each answer is that of a
// session whose calls wait for each other, and a result that is wrong says so. `EDGEFLIP_CASES` is the number of sessions,
// `EDGEFLIP_SEED` the first. tests/native/untangle/sessions.rs does the same natively, with more kinds of meshes.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import Delaunator from 'delaunator';
import { FlipSession } from 'edgeflip';
import { full } from '../full.mjs';

const CASES = Number(process.env.EDGEFLIP_CASES ?? (full ? 2000 : 60));
const SEED = Number(process.env.EDGEFLIP_SEED ?? 1);
/** Points have integer coordinates below this, so that doubles decide exactly. */
const SIZE = 64;

/** A generator of integers from 0 to below `end`. */
function generator(seed) {
  let state = Math.imul(seed, 0x9e3779b1) >>> 0;
  return (end) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * end);
  };
}

/** A triangulation of random points, some with holes. */
function meshOf(below) {
  const points = new Set();
  while (points.size < 12) points.add(below(SIZE) * SIZE + below(SIZE));
  const positions = Float32Array.from([...points].flatMap((point) => [Math.floor(point / SIZE), point % SIZE]));
  const all = new Delaunator(positions).triangles;
  const holes = below(2) * 10;
  const isKept = Array.from({ length: all.length / 3 }, () => below(100) >= holes);
  const indices = all.filter((_, h) => isKept[Math.floor(h / 3)]);
  return { positions, indices, dimension: 2 };
}

/** Other positions: some points jump, all go to one, or some have a number that is not finite. */
function moved(rest, below) {
  const positions = rest.slice();
  const [kind, part] = [below(12), 1 + below(4)];
  for (let v = 0; v < positions.length / 2; v++) {
    if (kind === 0) positions.set([7, 7], 2 * v);
    else if (below(4) < part - 1) positions.set([below(SIZE), below(SIZE)], 2 * v);
  }
  if (kind === 1) positions[below(positions.length)] = [Number.NaN, Infinity][below(2)];
  return positions;
}

/** A call of a session, and what it is called in a failure. No run: others may come between its iterations. */
function callOf(rest, below) {
  const positions = below(4) ? moved(rest, below) : rest;
  const iterations = [0, 1, 64, 65][below(4)];
  const given = below(3) ? { positions, iterations } : { iterations };
  return [
    ['setPositions', (session) => session.setPositions(positions)],
    ['update', async (session) => session.update(given)],
    ['step', (session) => session.step()],
    ['result', (session) => session.result()],
    ['counters', (session) => session.counters()],
    ['problems', (session) => session.problems()],
    ['verify', (session) => session.verify()],
    ['edgeStates', (session) => session.edgeStates()],
    ['changes', (session) => session.changes()],
    ['setPositions of a wrong length', (session) => session.setPositions(positions.subarray(1))],
  ][below(10)];
}

/** What a call has answered, without times, or the code of its error. */
async function answerOf(promise) {
  try {
    const { timings, ms, ...answer } = Object((await promise) ?? {});
    return answer;
  } catch (error) {
    assert.equal(error.name, 'EdgeflipError', error.stack);
    return error.code;
  }
}

/** Half-edges without another one on the other side, in order. */
function boundaryOf(indices) {
  const sides = new Set();
  for (let h = 0; h < indices.length; h++) sides.add(`${indices[h]} ${indices[h % 3 === 2 ? h - 2 : h + 1]}`);
  return [...sides].filter((side) => !sides.has(side.split(' ').reverse().join(' '))).sort();
}

/** Whether two components have two vertices in common. Then one may need an edge that the other has. */
function areComponentsBound(indices) {
  const sides = new Map();
  const side = (h) => [indices[h], indices[h % 3 === 2 ? h - 2 : h + 1]];
  indices.forEach((_, h) => sides.set(side(h).join(' '), h));
  const components = [];
  const isFound = new Set();
  for (let first = 0; first < indices.length; first += 3) {
    const vertices = new Set();
    const open = [first];
    for (let t = open.pop(); t !== undefined; t = open.pop()) {
      if (isFound.has(t)) continue;
      isFound.add(t);
      for (let h = t; h < t + 3; h++) {
        vertices.add(indices[h]);
        const twin = sides.get(side(h).reverse().join(' '));
        if (twin !== undefined) open.push(twin - (twin % 3));
      }
    }
    if (vertices.size > 0) components.push(vertices);
  }
  const common = (one, other) => [...one].filter((v) => other.has(v)).length;
  return components.some((one, i) => components.slice(i + 1).some((other) => common(one, other) > 1));
}

const area = ([ax, ay], [bx, by], [cx, cy]) => (ax - cx) * (by - cy) - (ay - cy) * (bx - cx);

function inCircle(a, b, c, d) {
  const [p, q, r] = [a, b, c].map(([x, y]) => [x - d[0], y - d[1]]);
  const [size, cross] = [([x, y]) => x * x + y * y, (u, v) => u[0] * v[1] - u[1] * v[0]];
  return size(p) * cross(q, r) + size(q) * cross(r, p) + size(r) * cross(p, q);
}

/** Checks a result without triangles that are turned over or flat: the edges that are not Delaunay are those that remain. */
function checkRight(positions, { indices, remaining }, name) {
  const at = (h) => positions.subarray(2 * indices[h], 2 * indices[h] + 2);
  const [signs, apexes, wrong] = [[], new Map(), []];
  for (let h = 0; h < indices.length; h++) {
    const next = h % 3 === 2 ? h - 2 : h + 1;
    if (h % 3 === 0) signs.push(Math.sign(area(at(h), at(h + 1), at(h + 2))));
    apexes.set(`${indices[h]} ${indices[next]}`, [h, next, 3 * Math.floor(h / 3) + ((h + 2) % 3)]);
  }
  assert.ok(!signs.includes(0), `${name}: a triangle is flat`);
  for (const [side, [h, next, apex]] of apexes) {
    const across = apexes.get(side.split(' ').reverse().join(' '));
    if (!across) continue;
    const sign = signs[Math.floor(h / 3)];
    assert.equal(signs[Math.floor(across[0] / 3)], sign, `${name}: a triangle is turned over`);
    if (inCircle(at(h), at(next), at(apex), at(across[2])) * sign > 0) wrong.push(side);
  }
  // Each edge has two sides. No edge is locked, and no run ends early.
  const { duplicate = 0, ...others } = remaining;
  assert.deepEqual(others, {}, name);
  assert.equal(wrong.length, 2 * duplicate, `${name}: ${wrong} are not Delaunay`);
}

async function play(seed) {
  const below = generator(seed);
  const mesh = meshOf(below);
  const boundary = boundaryOf(mesh.indices);
  const options = { backend: 'cpu', threads: 1, order: ['any', 'reproducible'][below(2)], untangle: below(3) > 0 };
  const [tested, waiting] = [await FlipSession.create(mesh, options), await FlipSession.create(mesh, options)];
  let right = 0;
  for (let burst = 0; burst < 4; burst++) {
    const calls = Array.from({ length: 1 + below(6) }, () => callOf(mesh.positions, below));
    const name = `seed ${seed}, burst ${burst}: ${calls.map(([name]) => name)}`;
    const answers = calls.map(([, call]) => answerOf(call(tested)));
    const expected = [];
    for (const [, call] of calls) expected.push(await answerOf(call(waiting)));
    assert.deepEqual(await Promise.all(answers), expected, name);
    const goal = moved(mesh.positions, below);
    const last = [];
    for (const session of [tested, waiting]) {
      await answerOf(session.setPositions(goal.every(Number.isFinite) ? goal : mesh.positions));
      last.push({ ...(await session.run()), problems: await session.problems() });
    }
    const [one, other] = last.map(({ timings, ...result }) => result);
    assert.deepEqual(one, other, name);
    assert.deepEqual(boundaryOf(one.indices), boundary, name);
    const { outside, coincident, crossing } = one.problems;
    const isPossible = outside.length + coincident.length + crossing.length === 0;
    if (one.inverted + one.flat === 0 && isPossible) {
      checkRight(goal.every(Number.isFinite) ? goal : mesh.positions, one, name);
      right++;
    }
    const isRight = one.inverted + one.flat === 0 || areComponentsBound(one.indices);
    assert.ok(!(isPossible && options.untangle) || isRight, name);
  }
  // Freed in the middle of a motion, with calls on the way.
  tested.update({ positions: moved(mesh.positions, below), iterations: 1 });
  const late = [answerOf(tested.run()), answerOf(tested.counters())];
  tested.free();
  await Promise.all(late);
  assert.equal(await answerOf(tested.run()), 'freed');
  waiting.free();
  return right;
}

test('sessions whose calls do not wait never hide what is wrong', async () => {
  let right = 0;
  for (let seed = SEED; seed < SEED + CASES; seed++) right += await play(seed);
  console.log(`${right} right results`);
  assert.ok(right > CASES / 2);
});
