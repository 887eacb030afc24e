// Lines that cross: splitCrossings adds vertices, with attributes and heights. Uses the existing dist/.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { EdgeflipError, FlipSession, makeDelaunay } from 'edgeflip';
import { constrain, generate, splitCrossings } from 'edgeflip/files';
import { orient2d } from 'robust-predicates';

const SQUARE = { positions: Float32Array.of(0, 0, 4, 0, 4, 2, 0, 2), indices: Uint32Array.of(0, 1, 2, 0, 2, 3) };
const DIAGONALS = [0, 2, 1, 3];

const refused = (code, pattern) => (error) => {
  assert.ok(error instanceof EdgeflipError, String(error));
  assert.deepEqual([error.code, pattern.test(error.message)], [code, true], error.message);
  return true;
};

test('both diagonals of a square', async () => {
  const colours = Uint8Array.of(0, 10, 20, 30, 103, 50, 60, 70);
  const weights = Float64Array.of(1, 2, 4, 8);
  for (const Floats of [Float32Array, Float64Array]) {
    const mesh = { ...SQUARE, positions: Floats.from(SQUARE.positions), dimension: 2 };
    const split = await splitCrossings(mesh, DIAGONALS, { attributes: [colours, weights] });
    assert.deepEqual(split.positions, Floats.of(...SQUARE.positions, 2, 1));
    assert.deepEqual(split.chains, [Uint32Array.of(0, 4, 2), Uint32Array.of(1, 4, 3)]);
    assert.deepEqual(split.constraintEdges, Uint32Array.of(0, 4, 1, 4, 2, 4, 3, 4));
    assert.deepEqual(split.crossings, Uint32Array.of(0, 1));
    // Between the vertices 0 and 2; 51.5 is rounded.
    assert.deepEqual(split.attributes, [Uint8Array.of(...colours, 52, 30), Float64Array.of(...weights, 2.5)]);
    assert.deepEqual([split.deviation, split.leftOut, split.dimension], [0, [], 2]);
    assert.ok(!('plane' in split));
    const { indices } = await makeDelaunay(split, { lockedEdges: split.constraintEdges, backend: 'cpu' });
    assert.equal(indices.length, 12);
  }
});

test('a crossing has the numbers of the positions', async () => {
  for (const Floats of [Float32Array, Float64Array]) {
    const mesh = { positions: Floats.of(0, 0, 3, 0, 3, 2, 0, 1), indices: SQUARE.indices, dimension: 2 };
    const { positions } = await splitCrossings(mesh, DIAGONALS);
    // x = y 3/2 and x = 3 - 3 y.
    assert.deepEqual(positions, Floats.of(...mesh.positions, 1, 2 / 3));
  }
});

test('random lines go on as chains, and the run is clean', async () => {
  const { positions, indices } = await generate('random 30 seed=5');
  const mesh = { positions: Float64Array.from(positions), indices, dimension: 2 };
  let state = 9;
  const vertex = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * 900);
  };
  const lines = Array.from({ length: 80 }, vertex);
  const { leftOut } = await constrain(mesh, lines, {}, true);
  assert.ok(leftOut.some(({ reason }) => / crosses constraint /.test(reason)));
  const split = await splitCrossings(mesh, lines, { skipConstraints: true });
  assert.ok(split.leftOut.every(({ reason }) => !/ crosses constraint /.test(reason)));
  assert.ok(split.crossings.length > 60 && split.deviation < 1e-12);
  const edges = new Set();
  for (let i = 0; i < split.indices.length; i += 3) {
    const [a, b, c] = split.indices.subarray(i, i + 3);
    const points = [a, b, c].flatMap((v) => [split.positions[2 * v], split.positions[2 * v + 1]]);
    // robust-predicates counts y downwards.
    assert.ok(orient2d(...points) < 0);
    for (const pair of [
      [a, b],
      [b, c],
      [c, a],
    ])
      edges.add(pair.sort((x, y) => x - y).join());
  }
  const isLeftOut = new Set(split.leftOut.map(({ index }) => index));
  for (const [i, chain] of split.chains.entries()) {
    if (isLeftOut.has(i)) {
      assert.equal(chain.length, 0);
      continue;
    }
    assert.deepEqual([chain[0], chain.at(-1)], lines.slice(2 * i, 2 * i + 2));
    for (let k = 1; k < chain.length; k++) {
      assert.ok(edges.has([chain[k - 1], chain[k]].sort((x, y) => x - y).join()));
    }
  }
  const session = await FlipSession.create(split, { lockedEdges: split.constraintEdges, backend: 'cpu' });
  await session.run();
  const { clean, violations } = await session.verify();
  session.free();
  assert.deepEqual([clean, violations], [true, []]);
});

test('a terrain has heights at its crossings', async () => {
  const up = { xy: 2, xz: 1, yz: 0 };
  const axes = { xy: [0, 1], xz: [2, 0], yz: [1, 2] };
  for (const plane of ['xy', 'xz', 'yz']) {
    const positions = new Float32Array(12);
    for (let v = 0; v < 4; v++) {
      for (const k of [0, 1]) positions[3 * v + axes[plane][k]] = SQUARE.positions[2 * v + k];
      positions[3 * v + up[plane]] = [10, 0, 30, 5][v];
    }
    const mesh = { positions, indices: SQUARE.indices, dimension: 2, plane };
    for (const [lines, height] of [
      [DIAGONALS, 20],
      [[1, 3, 0, 2], 2.5],
    ]) {
      const split = await splitCrossings(mesh, lines);
      assert.deepEqual(split.positions.subarray(0, 12), positions);
      const [u, v] = axes[plane];
      assert.deepEqual(
        [split.positions[12 + u], split.positions[12 + v], split.positions[12 + up[plane]]],
        [2, 1, height],
      );
      assert.equal(split.plane, plane);
    }
  }
});

test('what cannot be split is an error', async () => {
  const mesh = { ...SQUARE, dimension: 2 };
  const split = (lines, options, given = mesh) => splitCrossings(given, lines, options);
  await assert.rejects(split([1, 3], { lockedEdges: [0, 2] }), refused('invalid-option', /crosses the locked edge/));
  await assert.rejects(split([1, 3], { groups: [0, 1] }), refused('invalid-option', /crosses the locked edge/));
  await assert.rejects(split([1, 3], { lockedTriangles: [0] }), refused('invalid-option', /crosses the locked edge/));
  const { leftOut, chains } = await split([1, 3], { lockedEdges: [0, 2], skipConstraints: true });
  assert.deepEqual([leftOut.length, chains], [1, [new Uint32Array()]]);
  await assert.rejects(split([0, 9]), refused('invalid-option', /the mesh has 4 vertices/));
  await assert.rejects(split([0]), refused('ragged-array', /constraints has 1 numbers/));
  await assert.rejects(split(DIAGONALS, { skipConstraints: 1 }), refused('invalid-input', /skipConstraints/));
  await assert.rejects(split(DIAGONALS, { attributes: [new Uint8Array(7)] }), refused('invalid-input', /attribute 0/));
  await assert.rejects(split(DIAGONALS, { attributes: [7] }), refused('invalid-input', /attribute 0/));
  await assert.rejects(split(DIAGONALS, { skipsConstraints: true }), refused('invalid-option', /skipConstraints/));
  const surface = { ...(await generate('uvsphere 6')) };
  await assert.rejects(split([0, 9], {}, surface), refused('invalid-option', /dimension 2/));
});
