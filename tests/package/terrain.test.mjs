// Terrains: two of three coordinates decide, in every entry. The oracle is the plan, a mesh of two coordinates.
// Uses the existing dist/.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Document, WebIO } from '@gltf-transform/core';
import { EdgeflipError, FlipSession, init, makeDelaunay, makeDelaunaySync } from 'edgeflip';
import {
  angles,
  change,
  constrain,
  generate,
  measures,
  readMesh,
  regions,
  reorient,
  weld,
  writeMesh,
} from 'edgeflip/files';
import { delaunay } from 'edgeflip/gltf-transform';
import { delaunayGeometry } from 'edgeflip/three';
import * as worker from 'edgeflip/worker';
import * as THREE from 'three';

/** The axes of each plane, and the axis that is up. */
const PLANES = { xy: [0, 1, 2], xz: [2, 0, 1], yz: [1, 2, 0] };

let state = 7;
const random = () => {
  state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
  return state / 2 ** 32;
};

/** Gives a mesh of two coordinates heights, in a plane. */
function raised({ positions, indices }, plane, heights, Floats = positions.constructor) {
  const [u, v, up] = PLANES[plane];
  const numbers = new Floats((positions.length / 2) * 3);
  heights.forEach((height, i) => {
    numbers[3 * i + u] = positions[2 * i];
    numbers[3 * i + v] = positions[2 * i + 1];
    numbers[3 * i + up] = height;
  });
  return { positions: numbers, indices, dimension: 2, plane };
}

const heightsOf = ({ positions }) => Array.from({ length: positions.length / 2 }, () => Math.fround(9 * random()));

/** Pairs of vertices, some of which cross others. */
const linesOf = ({ positions }, count) =>
  Array.from({ length: 2 * count }, () => Math.floor((random() * positions.length) / 2));

const refused = (code, pattern) => (error) => {
  assert.ok(error instanceof EdgeflipError, String(error));
  assert.deepEqual([error.code, pattern.test(error.message)], [code, true], error.message);
  return true;
};

test('a terrain becomes what its plan becomes, in every plane', async () => {
  await init();
  for (const seed of [1, 2, 3]) {
    const plan = await generate(`random 30 seed=${seed}`);
    const heights = heightsOf(plan);
    const constraints = linesOf(plan, 12);
    for (const options of [{}, { constraints, skipConstraints: true }, { order: 'any' }]) {
      const wanted = await makeDelaunay(plan, { backend: 'cpu', ...options });
      assert.ok(wanted.flips > 100);
      for (const plane of Object.keys(PLANES)) {
        const terrain = raised(plan, plane, heights);
        const before = terrain.positions.slice();
        const made = await makeDelaunay(terrain, { backend: 'cpu', ...options });
        assert.deepEqual(terrain.positions, before);
        for (const name of ['indices', 'flips', 'iterations', 'remaining', 'leftOut', 'inverted', 'hint']) {
          assert.deepEqual(made[name], wanted[name], `${plane}: ${name}`);
        }
        const away = await worker.makeDelaunay(terrain, { backend: 'cpu', ...options });
        assert.deepEqual(away.indices, wanted.indices);
        if (!options.constraints) assert.deepEqual(makeDelaunaySync(terrain, options).indices, wanted.indices);
      }
    }
  }
});

test('heights count for nothing, whatever they are', async () => {
  const plan = await generate('random 12');
  const wanted = await makeDelaunay(plan, { backend: 'cpu' });
  const heights = heightsOf(plan).map((height, i) => [height, NaN, Infinity, 1e300][i % 4]);
  for (const plane of Object.keys(PLANES)) {
    const made = await makeDelaunay(raised(plan, plane, heights, Float64Array), { backend: 'cpu' });
    assert.deepEqual(made.indices, wanted.indices);
  }
});

test('a terrain has a stride and an offset as other meshes', async () => {
  const plan = await generate('random 12');
  const terrain = raised(plan, 'xz', heightsOf(plan));
  const wanted = await makeDelaunay(plan, { backend: 'cpu' });
  const gaps = new Float32Array(5 + (terrain.positions.length / 3) * 8).fill(NaN);
  for (let i = 0; i < terrain.positions.length; i++) gaps[5 + Math.floor(i / 3) * 8 + (i % 3)] = terrain.positions[i];
  const mesh = { ...terrain, positions: gaps, stride: 8, offset: 5 };
  assert.deepEqual((await makeDelaunay(mesh, { backend: 'cpu' })).indices, wanted.indices);
  assert.deepEqual((await worker.makeDelaunay(mesh, { backend: 'cpu' })).indices, wanted.indices);
});

