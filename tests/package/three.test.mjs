// Geometries of three.js become Delaunay, and everything but the index stays. Uses the existing dist/.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { EdgeflipError, FlipSession, makeDelaunay } from 'edgeflip';
import { delaunayGeometry } from 'edgeflip/three';
import * as THREE from 'three';
import { flips, sheared, square } from './geometries.mjs';
import { badEdges, same, sameTexture } from './surfaces.mjs';

const { BufferAttribute, BufferGeometry } = THREE;

/** The numbers of an attribute, as they are stored. */
const rows = (attribute) => {
  const { array, stride } = attribute.data ?? { array: attribute.array, stride: attribute.itemSize };
  return Array.from({ length: attribute.count }, (_, i) =>
    Array.from({ length: attribute.itemSize }, (_, k) => array[i * stride + (attribute.offset ?? 0) + k]),
  );
};

/** The surface of a geometry, for the comparison. */
function surfaceOf(geometry) {
  const { position, ...others } = geometry.attributes;
  const all = [...Object.values(others), ...Object.values(geometry.morphAttributes).flat()].map(rows);
  const indices = geometry.index ? [...geometry.index.array] : Array.from({ length: position.count }, (_, i) => i);
  const groups = indices.slice(indices.length / 1.5).map(() => []);
  geometry.groups.forEach(({ start, count }, i) => {
    for (let t = start / 3; t < (start + count) / 3; t++) groups[t].push(i);
  });
  return {
    positions: rows(position).flat(),
    records: Array.from({ length: position.count }, (_, i) => JSON.stringify(all.map((row) => row[i]))),
    uvs: others.uv && Array.from({ length: position.count }, (_, i) => [others.uv.getX(i), others.uv.getY(i)]).flat(),
    indices,
    groups: groups.map(String),
  };
}

const inPlane = new THREE.Matrix4().makeShear(0, 0, 0.9, 0, 0, 0);

function interleaved(geometry) {
  const { position, normal, uv } = geometry.attributes;
  const stride = 10;
  const data = new THREE.InterleavedBuffer(new Float32Array(stride * position.count), stride);
  for (const [name, attribute, offset] of [
    ['uv', uv, 0],
    ['position', position, 3],
    ['normal', normal, 6],
  ]) {
    const view = new THREE.InterleavedBufferAttribute(data, attribute.itemSize, offset);
    for (let i = 0; i < attribute.count; i++) {
      for (let k = 0; k < attribute.itemSize; k++) view.setComponent(i, k, attribute.getComponent(i, k));
      data.array[i * stride + 9] = i; // between the vertices, and of no attribute
    }
    geometry.setAttribute(name, view);
  }
  return geometry;
}

/** Stores the positions as normalized 16-bit integers. */
function quantized(geometry) {
  const { position } = geometry.attributes;
  const largest = Math.max(...[...position.array].map(Math.abs));
  const integers = Int16Array.from(position.array, (x) => Math.round((x / largest) * 32767));
  return geometry.setAttribute('position', new BufferAttribute(integers, 3, true));
}

function morphed(geometry) {
  const { position } = geometry.attributes;
  const moved = position.clone().applyMatrix4(new THREE.Matrix4().makeScale(1, 2, 3));
  geometry.morphAttributes.position = [moved];
  return geometry;
}

/** A star with a hole. */
const ring = (count, radius) =>
  Array.from({ length: count }, (_, i) => {
    const [angle, size] = [(2 * Math.PI * i) / count, i % 2 ? radius : 0.6 * radius];
    return new THREE.Vector2(size * Math.cos(angle), 0.7 * size * Math.sin(angle));
  });
const shape = new THREE.Shape(ring(18, 4));
shape.holes.push(new THREE.Path(ring(9, 1)));
const profile = Array.from({ length: 20 }, (_, i) => new THREE.Vector2(1 + 0.5 * Math.sin(i / 3), i / 4));

