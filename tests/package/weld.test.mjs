// Vertices at the same position are joined for a run and split again: by the option, by the function, and in a GLB file
// without indices. Uses the existing dist/.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { EdgeflipError, FlipSession, makeDelaunay } from 'edgeflip';
import { generate, readMesh, weld, writeMesh } from 'edgeflip/files';
import { faults, riggedGlb } from './gltf.mjs';

/** The mesh with a separate vertex for each corner. */
function soup({ positions, indices, dimension }) {
  const point = (vertex) => [...positions.subarray(dimension * vertex, dimension * (vertex + 1))];
  return {
    positions: Float32Array.from([...indices].flatMap(point)),
    indices: indices.map((_, corner) => corner),
    dimension,
  };
}

const refused = (code, pattern) => (error) => {
  assert.ok(error instanceof EdgeflipError, String(error));
  assert.equal(error.code, code, error.message);
  assert.match(error.message, pattern);
  return true;
};

test('triangles without common vertices flip like triangles with common vertices', async () => {
  for (const name of ['random 9', 'uvsphere 9']) {
    const mesh = await generate(name);
    const apart = soup(mesh);
    const options = { maxNormalAngle: 60 };
    const { indices, ...wanted } = await makeDelaunay(mesh, options);
    assert.equal((await makeDelaunay(apart, options)).flips, 0);
    const session = await FlipSession.create(apart, { ...options, weld: true });
    const found = await session.run();
    assert.ok(wanted.flips > 10);
    assert.deepEqual([found.flips, found.edges, found.remaining], [wanted.flips, wanted.edges, wanted.remaining]);
    assert.deepEqual(
      [found.joinedVertices, found.seamEdges],
      [apart.indices.length - mesh.positions.length / mesh.dimension, 0],
    );
    // Each corner is a separate vertex, so it leads to the vertex of the mesh.
    assert.deepEqual(
      found.indices.map((vertex) => mesh.indices[vertex]),
      indices,
    );
    assert.deepEqual(await session.triangles(), found.indices);
    assert.ok((await session.verify()).clean);
    session.free();
  }
});

test('attributes make seams, and seams stay', async () => {
  // A square that is split along the wrong diagonal, 0-2.
  const mesh = {
    positions: Float32Array.of(0, 0, 0.9, 0.2, 1, 1, -0, 0, 1, 1, 0, 1),
    indices: Uint16Array.of(0, 1, 2, 3, 4, 5),
    dimension: 2,
  };
  const alike = Float32Array.of(1, 2, 3, 1, 3, 4);
  const other = Uint8Array.of(0, 0, 0, 0, 0, 0, 7, 0, 0, 0, 0, 0);
  const flips = async (options) => (await makeDelaunay(mesh, options)).flips;
  assert.equal(await flips({}), 0);
  assert.equal(await flips({ weld: true }), 1);
  assert.equal(await flips({ weld: [alike] }), 1);
  assert.equal(await flips({ weld: [alike], lockedEdges: [4, 3] }), 0);
  assert.equal(await flips({ weld: [alike], lockedTriangles: [1] }), 0);
  const { seamEdges, remaining, indices } = await makeDelaunay(mesh, { weld: [alike, other] });
  assert.deepEqual([seamEdges, remaining, [...indices]], [1, { locked: 1 }, [...mesh.indices]]);
  // -0 equals 0 in a position, but not in an attribute.
  assert.equal(await flips({ weld: [Float64Array.of(0, 0, 0, -0, 0, 0)] }), 0);
  // The second triangle is reversed.
  const turned = { ...mesh, indices: Uint16Array.of(0, 1, 2, 3, 5, 4) };
  const both = await makeDelaunay(turned, { weld: [alike], reorient: true });
  assert.deepEqual([both.flips, both.turnedTriangles], [1, 1]);

  const welded = await weld(mesh, [alike, other]);
  assert.deepEqual([...welded.indices], [0, 1, 2, 0, 2, 5]);
  assert.deepEqual([...welded.lockedEdges], [0, 2]);
  assert.deepEqual([[...welded.lockedTriangles], [...welded.places]], [[], [0, 1, 2, 0, 2, 5]]);
  assert.deepEqual([welded.joined, welded.turned], [2, 0]);
  assert.deepEqual([...welded.split(welded.indices)], [...mesh.indices]);
  assert.throws(() => welded.split(welded.indices.slice(3)), refused('triangle-count', /3 numbers/));
  assert.throws(() => welded.split(Uint32Array.of(0, 5, 1, 1, 5, 2)), refused('invalid-option', /triangle 0/));
  welded.free();
  welded.free();
  assert.throws(() => welded.split(welded.indices), refused('freed', /freed/));
  await assert.rejects(
    weld(mesh, [alike.slice(1)]),
    refused('invalid-input', /attribute 0 has 5 numbers, not a multiple of 6/),
  );
  const nothing = { positions: new Float32Array(), indices: new Uint32Array(), dimension: 3 };
  assert.equal((await weld(nothing, [new Float32Array()])).joined, 0);
  await assert.rejects(weld(mesh, [new Float32Array()]), refused('invalid-option', /0 numbers, the mesh has 6/));
  await assert.rejects(weld(mesh, [[1, 2]]), refused('invalid-input', /typed array/));
  await assert.rejects(
    makeDelaunay(mesh, { weld: 1 }),
    refused('invalid-option', /weld: 1 is not true, false, a list of typed arrays/),
  );
  await assert.rejects(
    makeDelaunay(mesh, { weld: true, lockedEdges: 'all' }),
    refused('invalid-option', /lockedEdges/),
  );
});

