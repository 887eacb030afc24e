// Tests that triangles of a mesh in the plane which have turned over become positive again, in Node: on one thread and on
// several, in all entries. The module that does it is loaded when a mesh needs it.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import Delaunator from 'delaunator';
import * as here from 'edgeflip';
import * as inline from 'edgeflip/inline';
import { delaunayGeometry } from 'edgeflip/three';
import * as away from 'edgeflip/worker';
import { BufferAttribute, BufferGeometry } from 'three';
import { Digest } from '../parity/digest.js';
import { faultOf, sheet } from './folds.mjs';
import { frames, MOTIONS, same } from './motions.mjs';

const bytesOf = (name) => readFileSync(new URL(`../../dist/wasm/${name}_bg.wasm`, import.meta.url));
const onCpu = { backend: 'cpu', threads: 1 };
/** Large enough for several threads. */
const LARGE = 186;

/** A square with a vertex at (x, y), and one that may have been dragged across an edge. */
const square = (x, y) => ({
  positions: new Float32Array([0, 0, 4, 0, 4, 4, 0, 4, 1, 1, x, y]),
  indices: new Uint32Array([0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 5, 0, 4, 5, 4, 3, 5]),
  dimension: 2,
});

/** The same with a vertex at (2, 2), on the edge from 0 to 5, or at (2, 1). */
const over = (y = 3) => {
  const mesh = square(3, y);
  mesh.positions.set([2, y === 3 ? 2 : 1], 8);
  return mesh;
};

/** The result without times. */
const timeless = ({ timings, ...result }) => result;

// First, because later tests load the module.
test('without the module, a call that needs it fails and changes nothing', async () => {
  for (const [entry, threads] of [
    [here, 1],
    [here, 2],
    [away, 1],
  ]) {
    const base = 'file:///nowhere/';
    const [core, threaded, audit] = ['edgeflip', 'edgeflip_threads', 'edgeflip_audit'].map(bytesOf);
    await entry.init({ base, core, threads: threaded, audit });
    const { mesh, jump } = sheet(threads === 1 ? 12 : LARGE);
    const [session, other] = [
      await entry.FlipSession.create(mesh, { ...onCpu, threads }),
      await entry.FlipSession.create(mesh, { ...onCpu, threads, untangle: false }),
    ];
    const [near, far] = [jump(8), jump(90)];
    // Without folds, nothing is missing.
    for (const each of [session, other]) {
      await each.setPositions(near);
      await each.step();
    }
    const failure = {
      name: 'EdgeflipError',
      code: 'load-failed',
      message:
        /^edgeflip_untangle_bg\.wasm could not be loaded from file:.*serve the package's dist\/wasm\/edgeflip_untangle_bg\.wasm there, or pass init the URL or the bytes of it$/,
    };
    await assert.rejects(session.setPositions(far), failure);
    assert.deepEqual(timeless(await session.result()), timeless(await other.result()));
    assert.deepEqual(timeless(await session.run()), timeless(await other.run()));
    // The same holds at the end of a motion. Updates untangle without the module, but not a vertex outside.
    const outside = far.slice();
    outside[2 * (Math.sqrt(far.length / 2) + 1)] = -9;
    for (const [positions, isLeft] of [
      [far, false],
      [outside, true],
    ]) {
      for (let i = 0; i < 9; i++) session.update({ positions, iterations: 64 });
      assert.equal((await session.counters()).inverted > 0, isLeft);
    }
    const [triangles, counters] = [await session.triangles(), await session.counters()];
    await assert.rejects(session.run(), failure);
    await assert.rejects(session.verify(), failure);
    assert.deepEqual(await session.triangles(), triangles);
    assert.deepEqual(await session.counters(), counters);
    await assert.rejects(entry.makeDelaunay(square(3, 2), { ...onCpu, untangle: true }), failure);
    // A component of each orientation is no fold.
    const first = square(0.25, 2);
    const positions = Float32Array.of(...first.positions, ...first.positions.map((x, i) => (i % 2 ? x : -x - 9)));
    const indices = Uint32Array.of(...first.indices, ...first.indices.map((v) => v + 6));
    const both = await entry.FlipSession.create({ positions, indices, dimension: 2 }, onCpu);
    await both.setPositions(positions.map((x) => 2 * x));
    assert.equal((await both.run()).inverted, 0);
    both.free();
    if (entry === here && threads === 1) {
      session.free();
      other.free();
      continue;
    }
    await entry.init({ untangle: bytesOf('edgeflip_untangle') });
    // A session that begins without an edge needs the module, although nothing folds.
    const lacking = await entry.FlipSession.create(over(), {
      ...onCpu,
      lockedEdges: [1, 4, 4, 0, 5, 0],
      untangle: true,
    });
    assert.deepEqual([...(await lacking.run()).lostEdges], [0, 5]);
    await lacking.setPositions(over(3.5).positions);
    assert.equal((await lacking.run()).lostEdges.length, 0);
    lacking.free();
    await session.setPositions(far);
    const { inverted, flat, indices: after } = await session.run();
    assert.deepEqual([inverted, flat], [0, 0]);
    assert.equal(faultOf(far, after), undefined);
    session.free();
    other.free();
  }
  const base = new URL('../../dist/wasm/', import.meta.url).href;
  for (const entry of [here, away]) await entry.init({ base });
  await inline.init();
});

