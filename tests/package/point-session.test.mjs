// Points that move, come and go, in Node: after each call, a session has the triangles that `triangulate` makes of the
// present points.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { test } from 'node:test';
import { init, PointSession, triangulateSync } from 'edgeflip/points';
import { KINDS, randomOf, refused } from './points.mjs';

await init();

/** Compares a session with the triangulation of the points that are not `undefined`. */
function check(session, points) {
  const present = [...points.keys()].filter((i) => points[i]);
  const { triangles, twins, hull, duplicates, hint } = triangulateSync(present.map((i) => points[i]));
  const own = (words) => Uint32Array.from(words, (word) => present[word]);
  const found = session.triangulation();
  const expected = { triangles: own(triangles), twins, hull: own(hull), duplicates: own(duplicates), hint };
  for (const [name, value] of Object.entries(expected)) assert.deepEqual(found[name], value, name);
  assert.deepEqual(session.triangles(), found.triangles);
  assert.deepEqual(session.hull(), found.hull);
  assert.equal(session.length, points.length);
}

for (const [name, kind] of Object.entries(KINDS)) {
  test(`every call leaves the triangulation of the points: ${name}`, async () => {
    const random = randomOf(name.length);
    for (let round = 0; round < 8; round++) {
      const points = kind(random(80), random);
      const session = await PointSession.create(points);
      for (let call = 0; call < 30; call++) {
        const [fresh] = kind(1, random);
        const index = random(points.length + 1);
        const what = random(5);
        if (what === 0) {
          assert.equal(session.add(...fresh), points.length);
          points.push(fresh);
        } else if (what === 1) {
          assert.equal(session.remove(index), points[index] !== undefined);
          if (index < points.length) points[index] = undefined;
        } else if (what === 2 && points[index]) {
          session.moveTo(index, ...fresh);
          points[index] = fresh;
        } else if (what === 3) {
          const step = 1 + random(3);
          for (const [i, point] of points.entries()) if (point) points[i] = point.map((x) => x + random(step));
          session.update(points.map((point) => point ?? [Number.NaN, 0]));
        } else {
          const [x, y] = fresh.map((x) => x + random(3));
          const distance = (i) => (BigInt(points[i][0]) - BigInt(x)) ** 2n + (BigInt(points[i][1]) - BigInt(y)) ** 2n;
          const present = [...points.keys()].filter((i) => points[i]);
          const nearest = present.reduce((i, j) => (i === undefined || distance(j) < distance(i) ? j : i), undefined);
          assert.equal(session.nearest(x, y), nearest);
          const around = session.locate(x, y);
          if (around) assert.ok(session.triangles().some((_, h, all) => `${all.subarray(h, h + 3)}` === `${around}`));
        }
        check(session, points);
      }
      session.free();
    }
  });
}

test('points move in every form in which they came', async () => {
  const numbers = Float32Array.of(0, 0, 9, 4, 0, 9, 4, 3, 9, 0, 3, 9);
  const spaced = await PointSession.create(numbers, { stride: 3 });
  spaced.update(Float64Array.of(0, 0, 9, 4, 0, 9, 4, 3.5, 9, 0, 3, 9));
  const named = await PointSession.create([{ at: 0 }, { at: 1 }, { at: 2 }], {
    x: ({ at }) => at,
    y: ({ at }) => at * at,
  });
  named.update([{ at: 3 }, { at: 1 }, { at: 2 }]);
  assert.deepEqual([spaced.triangles().length, [...named.triangles()]], [6, [0, 1, 2]]);
  assert.deepEqual(named.locate(2, 4.5), [0, 1, 2]);
  assert.equal(named.locate(9, 9), undefined);
  assert.throws(
    () => named.update([{ at: 3 }, { at: 1 }]),
    refused('position-count', /^points has 4 numbers, but the points of the session take 6$/),
  );
  assert.throws(() => spaced.update([[0, 1]]), refused('invalid-option', /stride: it is for an array of numbers/));
  const failing = new Error('of the caller');
  const read = (item) => {
    if (item === 'fail') throw failing;
    return item;
  };
  const squares = await PointSession.create([1, 2, 3], { x: read, y: (item) => read(item) ** 2 });
  assert.throws(() => squares.update([4, 'fail', 6]), failing);
  assert.equal(squares.nearest(0, 0), 0);
  squares.update([6, 5, 4]);
  assert.equal(squares.nearest(0, 0), 2);
});