test('the positions of a session change, and attributes stay', async () => {
  const mesh = soup(await generate('random 8'));
  const side = Uint8Array.from({ length: mesh.indices.length }, (_, corner) => (corner < 60 ? 1 : 2));
  const session = await FlipSession.create(mesh, { weld: [side] });
  const { seamEdges } = await session.run();
  assert.ok(seamEdges > 0);
  await session.setPositions(mesh.positions.map((x, i) => (i % 2 ? x : 7 * x)));
  const { flips, indices } = await session.run();
  assert.ok(flips > 0);
  assert.ok(indices.every((vertex, corner) => side[vertex] === side[corner]));
  session.free();
});

test('a rigged GLB without indices gets some, and nothing else changes', async () => {
  const { bytes } = riggedGlb({ isIndexed: false });
  assert.deepEqual(await faults(bytes), []);
  const original = { bytes, name: 'rigged.glb' };
  const mesh = await readMesh(bytes, original.name);
  assert.equal((await makeDelaunay(mesh)).flips, 0);
  const { indices, flips, joinedVertices, seamEdges, remaining } = await makeDelaunay(mesh, { weld: original });
  assert.ok(flips > 20 && joinedVertices > 100, `${flips} ${joinedVertices}`);
  assert.equal(seamEdges, 1);
  assert.deepEqual(
    Object.keys(remaining).filter((reason) => reason !== 'locked'),
    [],
  );
  const out = await writeMesh({ ...mesh, indices }, 'out.glb', { original });
  assert.deepEqual(await faults(out), []);
  const again = await readMesh(out, 'out.glb');
  assert.deepEqual([again.indices, again.positions], [indices, mesh.positions]);
  const chunk = (file) => file.subarray(28 + new DataView(file.buffer, file.byteOffset).getUint32(12, true));
  const [before, after] = [chunk(bytes), chunk(out)];
  assert.deepEqual(after.subarray(0, before.length), before);
  // Vertices of the second half of the second primitive stay on their side of the seam.
  const middle = (mesh.indices.length * 3) / 4;
  assert.ok(indices.every((vertex, corner) => vertex >= middle === corner >= middle));
});