test('whatever way the vertices went, the mesh is Delaunay again', async () => {
  for (const { FlipSession } of [here, inline, away]) {
    for (const order of ['reproducible', 'any']) {
      const { mesh, jump } = sheet(16);
      const session = await FlipSession.create(mesh, { ...onCpu, order });
      const other = await FlipSession.create(mesh, { ...onCpu, order, untangle: false });
      let folds = 0;
      const calls = ['run', 'step', 'result', 'verify', 'problems', 'edgeStates'];
      for (const [i, most] of [10, 30, 60, 120, 400, 1000].entries()) {
        let positions = jump(most);
        for (const each of [session, other]) each.update({ positions, iterations: 64 });
        folds += (await other.counters()).inverted;
        // One update is enough after jumps of up to half the spacing.
        if (most <= 30) assert.equal(faultOf(positions, await session.triangles()), undefined);
        // Each of these calls ends the motion.
        await session[calls[i]]();
        assert.equal((await session.counters()).inverted, 0, calls[i]);
        await session.run();
        assert.equal(faultOf(positions, await session.triangles()), undefined);
        positions = jump(most);
        await session.setPositions(positions);
        const { indices, inverted, flat, remaining, lostEdges, hint } = await session.run();
        assert.deepEqual([inverted, flat, remaining, lostEdges, hint], [0, 0, {}, new Uint32Array(), undefined]);
        assert.equal(faultOf(positions, indices), undefined);
        const { clean, violations } = await session.verify();
        assert.deepEqual([clean, violations], [true, []]);
      }
      assert.ok(folds > 50, `${folds} folds`);
      session.free();
      other.free();
    }
  }
});

test('doubles, clockwise triangles and arrays with gaps', async () => {
  const { mesh, jump } = sheet(12);
  const interleaved = (positions, sign) =>
    Float64Array.from({ length: 3 + 2.5 * positions.length }, (_, i) => {
      const [v, k] = [Math.floor((i - 3) / 5), (i - 3) % 5];
      return i < 3 || k > 1 ? NaN : (k ? 1 : sign) * positions[2 * v + k] + 2 ** -40;
    });
  for (const sign of [1, -1]) {
    const positions = interleaved(mesh.positions, sign);
    const session = await here.FlipSession.create({ ...mesh, positions, stride: 5, offset: 3 }, onCpu);
    for (const most of [50, 500]) {
      const moved = jump(most);
      await session.setPositions(interleaved(moved, sign));
      const { indices, inverted, flat } = await session.run();
      assert.deepEqual([inverted, flat], [0, 0]);
      assert.equal(faultOf(moved, indices), undefined);
    }
    session.free();
  }
});

// tests/native/folds.rs has the same digest.
test('the triangles are those of the library in Rust, on any number of threads', async () => {
  const found = [];
  for (const threads of [1, 2]) {
    const { mesh, jump } = sheet(LARGE);
    const lockedEdges = mesh.indices.filter((_, i) => i % 33 < 2);
    const session = await here.FlipSession.create(mesh, { ...onCpu, threads, lockedEdges });
    const digest = new Digest(mesh.indices);
    const results = [];
    for (const most of [20, 90]) {
      await session.setPositions(jump(most));
      const { threads: ran, ...result } = timeless(await session.run());
      assert.equal(ran, threads);
      digest.feed(result.indices);
      digest.feed(result.lostEdges);
      results.push(result);
    }
    assert.ok(results[1].lostEdges.length > 0 && results[1].inverted === 0);
    found.push({ results, digest: `${digest}` });
    session.free();
  }
  assert.deepEqual(found[1], found[0]);
  assert.equal(found[0].digest, 'ccd193cd60795706');
});

test('updates give the same triangles on any number of threads', async () => {
  const motions = { entry: 'edgeflip', names: ['jump', 'stir'], size: 140, count: 2 };
  const expected = await frames({ ...motions, options: onCpu });
  await same(await frames({ ...motions, options: { ...onCpu, threads: 2 } }), expected, 'two threads');
  // In a worker and inline too.
  const small = { names: MOTIONS, size: 8, count: 40 };
  const onOne = await frames({ entry: 'edgeflip', ...small, options: onCpu });
  for (const entry of ['edgeflip/worker', 'edgeflip/inline']) {
    await same(await frames({ entry, ...small, options: onCpu }), onOne, entry);
  }
});

