// Tests that a result counts the triangles that are turned over or flat, says what to do, and that `verify` lists them.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { FlipSession, init, makeDelaunay, makeDelaunaySync } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { delaunayGeometry } from 'edgeflip/three';
import * as worker from 'edgeflip/worker';
import { BufferAttribute, BufferGeometry } from 'three';

const onCpu = { backend: 'cpu' };

/** A square whose middle vertex is at `x`: left of 0, it lies outside. */
const square = (x) => ({
  positions: new Float32Array([0, 0, 4, 0, 4, 4, 0, 4, x, 2]),
  indices: new Uint32Array([0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4]),
  dimension: 2,
});

/** Vertices 4 and 5 are at the same position. */
const needle = (dimension) => {
  const points = [0, 0, 2, 0, 2, 2, 0, 2, 1, 1, 1, 1];
  const lifted = points.flatMap((x, i) => (i % 2 && dimension === 3 ? [x, 0] : [x]));
  const indices = new Uint32Array([0, 1, 4, 1, 2, 5, 4, 1, 5, 2, 3, 5, 3, 0, 4, 4, 5, 3]);
  return { positions: new Float32Array(lifted), indices, dimension };
};

test('inverted and flat triangles are counted, with advice', async () => {
  await init();
  for (const [mesh, counts, hint] of [
    [square(2), [0, 0], undefined],
    [
      square(-1),
      [1, 0],
      /^Triangles that are turned over: 1\. .*untangle: true does, where the positions have a triangulation/,
    ],
    [square(0), [0, 1], /^Triangles of no area: 1\. .*Pass untangle: true, move a corner of each/],
    [needle(2), [0, 2], /^Triangles of no area: 2\. /],
    [needle(3), [0, 2], /^Triangles of no area: 2\. .*Move a corner of each/],
  ]) {
    const results = [
      await makeDelaunay(mesh, onCpu),
      await makeDelaunay(mesh, { ...onCpu, order: 'any' }),
      await worker.makeDelaunay(mesh, onCpu),
      makeDelaunaySync(mesh),
    ];
    for (const result of results) {
      assert.deepEqual([result.inverted, result.flat], counts);
      if (hint) assert.match(result.hint, hint);
      else assert.equal(result.hint, undefined);
    }
  }
});

test('a clockwise mesh is not turned over', async () => {
  const mesh = await generate('random 20');
  for (const indices of [mesh.indices, mesh.indices.toReversed()]) {
    const { inverted, flat } = await makeDelaunay({ ...mesh, indices }, onCpu);
    assert.deepEqual([inverted, flat], [0, 0]);
  }
});

test('verify lists them, and is not clean with an inverted one', async () => {
  const list = async (mesh) => {
    const session = await FlipSession.create(mesh, onCpu);
    await session.run();
    const { clean, violations, unlisted, invertedTriangles, flatTriangles } = await session.verify();
    session.free();
    assert.deepEqual([violations, unlisted], [[], 0]);
    assert.ok(invertedTriangles instanceof Uint32Array && flatTriangles instanceof Uint32Array);
    return [clean, [...invertedTriangles], [...flatTriangles]];
  };
  assert.deepEqual(await list(square(2)), [true, [], []]);
  assert.deepEqual(await list(square(-1)), [false, [3], []]);
  assert.deepEqual(await list(square(0)), [true, [], [3]]);
  const [clean, inverted, flat] = await list(needle(3));
  assert.deepEqual([clean, inverted, flat.length], [true, [], 2]);
});

test('problems says why positions have no triangulation', async () => {
  const corners = [0, 0, 4, 0, 4, 4, 0, 4];
  const cases = [
    [[1, 2], [], [], []],
    [[-1, 2], [4], [], []],
    [[4, 4], [4], [2, 4], []],
    [[1, 3], [], [], []],
  ];
  for (const create of [FlipSession.create, worker.FlipSession.create]) {
    const session = await create(square(2), onCpu);
    for (const [inside, ...expected] of cases) {
      await session.setPositions(new Float32Array([...corners, ...inside]));
      const { outside, coincident, crossing } = await session.problems();
      assert.deepEqual(
        [outside, coincident, crossing].map((list) => [...list]),
        expected,
      );
    }
    await session.setPositions(new Float32Array([0, 0, 4, 4, 4, 0, 0, 4, 1, 2]));
    assert.deepEqual([...(await session.problems()).crossing], [0, 1, 2, 3]);
    session.free();
  }
});

test('with threads, the counts are the same', async () => {
  const mesh = await generate('random 190');
  const positions = mesh.positions.slice();
  // Every hundredth vertex is moved to the place of another one.
  for (let v = 0; v < positions.length / 2; v += 100) positions.copyWithin(2 * v, 2 * v + 8, 2 * v + 10);
  const counted = async (threads) => {
    const { inverted, flat } = await makeDelaunay({ ...mesh, positions }, { ...onCpu, threads });
    return [inverted, flat];
  };
  const [inverted, flat] = await counted(1);
  assert.ok(inverted + flat > 100);
  assert.deepEqual(await counted(2), [inverted, flat]);
});

test('the result of a geometry has them', async () => {
  const { positions, indices } = needle(3);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(indices, 1));
  const { inverted, flat } = await delaunayGeometry(geometry, { ...onCpu, weld: false });
  assert.deepEqual([inverted, flat], [0, 2]);
});