test('a session of a terrain moves', async () => {
  const plan = await generate('random 20');
  const heights = heightsOf(plan);
  const moved = plan.positions.map((x) => x + 0.4 * random());
  const again = plan.positions.map((x) => x + 0.2 * random());
  for (const plane of Object.keys(PLANES)) {
    const at = (positions) => raised({ ...plan, positions }, plane, heights);
    for (const Session of [FlipSession, worker.FlipSession]) {
      const [flat, high] = await Promise.all(
        [plan, at(plan.positions)].map((mesh) => Session.create(mesh, { backend: 'cpu' })),
      );
      await Promise.all([flat.run(), high.run()]);
      flat.update({ positions: moved });
      high.update({ positions: at(moved).positions });
      assert.deepEqual(await high.triangles(), await flat.triangles());
      await flat.setPositions(again);
      await high.setPositions(at(again).positions);
      const [a, b] = [await flat.run(), await high.run()];
      assert.deepEqual({ ...b, timings: a.timings }, a);
      assert.deepEqual(await high.verify(), await flat.verify());
      const few = at(moved).positions.subarray(3);
      const wrong = refused('position-count', /^positions has 1197 numbers, but the vertices of the mesh take 1200$/);
      await assert.rejects(high.setPositions(few), wrong);
      assert.throws(() => high.update({ positions: few }), wrong);
      const hole = at(moved).positions;
      hole[3 * 7 + PLANES[plane][1]] = NaN;
      const axis = 'xyz'[PLANES[plane][1]];
      await assert.rejects(
        high.setPositions(hole),
        refused('non-finite', new RegExp(`^vertex 7: coordinate ${axis} is`)),
      );
      assert.deepEqual(await high.triangles(), await flat.triangles());
      for (const session of [flat, high]) session.free();
    }
  }
});

test('a wrong plane is named, and so are wrong values', async () => {
  const plan = await generate('random 12');
  const heights = heightsOf(plan);
  for (const right of Object.keys(PLANES)) {
    for (const plane of Object.keys(PLANES)) {
      const terrain = { ...raised(plan, right, heights), plane };
      const { hint, inverted } = await makeDelaunay(terrain, { backend: 'cpu' });
      const advice = `In the plane ${right} no triangle is turned over: pass plane: '${right}'.`;
      assert.deepEqual([inverted > 0, hint?.includes(advice) ?? false], [plane !== right, plane !== right], hint);
    }
  }
  const old = { ...raised(plan, 'xz', heights), plane: undefined, stride: 3 };
  const { hint } = await makeDelaunay(old, { backend: 'cpu' });
  assert.match(hint, /If z is not up, pass plane: 'xz' or 'yz'\.$/);
  const mesh = raised(plan, 'xy', heights);
  const cases = [
    [{ ...mesh, dimension: 3 }, /^dimension: a mesh with a plane has dimension 2$/],
    [{ ...mesh, plane: 'zx' }, /^plane: 'zx' is not 'xy', 'xz' or 'yz'$/],
    [{ ...mesh, plane: 'toString' }, /^plane: 'toString' is not/],
    [{ ...mesh, stride: 2 }, /^stride: 2 is not a whole number of at least 3$/],
  ];
  for (const [wrong, pattern] of cases) {
    await assert.rejects(makeDelaunay(wrong), refused('invalid-input', pattern));
    await assert.rejects(worker.makeDelaunay(wrong), refused('invalid-input', pattern));
  }
  await assert.rejects(
    makeDelaunay({ ...mesh, positions: mesh.positions.subarray(1) }),
    refused('ragged-array', /^positions has 431 numbers, not a multiple of 3$/),
  );
  const infinite = raised(
    { ...plan, positions: plan.positions.map((x, i) => (i === 9 ? Infinity : x)) },
    'xz',
    heights,
  );
  const where = refused('non-finite', /^vertex 4: coordinate x is Infinity, not a finite number$/);
  await assert.rejects(makeDelaunay(infinite), where);
  await assert.rejects(constrain(infinite, [0, 1]), where);
  const surface = { ...mesh, plane: undefined, dimension: 3 };
  await assert.rejects(
    makeDelaunay(surface, { constraints: [0, 50] }),
    refused('invalid-option', /a terrain needs plane$/),
  );
});