test('the option says when', async () => {
  // Vertex 5 is on the other side of the edge from 4 to 0.
  const folded = square(3, 2);
  for (const [untangle, atStart, after] of [
    [undefined, true, false],
    [true, false, false],
    [false, true, true],
  ]) {
    for (const { FlipSession, makeDelaunay } of [here, inline, away]) {
      const session = await FlipSession.create(folded, { ...onCpu, untangle });
      const first = await session.run();
      assert.equal(first.inverted > 0, atStart);
      assert.deepEqual(timeless(await makeDelaunay(folded, { ...onCpu, untangle })), timeless(first));
      const advice = /^Triangles that are turned over: \d\..* untangle: true does, where the positions have a triang/;
      if (atStart) assert.match(first.hint, advice);
      else assert.equal(first.hint, undefined);
      assert.equal((await session.verify()).clean, !atStart);
      await session.setPositions(folded.positions);
      assert.equal((await session.run()).inverted > 0, after);
      session.free();
    }
  }
});

test('what cannot be untangled is refused, in words', async () => {
  const space = { positions: new Float32Array(9), indices: [0, 1, 2], dimension: 3 };
  const refused = { code: 'invalid-option', message: /^option untangle: only a mesh of dimension 2 can be untangled$/ };
  for (const { makeDelaunay } of [here, away]) {
    await assert.rejects(makeDelaunay(space, { ...onCpu, untangle: true }), refused);
    assert.equal((await makeDelaunay(space, { ...onCpu, untangle: false })).flat, 1);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(space.positions, 3));
  await assert.rejects(delaunayGeometry(geometry, { ...onCpu, untangle: true }), refused);
  await here.init();
  assert.throws(() => here.makeDelaunaySync(square(1, 3), { untangle: true }), {
    message: /^untangle is not an option; /,
  });
  await assert.rejects(here.makeDelaunay(square(1, 3), { untangle: 1 }), {
    message: 'option untangle: 1 is not true or false',
  });
});

test('positions without a triangulation keep folds, and the advice says so', async () => {
  const session = await here.FlipSession.create(square(1, 3), onCpu);
  await session.setPositions(square(9, 2).positions);
  const { inverted, hint } = await session.run();
  assert.ok(inverted > 0);
  assert.match(hint, /no triangulation of these positions was found: problems says why/);
  assert.deepEqual([...(await session.problems()).outside], [5]);
  await session.setPositions(square(3, 2).positions);
  assert.equal((await session.run()).inverted, 0);
  session.free();
});

test('a locked edge through a vertex is lost and comes back; constraints come in later and stay', async () => {
  for (const threads of [1, 2]) {
    const at = (x, y) => {
      const mesh = square(x, y);
      mesh.positions.set([2, 1], 8);
      return mesh;
    };
    // The edge from 0 to 5 would go through vertex 4.
    const through = at(3, 3);
    through.positions[9] = 2;
    const options = { ...onCpu, lockedEdges: [1, 4, 4, 0, 5, 0], constraints: [4, 5], untangle: true };
    const session = await here.FlipSession.create(through, { ...options, threads });
    const check = async (...lost) => {
      const { inverted, flat, lostEdges, leftOut } = await session.run();
      assert.deepEqual([inverted, flat, [...lostEdges], leftOut], [0, 0, lost, []]);
      const { clean, violations } = await session.verify();
      assert.deepEqual([clean, violations], [true, []]);
      const { v1, v2 } = await session.edges();
      const edges = Array.from(v1, (v, i) => [v, v2[i]].sort((u, v) => u - v).join());
      assert.ok(edges.includes('4,5'));
      assert.equal(edges.includes('0,5'), lost.length === 0);
    };
    await check(0, 5);
    await session.setPositions(at(3, 3).positions);
    await check();
    await session.setPositions(through.positions);
    await check(0, 5);
    await session.setPositions(at(3, 3.5).positions);
    await check();
    session.free();
  }
});

