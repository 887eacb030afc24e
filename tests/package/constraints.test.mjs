// Edges that are brought in before a run: on every engine that Node has, with other options, and while the mesh moves.
// Uses the existing dist/.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import Delaunator from 'delaunator';
import { EdgeflipError, FlipSession, makeDelaunay } from 'edgeflip';
import { constrain, generate, regions } from 'edgeflip/files';
import { triangulate } from 'edgeflip/points';

/** The edges of triangles, each as `smaller-larger`. */
function edgesOf(indices) {
  const edge = (from, to) => `${Math.min(from, to)}-${Math.max(from, to)}`;
  return new Set([...indices].map((vertex, i) => edge(vertex, indices[i % 3 === 2 ? i - 2 : i + 1])));
}

/** The edges of the path that a constraint has become, from the pairs of `lockedEdges`. */
function pairsOf(lockedEdges) {
  return Array.from({ length: lockedEdges.length / 2 }, (_, i) => [...lockedEdges.slice(2 * i, 2 * i + 2)]);
}

const refused = (code, pattern) => (error) => {
  assert.ok(error instanceof EdgeflipError, String(error));
  assert.equal(error.code, code, error.message);
  assert.match(error.message, pattern);
  return true;
};

test('a long constraint becomes a path of edges, and the rest is Delaunay', async () => {
  // The second mesh is large enough for several threads.
  for (const name of ['random 30', 'random 200', 'regular 9']) {
    const mesh = await generate(name);
    const last = mesh.positions.length / 2 - 1;
    const constraints = [0, last];
    // Two sides of a triangle at another corner.
    const t = 3 * Math.floor(mesh.indices.indexOf(Math.sqrt(last + 1) - 1) / 3);
    const locks = { lockedEdges: [t, t + 1, t + 1, t + 2].map((i) => mesh.indices[i]) };
    const { constraintEdges, crossedEdges, leftOut } = await constrain(mesh, constraints, locks);
    const pairs = pairsOf(constraintEdges);
    assert.deepEqual([pairs[0][0], pairs.at(-1)[1], leftOut], [0, last, []]);
    let wanted;
    for (const options of [{ threads: 1 }, { threads: 2 }, { order: 'any' }]) {
      const session = await FlipSession.create(mesh, { backend: 'cpu', constraints, ...locks, ...options });
      const result = await session.run();
      assert.equal(result.crossedEdges, crossedEdges);
      assert.deepEqual([result.status, result.leftOut], ['done', []]);
      const edges = edgesOf(result.indices);
      for (const pair of pairs) assert.ok(edges.has(pair.toSorted((u, v) => u - v).join('-')), `${name}: ${pair}`);
      const audit = await session.verify();
      assert.deepEqual([audit.clean, audit.remaining], [true, result.remaining]);
      assert.deepEqual(
        Object.keys(result.remaining).filter((reason) => reason !== 'locked'),
        [],
      );
      if (options.threads) assert.deepEqual(result.indices, (wanted ??= result.indices));
      session.free();
    }
  }
});

test('lines that miss their common vertex by rounding meet with a tolerance', async () => {
  // A grid that is turned by 0.1, with its diagonals and a needle.
  const turned = ([x, y]) => [Math.cos(0.1) * x - Math.sin(0.1) * y, Math.sin(0.1) * x + Math.cos(0.1) * y];
  const positions = Array.from({ length: 9 }, (_, i) => turned([Math.floor(i / 3), i % 3])).flat();
  const corners = [1, 2, 5, 4, 1, 5, 5, 7, 4, 4, 3, 1, 7, 3, 4, 3, 0, 1, 5, 8, 7, 2, 8, 5, 7, 6, 3];
  const mesh = { positions, indices: corners, dimension: 2 };
  const constraints = [3, 5, 1, 7];
  await assert.rejects(makeDelaunay(mesh, { constraints }), refused('invalid-option', /crosses constraint 0/));
  const session = await FlipSession.create(mesh, { backend: 'cpu', constraints, constraintTolerance: 1e-15 });
  const result = await session.run();
  assert.deepEqual([...result.constraintEdges], [3, 4, 4, 5, 1, 4, 4, 7]);
  assert.ok(result.constraintDeviation > 0 && result.constraintDeviation < 1e-15, String(result.constraintDeviation));
  const { violations, remaining } = await session.verify();
  assert.deepEqual([violations, remaining], [[], result.remaining]);
  session.free();
  const { constraintEdges, deviation } = await constrain(mesh, constraints, {}, false, 1e-15);
  assert.deepEqual([constraintEdges, deviation], [result.constraintEdges, result.constraintDeviation]);
  await assert.rejects(constrain(mesh, constraints, {}, false, '1'), refused('invalid-input', /tolerance.*number/));
});