/** Each geometry, whether its faces are flat and their textures are not bent, and the fewest flips. */
const GEOMETRIES = {
  sphere: [() => sheared(new THREE.SphereGeometry(1, 32, 24)), false, 50],
  'torus knot': [() => new THREE.TorusKnotGeometry(1, 0.3, 100, 12), false, 50],
  'extruded shape': [() => new THREE.ExtrudeGeometry(shape, { depth: 2, steps: 6, bevelEnabled: false }), true, 1],
  'sheared extruded shape': [
    () => sheared(new THREE.ExtrudeGeometry(shape, { depth: 2, steps: 6, bevelEnabled: true, bevelSegments: 4 })),
    false,
    10,
  ],
  lathe: [() => sheared(new THREE.LatheGeometry(profile, 24)), false, 50],
  box: [() => sheared(new THREE.BoxGeometry(1, 2, 3, 3, 4, 5)), true, 20],
  'box without index': [() => sheared(new THREE.BoxGeometry(1, 2, 3, 3, 4, 5)).toNonIndexed(), true, 20],
  icosahedron: [() => sheared(new THREE.IcosahedronGeometry(1, 5)), false, 50],
  'flat icosahedron': [() => sheared(new THREE.IcosahedronGeometry(1, 0)), true, 0],
  plane: [() => sheared(new THREE.PlaneGeometry(3, 1, 9, 9)), true, 50],
  'interleaved plane': [() => interleaved(sheared(new THREE.PlaneGeometry(3, 1, 9, 9))), true, 50],
  'interleaved box': [() => interleaved(sheared(new THREE.BoxGeometry(1, 2, 3, 3, 4, 5).toNonIndexed())), true, 20],
  'morphed torus': [() => morphed(sheared(new THREE.TorusGeometry(1, 0.4, 12, 30))), false, 50],
  'quantized plane': [() => quantized(new THREE.PlaneGeometry(3, 1, 9, 9).applyMatrix4(inPlane)), true, 50],
  'quantized sphere': [() => quantized(sheared(new THREE.SphereGeometry(1, 32, 24))), false, 50],
};

for (const [name, [make, isFlat, fewest]] of Object.entries(GEOMETRIES)) {
  test(`${name}: only triangles change, and they become Delaunay`, async () => {
    const geometry = make();
    geometry.computeBoundingSphere();
    const { boundingSphere, index, groups } = geometry;
    const before = surfaceOf(geometry);
    const { array, version } = { ...index, array: index?.array.slice() };
    const versions = Object.values(geometry.attributes).map(({ version }) => version);
    const result = await delaunayGeometry(geometry, { maxNormalAngle: 60, maxAttributeShift: Infinity });
    assert.equal(result.geometry, geometry);
    assert.ok(!('indices' in result));
    const after = surfaceOf(geometry);
    same(before, after);
    if (isFlat) sameTexture(before, after);
    assert.ok(result.flips >= fewest, `${result.flips} flips`);
    const left = Object.values(result.remaining).reduce((sum, count) => sum + count, 0);
    assert.ok(badEdges(after) <= left - (result.remaining.locked ?? 0), `${badEdges(after)} of ${left} edges`);
    assert.deepEqual([geometry.groups, geometry.boundingSphere], [groups, boundingSphere]);
    assert.deepEqual(
      Object.values(geometry.attributes).map(({ version }) => version),
      versions,
    );
    const isChanged = result.flips > 0;
    if (index) {
      assert.deepEqual([index.array, index.version], [array, version]);
      assert.equal(geometry.index === index, !isChanged);
      assert.equal(geometry.index.version, Number(isChanged));
      assert.equal(geometry.index.array.constructor, array.constructor);
    } else {
      assert.equal(geometry.index?.array.constructor, isChanged ? Uint16Array : undefined);
    }
    // The triangles that the package itself verifies.
    const numbers = (rows) => Float32Array.from(rows);
    const session = await FlipSession.create(
      { positions: numbers(before.positions), indices: Uint32Array.from(before.indices), dimension: 3 },
      {
        maxNormalAngle: 60,
        // Equal records, equal numbers.
        weld: [Uint32Array.from(before.records, (record) => before.records.indexOf(record))],
        groups: Uint32Array.from(before.groups, (group) => before.groups.indexOf(group)),
      },
    );
    const { indices } = await session.run();
    assert.deepEqual([...indices], after.indices);
    assert.ok((await session.verify()).clean);
    session.free();
    const again = await delaunayGeometry(geometry, { maxNormalAngle: 60, maxIterations: 0 });
    assert.equal(again.flips, 0);
  });
}

