// Which triangles of a geometry of three.js change: an index that other geometries share stays, and a draw range limits
// the triangles that change, as it limits those that are drawn. Uses the existing dist/.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { EdgeflipError } from 'edgeflip';
import { delaunayGeometry } from 'edgeflip/three';
import * as THREE from 'three';
import { flips, sheared, square } from './geometries.mjs';

const { BufferGeometry } = THREE;

const refused = (code, pattern) => (error) => {
  assert.ok(error instanceof EdgeflipError, String(error));
  assert.equal(error.code, code, error.message);
  assert.match(error.message, pattern);
  return true;
};

test('geometries that share an index do not change each other', async () => {
  // As GLTFLoader makes them for two primitives with a common accessor: the other one folds if this edge flips.
  const shared = () => {
    const a = square();
    const points = [0, 0, 0, 3, 0, 0, 1, 1, 0, 0, 3, 0];
    const b = new BufferGeometry().setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
    return [a, b.setIndex(a.index)];
  };
  for (const weld of [false, undefined]) {
    const [a, b] = shared();
    b.index.setUsage(THREE.DynamicDrawUsage);
    b.index.name = 'triangles';
    const given = b.index;
    assert.equal(await flips(a, { weld }), 1);
    assert.deepEqual([b.index === given, [...given.array], given.version], [true, [0, 1, 2, 0, 2, 3], 0]);
    assert.deepEqual([a.index.usage, a.index.name, a.index.itemSize], [THREE.DynamicDrawUsage, 'triangles', 1]);
    // Wireframes are made again if the version differs.
    assert.ok(a.index.version > given.version);
    const own = a.index;
    assert.deepEqual([await flips(a, { weld }), a.index === own], [0, true]);
    const [c, d] = shared();
    assert.equal(await flips(c, { inPlace: true }), 1);
    assert.equal(c.index, d.index);
    assert.notDeepEqual([...d.index.array], [0, 1, 2, 0, 2, 3]);
    const [e, f] = shared();
    const { geometry } = await delaunayGeometry(e, { inPlace: true, copy: true });
    assert.deepEqual([e.index === f.index, [...e.index.array]], [true, [0, 1, 2, 0, 2, 3]]);
    assert.notDeepEqual([...geometry.index.array], [0, 1, 2, 0, 2, 3]);
  }
  const [a, b] = shared();
  const both = await Promise.all([a, b].map((geometry) => delaunayGeometry(geometry)));
  assert.deepEqual(
    both.map(({ flips }) => flips),
    [1, 0],
  );
});

test('a draw range may begin before the first triangle, as three.js draws it', async () => {
  const drawn = async (start, count) => {
    const geometry = square();
    geometry.setIndex([0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3]);
    const before = [...geometry.index.array];
    geometry.setDrawRange(start, count);
    await delaunayGeometry(geometry, { weld: false });
    return [0, 6].map((i) => before.slice(i, i + 6).join() !== [...geometry.index.array].slice(i, i + 6).join());
  };
  assert.deepEqual(await drawn(0, 6), [true, false]);
  assert.deepEqual(await drawn(-6, 12), [true, false]);
  assert.deepEqual(await drawn(-1, 8), [true, false]);
  assert.deepEqual(await drawn(-6, 6), [false, false]);
  assert.deepEqual(await drawn(-3, -9), [false, false]);
  assert.deepEqual(await drawn(6, Infinity), [false, true]);
  // three.js draws nothing.
  assert.deepEqual(await drawn(100, 6), [false, false]);
  assert.deepEqual(await drawn(12, 6), [false, false]);
  assert.deepEqual(await drawn(1, 0), [false, false]);
  assert.deepEqual(await drawn(7, -3), [false, false]);
  await assert.rejects(drawn(10, 6), refused('invalid-input', /drawRange: it starts at 10, inside a triangle/));
  const grouped = square();
  grouped.addGroup(-3, 6, 0);
  grouped.addGroup(3, 3, 1);
  assert.equal(await flips(grouped), 0);
  for (const [start, count] of [
    [NaN, 3],
    ['0', 3],
    [-Infinity, Infinity],
  ]) {
    const geometry = square();
    geometry.setDrawRange(start, count);
    await assert.rejects(
      delaunayGeometry(geometry),
      refused('invalid-input', /drawRange: its start .* are not a range/),
    );
  }
});