test('untangling mends what delaunator turned over, so that a constraint comes in', async () => {
  // Two columns of a grid, of an issue of another library.
  const positions = Float64Array.of(
    0,
    0,
    0.9843345352665859,
    0.17631086943666954,
    0.17631086943666954,
    -0.9843345352665859,
    1.1606454047032555,
    -0.8080236658299164,
    0.3526217388733391,
    -1.9686690705331717,
    1.336956274139925,
    -1.7923582010965022,
    0.5289326083100087,
    -2.9530036057997577,
    1.5132671435765945,
    -2.776692736363088,
    0.7052434777466782,
    -3.9373381410663435,
    1.689578013013264,
    -3.7610272716296738,
    0.8815543471833477,
    -4.921672676332929,
    1.8658888824499336,
    -4.74536180689626,
  );
  const mesh = { positions, indices: new Delaunator(positions).triangles, dimension: 2 };
  const given = { backend: 'cpu', constraints: [10, 2] };
  await assert.rejects(makeDelaunay(mesh, given), refused('invalid-option', /untangle may mend that$/));
  for (const [constraintTolerance, edges] of [
    [0, [10, 2]],
    [1e-14, [10, 8, 8, 6, 6, 4, 4, 2]],
  ]) {
    const { constraintEdges } = await makeDelaunay(mesh, { ...given, untangle: true, constraintTolerance });
    assert.deepEqual([...constraintEdges], edges);
  }
});

test('the audit knows which path a constraint has taken, and which constraints were left out', async () => {
  // An edge leads from 0 to 1 on the line to 2, and none goes on from there.
  const mesh = { positions: Float32Array.of(0, 0, 1, 0, 2, 0, 0, 2, 0, -1), indices: [0, 2, 3, 0, 4, 1], dimension: 2 };
  for (const [constraints, skipConstraints, left] of [
    [[0, 2], false, []],
    [[4, 2, 0, 2, 3, 3], true, [0, 2]],
  ]) {
    const session = await FlipSession.create(mesh, { backend: 'cpu', constraints, skipConstraints });
    const { leftOut } = await session.run();
    assert.deepEqual(
      leftOut.map(({ index }) => index),
      left,
    );
    assert.deepEqual((await session.verify()).violations, []);
    session.free();
  }
});

test('constraints stay while the mesh moves', async () => {
  const mesh = await generate('random 30');
  const constraints = [0, mesh.positions.length / 2 - 1];
  const { lockedEdges } = await constrain(mesh, constraints);
  const session = await FlipSession.create(mesh, { backend: 'cpu', constraints });
  await session.run();
  for (let frame = 1; frame < 4; frame++) {
    session.update({ positions: mesh.positions.map((x, i) => (i % 2 ? x : x + 0.2 * frame * mesh.positions[i + 1])) });
    const edges = edgesOf(await session.triangles());
    for (const pair of pairsOf(lockedEdges)) assert.ok(edges.has(pair.toSorted((u, v) => u - v).join('-')));
  }
  assert.ok((await session.verify()).clean);
  session.free();
});

test('a constraint joins positions if vertices are welded, and respects locks', async () => {
  // A square whose two triangles share no vertex.
  const positions = new Float32Array([0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1]);
  const apart = { positions, indices: [0, 1, 2, 3, 4, 5], dimension: 2 };
  const { crossedEdges, joinedVertices } = await makeDelaunay(apart, { weld: true, constraints: [1, 5] });
  assert.deepEqual([crossedEdges, joinedVertices], [1, 2]);
  const given = { positions: new Float64Array([0, 0, 1, 0, 1, 1, 0, 1]), indices: [0, 1, 2, 0, 2, 3], dimension: 2 };
  const crosses = /^option constraints: constraint 0 between 1 and 3 crosses the locked edge between \d and \d$/;
  for (const locks of [{ lockedEdges: [0, 2] }, { lockedTriangles: [0] }, { groups: [0, 1] }]) {
    await assert.rejects(makeDelaunay(given, { constraints: [1, 3], ...locks }), refused('invalid-option', crosses));
    await assert.rejects(constrain(given, [1, 3], locks), refused('invalid-option', crosses));
    const { leftOut, lockedEdges } = await constrain(given, [1, 3], locks, true);
    assert.match(`option constraints: ${leftOut[0].reason}`, crosses);
    assert.ok(lockedEdges.length >= 2);
  }
});