test('the functions for files know the plane', async () => {
  const plan = await generate('random 15');
  const heights = heightsOf(plan);
  for (const plane of Object.keys(PLANES)) {
    const terrain = raised(plan, plane, heights);
    const lines = [0, 200];
    const [flat, high] = await Promise.all([plan, terrain].map((mesh) => constrain(mesh, lines)));
    assert.deepEqual(high, flat);
    const cut = (mesh) => regions({ ...mesh, indices: flat.indices }, flat.constraintEdges);
    assert.deepEqual(await cut(terrain), await cut(plan));
    assert.deepEqual(await measures(terrain), await measures(plan));
    assert.deepEqual(await angles(terrain), await angles(plan));
    assert.deepEqual((await reorient(terrain)).indices, (await reorient(plan)).indices);
    const surface = { ...terrain, plane: undefined, dimension: 3 };
    assert.deepEqual(await change(terrain, flat.indices), await change(surface, flat.indices));
    for (const name of ['a.ply', 'a.obj', 'a.off', 'a.stl', 'a.glb']) {
      assert.deepEqual(await writeMesh(terrain, name), await writeMesh(surface, name), name);
    }
    const read = await readMesh(await writeMesh(terrain, 'a.ply'), 'a.ply', { plane });
    assert.deepEqual(
      [read.positions, read.indices, read.dimension, read.plane],
      [terrain.positions, terrain.indices, 2, plane],
    );
  }
  // One vertex above another is no other vertex.
  const cliff = { positions: [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 5, 1, 1, 5, 0, 1, 0], indices: [0, 1, 2, 3, 4, 5] };
  const welded = await weld({ ...cliff, dimension: 2, plane: 'xy' });
  assert.deepEqual([...welded.places], [0, 1, 2, 3, 4, 2]);
  welded.free();
});

test('a file of a terrain is written again with other triangles, also where it has polygons', async () => {
  // Seen from above, the polygons are squares with a notch; along their normals, some cross themselves.
  const outline = [0, 0, 4, 0, 4, 4, 2, 1, 0, 4];
  for (const plane of Object.keys(PLANES)) {
    const flat = raised({ positions: Float32Array.from(outline) }, plane, [0, 170, 3, 90, 20]).positions;
    const rows = Array.from({ length: 5 }, (_, i) => `v ${flat.slice(3 * i, 3 * i + 3).join(' ')}`);
    const name = 'notch.obj';
    const bytes = new TextEncoder().encode(`# kept\n${rows.join('\n')}\nf 1 2 3 4 5\n`);
    const mesh = await readMesh(bytes, name, { plane });
    assert.equal(mesh.crossing, undefined);
    const { indices, inverted } = await makeDelaunay(mesh, { backend: 'cpu' });
    assert.equal(inverted, 0);
    const text = new TextDecoder().decode(await writeMesh({ ...mesh, indices }, name, { original: { bytes, name } }));
    assert.ok(text.startsWith(`# kept\n${rows.join('\n')}\n`), text);
    const again = await readMesh(new TextEncoder().encode(text), name, { plane });
    assert.equal((await makeDelaunay(again, { backend: 'cpu' })).flips, 0);
  }
  await assert.rejects(
    readMesh(new Uint8Array(1), 'a.obj', { plane: 'x' }),
    refused('invalid-input', /^plane: 'x' is not/),
  );
});