test('calls that are refused change nothing', async () => {
  const session = await PointSession.create([0, 0, 4, 0, 4, 3, 0, 3]);
  const before = session.triangulation();
  assert.throws(() => session.add(Number.NaN, 0), refused('non-finite', /^point 4: coordinate x is NaN/));
  assert.throws(() => session.moveTo(2, 0, Number.POSITIVE_INFINITY), refused('non-finite', /point 2: coordinate y/));
  assert.throws(() => session.moveTo(4, 0, 0), refused('invalid-input', /^there is no point 4$/));
  assert.throws(() => session.moveTo(0.5, 0, 0), refused('invalid-input', /index: 0.5 is not a whole number/));
  assert.throws(() => session.remove(-1), refused('invalid-input', /index: -1/));
  assert.throws(() => session.add('1', 0), refused('invalid-input', /x: '1' is not a number/));
  assert.throws(() => session.locate(0), refused('invalid-input', /y: undefined is not a number/));
  assert.throws(() => session.update([0, 0, 1]), refused('ragged-array', /points/));
  assert.throws(() => session.update([0, 0, 4, 0, 4, Number.NaN, 0, 3]), refused('non-finite', /point 2/));
  assert.deepEqual([session.locate(Number.NaN, 0), session.nearest(0, -Infinity)], [undefined, undefined]);
  assert.deepEqual(session.triangulation(), before);
  await assert.rejects(PointSession.create([0, Number.NaN]), refused('non-finite', /point 0/));
  await assert.rejects(PointSession.create([0, 0], { threads: 1 }), refused('invalid-option', /threads/));
  // As `using` does.
  session[Symbol.dispose]();
  session.free();
  for (const call of [() => session.triangles(), () => session.length, () => session.add(0, 0)]) {
    assert.throws(call, refused('freed', /has been freed/));
  }
});

test('many points move by little, far, and alone', async () => {
  const random = randomOf(3);
  const float = () => random(2 ** 30) / 2 ** 30;
  const points = Array.from({ length: 20_000 }, () => [float(), float()]);
  const session = await PointSession.create(points);
  for (const size of [1e-4, 1e-3, 1e-2, 1]) {
    for (const [i, [x, y]] of points.entries()) points[i] = [x + size * (float() - 0.5), y + size * (float() - 0.5)];
    session.update(points);
    check(session, points);
    for (let i = 0; i < 300; i++) points[random(points.length)] = [3 * float() - 1, 3 * float() - 1];
    session.update(points);
    check(session, points);
  }
});

test('sessions fill the memory, and others still work', () => {
  const program = `import { PointSession } from 'edgeflip/points';
    const points = Float64Array.from({ length: 4e6 }, Math.random);
    const sessions = [];
    let code;
    while (code === undefined && sessions.length < 60) {
      try { sessions.push(await PointSession.create(points)); } catch (error) { code = error.code; }
    }
    try { for (let i = 0; i < 9; i++) sessions[0].triangulation(); } catch (error) { console.log(error.code); }
    sessions.pop().free();
    const again = await PointSession.create(points.subarray(0, 2e5));
    console.log(code, sessions.length > 1, sessions[0].triangles().length === sessions[1].triangles().length, again.length);`;
  const { stdout, stderr } = spawnSync(process.execPath, ['--input-type=module', '-e', program], { encoding: 'utf8' });
  assert.equal(stdout, 'too-large true true 100000\n', stderr);
});