test('attributes, morph targets and groups decide which edges flip', async () => {
  assert.equal(await flips(square()), 1);
  assert.equal(await flips(square(false)), 1);
  assert.equal(await flips(square(false), { weld: false }), 0);
  const withColor = (...colors) => square(false).setAttribute('color', new BufferAttribute(Uint8Array.from(colors), 1));
  assert.equal(await flips(withColor(1, 2, 3, 1, 3, 4)), 1);
  assert.equal(await flips(withColor(1, 2, 3, 1, 5, 4)), 0);
  assert.equal(await flips(withColor(1, 2, 3, 1, 5, 4), { weld: true }), 1);
  assert.equal(await flips(withColor(1, 2, 3, 1, 5, 4), { weld: [new Float32Array(6)] }), 1);
  const zeros = new BufferAttribute(Float32Array.of(0, -0, 0, -0, 0, -0), 1);
  assert.equal(await flips(square(false).setAttribute('zero', zeros)), 1);
  const morph = square(false);
  morph.morphAttributes.normal = [
    new BufferAttribute(
      Float32Array.from({ length: 18 }, (_, i) => Number(i === 0)),
      3,
    ),
  ];
  assert.equal(await flips(morph), 0);
  const instanced = withColor(1, 2, 3, 1, 3, 4);
  instanced.setAttribute('offset', new THREE.InstancedBufferAttribute(new Float32Array(3), 3));
  assert.equal(await flips(instanced), 1);
  const grouped = () => {
    const geometry = square();
    geometry.addGroup(0, 3, 0);
    geometry.addGroup(3, Infinity, 1);
    return geometry;
  };
  assert.equal(await flips(grouped()), 0);
  assert.equal(await flips(grouped(), { groups: [7, 7] }), 1);
  const overlapping = square();
  overlapping.addGroup(0, 6, 0);
  overlapping.addGroup(0, 3, 1);
  assert.equal(await flips(overlapping), 0);
  assert.equal(await flips(square(), { lockedEdges: [0, 2] }), 0);
});

test('the draw range limits the triangles that change', async () => {
  const two = () => {
    const geometry = square();
    geometry.setIndex([0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3, 99, 99, 99]);
    return geometry;
  };
  const geometry = two();
  await assert.rejects(delaunayGeometry(geometry), { code: 'index-out-of-range' });
  geometry.setDrawRange(6, 7);
  assert.equal(await flips(geometry), 1);
  const { array } = geometry.index;
  assert.deepEqual([...array.slice(0, 6), ...array.slice(12)], [0, 1, 2, 0, 2, 3, 99, 99, 99]);
  assert.notDeepEqual([...array.slice(6, 12)], [0, 1, 2, 0, 2, 3]);
  for (const [options, expected] of [
    [{ lockedTriangles: [0, 1] }, 1],
    [{ lockedTriangles: Uint32Array.of(3) }, 0],
    [{ groups: [1, 2, 3, 3, 4] }, 1],
    [{ groups: Uint32Array.of(1, 1, 2, 3, 4) }, 0],
  ]) {
    const other = two();
    other.setDrawRange(6, 6);
    assert.equal(await flips(other, options), expected, JSON.stringify(options));
  }
  const soup = square(false);
  soup.setDrawRange(0, 3);
  assert.deepEqual([await flips(soup), soup.index], [0, null]);
  soup.setDrawRange(0, Infinity);
  assert.equal(await flips(soup), 1);
  assert.equal(soup.index.count, 6);
});

test('a copy changes, and the original stays', async () => {
  const geometry = new THREE.TorusKnotGeometry(1, 0.3, 60, 9);
  const before = [...geometry.index.array];
  const { geometry: copy, flips } = await delaunayGeometry(geometry, { copy: true, maxNormalAngle: 60 });
  assert.ok(flips > 0 && copy !== geometry && copy instanceof THREE.TorusKnotGeometry);
  assert.deepEqual([...geometry.index.array], before);
  assert.notDeepEqual([...copy.index.array], before);
  await delaunayGeometry(geometry, { maxNormalAngle: 60 });
  assert.deepEqual(geometry.index.array, copy.index.array);
});

test('types of arrays stay, and decisions are exact for integers', async () => {
  for (const Indices of [Uint16Array, Uint32Array, Uint8Array]) {
    const geometry = square();
    geometry.setIndex(new BufferAttribute(Indices.from(geometry.index.array), 1));
    geometry.index.addUpdateRange(0, 1);
    const { index } = geometry;
    const { array } = index;
    assert.equal(await flips(geometry.clone(), { inPlace: true }), 1);
    assert.deepEqual([...array], [0, 1, 2, 0, 2, 3]);
    assert.equal(await flips(geometry), 1);
    assert.deepEqual([...array], [0, 1, 2, 0, 2, 3]);
    assert.notDeepEqual([...geometry.index.array], [...array]);
    assert.equal(geometry.index.array.constructor, Indices);
    geometry.setIndex(index);
    assert.equal(await flips(geometry, { inPlace: true }), 1);
    assert.deepEqual([geometry.index === index, index.array === array, index.updateRanges], [true, true, []]);
    assert.notDeepEqual([...array], [0, 1, 2, 0, 2, 3]);
  }
  // Four points on a circle, and one unit beside it.
  for (const [x, expected] of [
    [-25, 0],
    [-24, 1],
    [-26, 0],
  ]) {
    for (const Positions of [Int8Array, Int16Array, Int32Array, Float32Array, Float64Array]) {
      const geometry = new BufferGeometry();
      const points = Positions.from([7, -24, 0, 25, 0, 0, 7, 24, 0, x, 0, 0]);
      geometry.setAttribute('position', new BufferAttribute(points, 3, Positions.name.startsWith('Int')));
      geometry.setIndex([0, 1, 2, 0, 2, 3]);
      const mesh = { positions: Float64Array.from(points), indices: Uint32Array.of(0, 1, 2, 0, 2, 3), dimension: 3 };
      assert.equal((await makeDelaunay(mesh)).flips, expected, `${x}`);
      assert.equal(await flips(geometry), expected, `${x} in ${Positions.name}`);
    }
  }
  // -32768 and -32767 both stand for -1.
  const geometry = square(false);
  const integers = Int16Array.from(geometry.attributes.position.array, (x) => (x - 1) * 32767);
  integers[0] = -32768;
  assert.equal(await flips(geometry.setAttribute('position', new BufferAttribute(integers, 3, true))), 1);
  const half = square();
  half.setAttribute(
    'position',
    new THREE.Float16BufferAttribute(Array.from(half.attributes.position.array, THREE.DataUtils.toHalfFloat), 3),
  );
  assert.equal(await flips(half), 1);
});