test('the terrain of the report gets its breakline in JavaScript, three.js and glTF', async () => {
  const mesh = {
    positions: Float32Array.of(0, 0, 5, 10, 0, 6, 10, 10, 7, 0, 10, 5.5),
    indices: Uint32Array.of(0, 1, 3, 1, 2, 3),
    dimension: 2,
    plane: 'xy',
  };
  const constraints = [0, 2];
  const hasBreakline = (indices) => {
    const triangles = [0, 3].map((i) => [...indices.slice(i, i + 3)].sort().join());
    assert.deepEqual(triangles.sort(), ['0,1,2', '0,2,3']);
  };
  const { indices, crossedEdges } = await makeDelaunay(mesh, { constraints });
  assert.equal(crossedEdges, 1);
  hasBreakline(indices);
  // y is up: from above, x and -z are the axes of the map.
  const upright = mesh.positions.map((_, i) => {
    const [x, y, z] = mesh.positions.subarray(i - (i % 3));
    return [x, z, -y][i % 3];
  });
  for (const uv of [false, true]) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(upright.slice(), 3));
    if (uv) geometry.setAttribute('uv', new THREE.BufferAttribute(Float32Array.of(0, 0, 1, 0, 1, 1, 0, 1), 2));
    geometry.setIndex([...mesh.indices]);
    const made = await delaunayGeometry(geometry, { plane: 'xz', constraints });
    assert.deepEqual([made.crossedEdges, made.inverted, made.hint], [1, 0, undefined]);
    hasBreakline(geometry.index.array);
    assert.deepEqual(geometry.attributes.position.array, upright);
    const needs = refused('invalid-option', /a terrain needs plane$/);
    await assert.rejects(delaunayGeometry(geometry, { constraints }), needs);

    const document = new Document();
    const buffer = document.createBuffer();
    const accessor = (type, array) => document.createAccessor('', buffer).setType(type).setArray(array);
    const primitive = document
      .createPrimitive()
      .setAttribute('POSITION', accessor('VEC3', upright.slice()))
      .setIndices(accessor('SCALAR', Uint16Array.from(mesh.indices)));
    if (uv) primitive.setAttribute('TEXCOORD_0', accessor('VEC2', Float32Array.of(0, 0, 1, 0, 1, 1, 0, 1)));
    document.createMesh().addPrimitive(primitive);
    const flat = refused('invalid-option', /only a mesh of dimension 2 can be untangled$/);
    await assert.rejects(document.transform(delaunay({ untangle: true })), flat);
    await document.transform(delaunay({ plane: 'xz', untangle: true, constraints }));
    hasBreakline(primitive.getIndices().getArray());
    const bytes = await new WebIO().writeBinary(document);
    const read = await readMesh(bytes, 'a.glb', { plane: 'xz' });
    hasBreakline(read.indices);
    assert.deepEqual(read.positions, upright);
    document.createMesh().addPrimitive(primitive.clone().setAttribute('POSITION', accessor('VEC3', upright.slice())));
    const one = refused('invalid-option', /^option constraints: .* the document has 2$/);
    await assert.rejects(document.transform(delaunay({ plane: 'xz', constraints })), one);
  }
});

test('a texture that is laid on a terrain from above locks no edge', async () => {
  const geometry = new THREE.PlaneGeometry(30, 30, 20, 20).rotateX(-Math.PI / 2);
  const { position, uv } = geometry.attributes;
  for (let i = 0; i < position.count; i++) {
    const [x, z] = [position.getX(i) + 1.2 * random(), position.getZ(i) + 1.2 * random()];
    position.setXYZ(i, x, 3 * random(), z);
    uv.setXY(i, x / 30, z / 30);
  }
  const plan = {
    positions: Float32Array.from({ length: 2 * position.count }, (_, i) =>
      i % 2 ? position.getX(i >> 1) : position.getZ(i >> 1),
    ),
    indices: Uint32Array.from(geometry.index.array),
    dimension: 2,
  };
  const wanted = await makeDelaunay(plan);
  const made = await delaunayGeometry(geometry, { plane: 'xz' });
  assert.deepEqual([made.shiftEdges, made.inverted, made.flips], [0, 0, wanted.flips]);
  assert.ok(made.flips > 20 && made.largestShifts.uv < 1e-6, `${made.flips}`);
  assert.deepEqual(Uint32Array.from(geometry.index.array), wanted.indices);
  // A texture that is not: the flips that shift it stay.
  for (let i = 0; i < position.count; i++) uv.setXY(i, random(), random());
  position.setX(200, position.getX(200) + 0.9);
  assert.ok((await delaunayGeometry(geometry, { plane: 'xz' })).shiftEdges > 0);
});

test('folds of a terrain open', async () => {
  const plan = await generate('random 10');
  const positions = plan.positions.slice();
  [positions[2 * 44], positions[2 * 45]] = [positions[2 * 45], positions[2 * 44]];
  const terrain = raised({ ...plan, positions }, 'xz', heightsOf(plan));
  const options = { backend: 'cpu', untangle: true };
  const [wanted, made] = [await makeDelaunay({ ...plan, positions }, options), await makeDelaunay(terrain, options)];
  assert.deepEqual(made.indices, wanted.indices);
});