test('locked triangles and groups keep their borders, and constraints come into a mesh that was folded', async () => {
  const { mesh, jump } = sheet(10);
  const positions = jump(70);
  const groups = Uint32Array.from({ length: mesh.indices.length / 3 }, (_, t) => Number(t > 80));
  for (const options of [{ groups }, { lockedTriangles: [40, 41] }, { constraints: [11, 88], skipConstraints: true }]) {
    const session = await here.FlipSession.create({ ...mesh, positions }, { ...onCpu, ...options, untangle: true });
    const { inverted, flat, leftOut } = await session.run();
    assert.deepEqual([inverted, flat, leftOut], [0, 0, []]);
    const { clean, violations } = await session.verify();
    assert.deepEqual([clean, violations], [true, []]);
    session.free();
  }
  // Without it, the constraint meets a triangle that is turned over.
  await assert.rejects(here.makeDelaunay({ ...mesh, positions }, { ...onCpu, constraints: [11, 88] }), {
    code: 'invalid-option',
    message:
      /^option constraints: constraint 0 between 11 and 88 crosses triangle \d+, which is flat or turned over; untangle may mend that$/,
  });
  await assert.rejects(here.makeDelaunay({ ...mesh, positions }, { ...onCpu, lockedEdges: [0, 99], untangle: true }), {
    code: 'invalid-option',
    message: 'option lockedEdges: the mesh has no edge between vertices 0 and 99',
  });
  await assert.rejects(here.makeDelaunay({ ...mesh, positions }, { ...onCpu, lockedEdges: [0], untangle: true }), {
    code: 'ragged-array',
  });
});

test('with weld, the corners keep vertices at their positions', async () => {
  const { mesh, jump } = sheet(8);
  const positions = (points) => Float32Array.from([...mesh.indices].flatMap((v) => [points[2 * v], points[2 * v + 1]]));
  const corners = { positions: positions(mesh.positions), indices: mesh.indices.map((_, i) => i), dimension: 2 };
  const session = await here.FlipSession.create(corners, { ...onCpu, weld: true });
  const moved = jump(70);
  await session.setPositions(positions(moved));
  const { indices, inverted, flat } = await session.run();
  assert.deepEqual([inverted, flat], [0, 0]);
  assert.equal(
    faultOf(
      moved,
      indices.map((corner) => mesh.indices[corner]),
    ),
    undefined,
  );
  session.free();
});

test('with weld and attributes, a lost seam is refused until it is there again', async () => {
  const mesh = square(0.25, 2);
  const at = (...points) => {
    const positions = mesh.positions.slice();
    positions.set(points, 8);
    return Float32Array.from([...mesh.indices].flatMap((v) => [positions[2 * v], positions[2 * v + 1]]));
  };
  const positions = at(2, 1, 0.25, 2);
  // The triangle at the left has other attributes, so the edges from 0 and 3 to 5 are a seam.
  const attribute = mesh.indices.map((_, corner) => Number(Math.floor(corner / 3) === 3));
  const corners = { positions, indices: mesh.indices.map((_, i) => i), dimension: 2 };
  const session = await here.FlipSession.create(corners, { ...onCpu, weld: [attribute] });
  const check = async () => {
    const { indices, inverted, seamEdges } = await session.run();
    assert.deepEqual([inverted, seamEdges], [0, 2]);
    const other = Array.from({ length: 6 }, (_, t) => [...indices.subarray(3 * t, 3 * t + 3)]).filter((triangle) =>
      triangle.some((corner) => attribute[corner]),
    );
    assert.deepEqual(
      other.map((triangle) => triangle.map((corner) => mesh.indices[corner]).sort()),
      [[0, 3, 5]],
    );
  };
  await check();
  // The edge from 0 to 5 would go through vertex 4.
  await session.setPositions(at(2, 2, 3, 3));
  await assert.rejects(session.run(), {
    code: 'invalid-option',
    message: /an edge along a seam has flipped|triangle \d+ cannot/,
  });
  await session.setPositions(at(2, 1, 0.5, 3));
  await check();
  session.free();
});

test('points in a convex ring give the triangles of delaunator', async () => {
  const count = 60;
  const ring = Array.from({ length: 24 }, (_, i) => [Math.cos((i * Math.PI) / 12), Math.sin((i * Math.PI) / 12)]);
  let seed = 7;
  const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
  const points = () =>
    Float64Array.from([
      ...ring.flat(),
      ...Array.from({ length: count }, () => [2 * Math.PI * random(), 0.9 * Math.sqrt(random())]).flatMap(([a, r]) => [
        r * Math.cos(a),
        r * Math.sin(a),
      ]),
    ]);
  const setOf = (indices) =>
    new Set(
      Array.from({ length: indices.length / 3 }, (_, t) => {
        const triangle = [...indices.subarray(3 * t, 3 * t + 3)];
        const first = triangle.indexOf(Math.min(...triangle));
        return [0, 1, 2].map((k) => triangle[(first + k) % 3]).join();
      }),
    );
  const positions = points();
  const indices = new Delaunator(positions).triangles.toReversed();
  const session = await here.FlipSession.create({ positions, indices, dimension: 2 }, onCpu);
  for (let frame = 0; frame < 20; frame++) {
    const moved = points();
    await session.setPositions(moved);
    const { indices: ours } = await session.run();
    assert.deepEqual(setOf(ours.toReversed()), setOf(new Delaunator(moved).triangles));
  }
  session.free();
});