test('maxDeviation counts in the units of the geometry', async () => {
  const bent = square();
  bent.attributes.position.setZ(2, 0.01);
  for (const geometry of [bent, quantized(bent.clone())]) {
    assert.equal(await flips(geometry.clone(), { maxDeviation: 0.002 }), 0);
    assert.equal(await flips(geometry.clone(), { maxDeviation: 0.02 }), 1);
  }
});

test('a stopped run leaves a valid geometry', async () => {
  const geometry = sheared(new THREE.PlaneGeometry(3, 1, 9, 9));
  const before = surfaceOf(geometry);
  const { status } = await delaunayGeometry(geometry, { maxIterations: 1 });
  assert.equal(status, 'stopped');
  same(before, surfaceOf(geometry));
  const { flips, status: end } = await delaunayGeometry(geometry, { signal: AbortSignal.abort() });
  assert.deepEqual([flips, end, geometry.index.version], [0, 'stopped', 1]);
  let seen = 0;
  await delaunayGeometry(geometry, { onIteration: () => (seen += 1) });
  assert.ok(seen > 0);
});

const refused = (code, pattern) => (error) => {
  assert.ok(error instanceof EdgeflipError, String(error));
  assert.equal(error.code, code, error.message);
  assert.match(error.message, pattern);
  return true;
};

test('errors name what is wrong, and the geometry stays', async () => {
  const rejects = (geometry, pattern, options, code = 'invalid-input') =>
    assert.rejects(delaunayGeometry(geometry, options), refused(code, pattern));
  await rejects(new BufferGeometry(), /no attribute position/);
  await rejects(undefined, /geometry: undefined is not an object/);
  await rejects({}, /not a BufferGeometry/);
  await rejects(square().setIndex([0, 1, 2, 3]), /4 indices, not a multiple of 3/);
  await rejects(square().setIndex(null), /4 vertices and no index, not a multiple of 3/);
  const position = (attribute) => square().setAttribute('position', attribute);
  await rejects(
    position(new THREE.InstancedBufferAttribute(new Float32Array(12), 3)),
    /position: it belongs to instances/,
  );
  await rejects(position(new THREE.GLBufferAttribute({}, 5126, 3, 4, 4)), /position: a GLBufferAttribute/);
  await rejects(position(new BufferAttribute(new Float32Array(8), 2)), /2 numbers per vertex, not 3/);
  await rejects(position(new BufferAttribute(new Float32Array(12).fill(NaN), 3)), /vertex 0/, {}, 'non-finite');
  await rejects(square().setAttribute('uv', new BufferAttribute(new Float32Array(6), 2)), /uv: it has 3 vertices.*4/);
  const shifted = square();
  shifted.setDrawRange(1, 3);
  await rejects(shifted, /drawRange: it starts at 1/);
  const group = square();
  group.addGroup(0, 3);
  group.addGroup(4, 2);
  await rejects(group, /group 1: it starts at 4/);
  await rejects(square(), /copy: 1 is not true or false/, { copy: 1 }, 'invalid-option');
  await rejects(square(), /inPlace: 'no' is not true or false/, { inPlace: 'no' }, 'invalid-option');
  await rejects(square(), /did you mean copy\?|is not an option/, { copi: true }, 'invalid-option');
  await rejects(square(), /options: 5 is not an object/, 5);
  await rejects(square(), /maxDeviation/, { maxDeviation: 'x' }, 'invalid-option');
  const geometry = square();
  const run = delaunayGeometry(geometry);
  geometry.setIndex([0, 1, 2]);
  await assert.rejects(run, refused('invalid-input', /changed during the run/));
  assert.deepEqual([...geometry.index.array], [0, 1, 2]);
});