test('regions takes what a run returns, also of welded vertices', async () => {
  // A square with a square hole. Rings repeat their first point, as in GeoJSON, and each triangle has its own vertices.
  const ring = (low, high) => [low, low, high, low, high, high, low, high, low, low];
  const rings = [...ring(0, 9), ...ring(3, 6)];
  const sides = [0, 5].flatMap((first) => [0, 1, 2, 3].flatMap((k) => [first + k, first + k + 1]));
  const { triangles } = await triangulate(rings);
  const counted = (await regions({ positions: rings, indices: triangles, dimension: 2 }, [])).inside.length;
  const run = async (mesh, options) => {
    const { indices, constraintEdges, leftOut } = await makeDelaunay(mesh, { backend: 'cpu', ...options });
    assert.deepEqual(leftOut, []);
    const { inside, isClosed } = await regions({ ...mesh, indices }, constraintEdges);
    assert.deepEqual([inside.length, isClosed], [counted, true]);
    return inside.filter(Boolean).length;
  };
  const once = { positions: rings, indices: triangles, dimension: 2 };
  const inside = await run(once, { weld: true, constraints: sides });
  assert.ok(inside > 0 && inside < counted, `${inside} of ${counted}`);
  // Second vertices at the same points, which some triangles use: only their place in the order differs.
  const copies = rings.length / 2;
  const turned = { positions: [...rings, ...rings], dimension: 2 };
  const indices = [...triangles].map((vertex) => vertex + copies);
  assert.equal(await run({ ...turned, indices }, { weld: true, constraints: sides }), inside);
  const plain = sides.map((vertex) => (vertex === 4 ? 0 : vertex === 9 ? 5 : vertex));
  const without = await makeDelaunay(once, { backend: 'cpu', constraints: plain });
  assert.deepEqual([...without.constraintEdges], plain);
  assert.equal((await makeDelaunay(once, { backend: 'cpu' })).constraintEdges.length, 0);
});

test('wrong constraints are refused', async () => {
  const mesh = await generate('random 9');
  for (const [constraints, code, pattern] of [
    [[0], 'ragged-array', /constraints has 1 number/],
    [[4, 4], 'invalid-option', /constraint 0 between 4 and 4 joins a vertex to itself; remove it from the list/],
    [[0, 1e9], 'invalid-option', /constraint 0 joins 0 and 1000000000; the mesh has 81 vertices/],
    ['0 1', 'invalid-option', /constraints: '0 1' is neither/],
  ]) {
    await assert.rejects(makeDelaunay(mesh, { constraints }), refused(code, pattern));
  }
  await assert.rejects(
    makeDelaunay(await generate('uvsphere 9'), { constraints: [0, 1] }),
    refused('invalid-option', /dimension 2/),
  );
  await assert.rejects(constrain(mesh, [0]), refused('ragged-array', /constraints/));
  await assert.rejects(constrain(mesh, '0 1'), refused('invalid-input', /constraints/));
  await assert.rejects(constrain(mesh, [0, 1], { locked: [] }), refused('invalid-option', /locked/));
  await assert.rejects(constrain(mesh, [0, 1], [0, 1]), refused('invalid-input', /^locks: a list is not/));
  await assert.rejects(constrain(mesh, [0, 1], {}, 1), refused('invalid-input', /^skips: 1 is not true or false$/));
  await assert.rejects(constrain(mesh, [[0, 1]]), refused('invalid-input', /number 0 is a list$/));
  await assert.rejects(constrain(mesh, [0n, 1n]), refused('invalid-input', /number 0 is 0n$/));
});

test('regions are cut along the constraints, not along the locks', async () => {
  // A square of two triangles beside another one.
  const positions = Float64Array.of(0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1);
  const indices = [0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4];
  const mesh = { positions, indices, dimension: 2 };
  const ring = [0, 1, 1, 4, 4, 3, 3, 0];
  const { constraintEdges, lockedEdges } = await constrain(mesh, ring, { lockedEdges: [2, 5], lockedTriangles: [3] });
  assert.deepEqual([...constraintEdges], ring);
  assert.deepEqual([...lockedEdges.slice(-ring.length)], ring);
  const { inside, isClosed } = await regions(mesh, constraintEdges);
  assert.deepEqual([[...inside], isClosed], [[1, 1, 0, 0], true]);
  assert.equal((await regions(mesh, ring.slice(2))).isClosed, false);
  const missing = /^option edges: the mesh has no edge between vertices 0 and 5; bring it in first/;
  await assert.rejects(regions(mesh, [0, 5]), refused('invalid-option', missing));
});