test('lists count all triangles of a geometry with a draw range', async () => {
  const whole = sheared(new THREE.PlaneGeometry(3, 1, 9, 9));
  const { count } = whole.index;
  const triangles = count / 3;
  const numbers = (seed, length, most) => Array.from({ length }, (_, i) => (seed * 7919 + i * i * 104729 + i) % most);
  for (let seed = 0; seed < 20; seed++) {
    const [first, end] = [seed % 50, 60 + ((7 * seed) % 100)];
    const lockedTriangles = numbers(seed, seed % 9, triangles);
    const groups = numbers(seed, triangles, 1 + (seed % 2));
    const edges = numbers(seed + 1, 30, count).map((i) => [i, i % 3 < 2 ? i + 1 : i - 2]);
    const { array } = whole.index;
    for (const weld of [false, undefined]) {
      const part = whole.clone();
      part.setDrawRange(3 * first, 3 * (end - first));
      const lockedEdges = edges.flatMap((pair) => pair.map((i) => array[i]));
      const result = await delaunayGeometry(part, { weld, lockedTriangles, groups, lockedEdges });
      // The same triangles alone.
      const alone = whole.clone().setIndex([...array.slice(3 * first, 3 * end)]);
      const ofPart = new Set();
      for (let i = 3 * first; i < 3 * end; i++) {
        const [u, v] = [array[i], array[i % 3 < 2 ? i + 1 : i - 2]];
        ofPart.add(`${u} ${v}`).add(`${v} ${u}`);
      }
      const wanted = await delaunayGeometry(alone, {
        weld,
        lockedTriangles: lockedTriangles.filter((t) => first <= t && t < end).map((t) => t - first),
        groups: groups.slice(first, end),
        lockedEdges: edges.map((pair) => pair.map((i) => array[i])).flatMap((p) => (ofPart.has(p.join(' ')) ? p : [])),
      });
      assert.deepEqual([...part.index.array.slice(3 * first, 3 * end)], [...alone.index.array]);
      assert.deepEqual([result.flips, result.remaining], [wanted.flips, wanted.remaining]);
    }
  }
  const rejects = (options, pattern, code = 'invalid-option') => {
    const geometry = whole.clone();
    geometry.setDrawRange(3, 30);
    return assert.rejects(delaunayGeometry(geometry, options), refused(code, pattern));
  };
  await rejects(
    { lockedTriangles: [0, triangles] },
    /^option lockedTriangles: there is no triangle 162; the geometry has/,
  );
  await rejects({ lockedTriangles: 5 }, /^option lockedTriangles: 5 is neither an integer array/);
  await rejects({ lockedTriangles: [0.5] }, /^option lockedTriangles: .* number 0 is 0.5/);
  await rejects({ groups: [1, 2] }, /^option groups: it has 2 numbers, the geometry has 162 triangles/);
  await rejects({ groups: 'x' }, /^option groups: 'x' is neither/);
  await rejects({ lockedEdges: [0, 99] }, /^option lockedEdges: the geometry has no edge between vertices 0 and 99/);
  await rejects({ lockedEdges: [0, 0] }, /no edge between vertices 0 and 0/);
  await rejects({ lockedEdges: [0] }, /lockedEdges has 1 numbers, not a multiple of 2/, 'ragged-array');
  // Without an index, an edge is one between positions, because they are joined.
  const soup = square(false);
  soup.setDrawRange(0, 6);
  assert.equal(await flips(soup, { lockedEdges: [3, 2] }), 0);
  const longer = square(false).toNonIndexed();
  const points = [...longer.attributes.position.array];
  longer.setAttribute('position', new THREE.Float32BufferAttribute([...points, ...points.map((x) => x + 5)], 3));
  longer.setDrawRange(0, 6);
  assert.equal(await flips(longer.clone(), { lockedEdges: [6, 8] }), 1);
  assert.equal(await flips(longer.clone(), { lockedEdges: [3, 2] }), 0);
  await assert.rejects(
    delaunayGeometry(longer, { weld: false, lockedEdges: [0, 5] }),
    refused('invalid-option', /no edge between vertices 0 and 5/),
  );
});
