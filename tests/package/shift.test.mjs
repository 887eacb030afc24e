// `maxAttributeShift` in `edgeflip/three` and `edgeflip/gltf-transform`: no flip shifts a texture too far, and many flips
// together neither. In the plane, an independent comparison at random points says so. Uses the existing dist/.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Document } from '@gltf-transform/core';
import { EdgeflipError } from 'edgeflip';
import { delaunay } from 'edgeflip/gltf-transform';
import { delaunayGeometry } from 'edgeflip/three';
import * as THREE from 'three';

const TEXEL = 1 / 1024;

/** A geometry with an attribute of each name. */
function geometryOf(points, indices, attributes) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
  for (const [name, [numbers, width]] of Object.entries(attributes)) {
    geometry.setAttribute(name, new THREE.Float32BufferAttribute(numbers, width));
  }
  return geometry.setIndex(indices);
}

/** Two triangles, split along the long diagonal 0-2, which is the axis of the mirror: u is |y|. */
const POINTS = [-3, 0, 0, 0, -1, 0, 3, 0, 0, 0, 1, 0];
const MIRROR = [0, 0, 1, 0.5, 0, 1, 1, 0.5];
const mirror = (uv = MIRROR, name = 'uv', width = 2) => geometryOf(POINTS, [0, 1, 2, 0, 2, 3], { [name]: [uv, width] });

const run = async (geometry, options) => {
  const { flips, shiftEdges, largestShifts } = await delaunayGeometry(geometry, options);
  return { flips, shiftEdges, largestShifts };
};

test('a mirrored texture stays, and one that is not bent allows the flip', async () => {
  assert.deepEqual(await run(mirror()), { flips: 0, shiftEdges: 1, largestShifts: { uv: 0 } });
  const plain = [0, 0.5, 0.5, 0, 1, 0.5, 0.5, 1];
  const { flips, shiftEdges } = await run(mirror(plain));
  assert.deepEqual([flips, shiftEdges], [1, 0]);
  // Half a texel beside it, and two.
  for (const [shift, expected] of [
    [0.5, 1],
    [2, 0],
    [-2, 0],
  ]) {
    const bent = plain.with(2, plain[2] + 2 * shift * TEXEL);
    const found = await run(mirror(bent));
    assert.equal(found.flips, expected, `${shift} texels`);
    if (expected) assert.ok(Math.abs(found.largestShifts.uv - shift * TEXEL) < 1e-7);
    assert.equal((await run(mirror(bent), { maxAttributeShift: 3 * TEXEL })).flips, 1);
    assert.equal((await run(mirror(bent), { maxAttributeShift: 0.1 * TEXEL })).flips, 0);
  }
  const free = await run(mirror(), { maxAttributeShift: Infinity });
  assert.deepEqual(free, { flips: 1, shiftEdges: 0, largestShifts: {} });
  const measured = await run(mirror(), { maxAttributeShift: 2 });
  assert.deepEqual([measured.flips, measured.largestShifts], [1, { uv: 1 }]);
});

test('where triangles are bent, the shift is the one from 27 degrees beside the normal', async () => {
  // u is x / 6, and the new diagonal is above the old one by `height`.
  const bent = (height) => {
    const points = POINTS.map((x, i) => (i === 5 || i === 11 ? height : x));
    return geometryOf(points, [0, 1, 2, 0, 2, 3], {
      uv: [POINTS.flatMap((x, i) => (i % 3 === 0 ? [x / 6, 0] : [])), 2],
    });
  };
  for (const [shift, expected] of [
    [0.9, 1],
    [1.1, 0],
  ]) {
    const { flips, largestShifts } = await run(bent(12 * shift * TEXEL));
    assert.equal(flips, expected, `${shift} texels`);
    if (expected) assert.ok(Math.abs(largestShifts.uv - shift * TEXEL) < 1e-7, `${largestShifts.uv}`);
  }
});

test('the flips that coarse shapes of three.js keep', async () => {
  const { TorusKnotGeometry, TorusGeometry, CylinderGeometry } = THREE;
  for (const [make, kept, all] of [
    [() => new TorusKnotGeometry(1, 0.3, 100, 12), 250, 738],
    [() => new TorusGeometry(1, 0.4, 12, 48), 96, 288],
    [() => new CylinderGeometry(1, 2, 3, 32, 8), 0, 128],
  ]) {
    assert.equal((await run(make(), { maxNormalAngle: 30, maxAttributeShift: Infinity })).flips, all);
    const { flips } = await run(make(), { maxNormalAngle: 30 });
    assert.ok(flips >= kept && flips < all, `${flips} of ${all} flips`);
  }
});

test('a hint says that the limit keeps most edges from their flips', async () => {
  const { hint } = await delaunayGeometry(mirror());
  const edges =
    /^Locked edges that are not Delaunay: 1\. To save the texture, maxAttributeShift locks 1 edges, .*Infinity/;
  assert.match(hint, edges);
  assert.equal((await delaunayGeometry(mirror(), { maxAttributeShift: Infinity })).hint, undefined);
  const torus = await delaunayGeometry(new THREE.TorusGeometry(1, 0.4, 12, 48));
  assert.match(torus.hint, /are not Delaunay: 192\./);
  // Most edges flip.
  const knot = await delaunayGeometry(new THREE.TorusKnotGeometry(1, 0.3, 400, 24));
  assert.ok(knot.remaining.locked > 100);
  assert.equal(knot.hint, undefined);
  // Other locks are not the texture's.
  const plain = mirror([0, 0.5, 0.5, 0, 1, 0.5, 0.5, 1]);
  assert.equal((await delaunayGeometry(plain, { lockedEdges: [0, 2] })).hint, undefined);
});

test('each attribute may have a limit of its own', async () => {
  const colours = [0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 1];
  const coloured = () => mirror(colours, 'color', 3);
  assert.deepEqual(await run(coloured()), { flips: 1, shiftEdges: 0, largestShifts: {} });
  assert.equal((await run(coloured(), { maxAttributeShift: { color: 0.1 } })).flips, 0);
  assert.equal((await run(coloured(), { maxAttributeShift: { color: 2 } })).flips, 1);
  assert.equal((await run(coloured(), { maxAttributeShift: 0.1 })).flips, 1);
  assert.equal((await run(mirror(MIRROR, 'uv1'))).flips, 0);
  assert.equal((await run(mirror(MIRROR, 'uv1'), { maxAttributeShift: { uv1: Infinity } })).flips, 1);
  const both = () => mirror().setAttribute('color', coloured().attributes.color);
  assert.equal((await run(both(), { maxAttributeShift: { uv: Infinity } })).flips, 1);
  assert.equal((await run(both(), { maxAttributeShift: { color: 5 } })).flips, 0);
  const shifts = await run(both(), { maxAttributeShift: { uv: 1.5, color: 5 } });
  assert.deepEqual(Object.keys(shifts.largestShifts), ['uv', 'color']);
  // Integers stand for numbers from 0 to 1.
  const normalized = new THREE.BufferAttribute(
    Uint8Array.from(colours, (x) => 255 * x),
    3,
    true,
  );
  const bytes = () => mirror().setAttribute('color', normalized).deleteAttribute('uv');
  assert.equal((await run(bytes(), { maxAttributeShift: { color: 1.1 * Math.sqrt(3) } })).flips, 1);
  assert.equal((await run(bytes(), { maxAttributeShift: { color: 0.9 * Math.sqrt(3) } })).flips, 0);
});

test('joined vertices, seams, and the option weld', async () => {
  const soup = () => mirror().toNonIndexed();
  assert.deepEqual(await run(soup()), { flips: 0, shiftEdges: 1, largestShifts: { uv: 0 } });
  assert.equal((await run(soup(), { maxAttributeShift: Infinity })).flips, 1);
  // `weld: true` ignores attributes, unless there is a limit.
  assert.equal((await run(soup(), { weld: true })).flips, 1);
  assert.equal((await run(soup(), { weld: true, maxAttributeShift: TEXEL })).flips, 0);
  assert.equal((await run(mirror(), { weld: false })).flips, 0);
  // A renderer without a device of WebGPU.
  const renderer = { render: () => {} };
  assert.deepEqual(await run(mirror(), { renderer }), { flips: 0, shiftEdges: 1, largestShifts: { uv: 0 } });
  assert.equal((await run(mirror(), { renderer, maxAttributeShift: Infinity })).flips, 1);
  // A seam is locked by weld, and counted there.
  const seam = soup();
  seam.attributes.uv.setXY(0, 0.3, 0.3);
  const { shiftEdges, seamEdges } = await delaunayGeometry(seam);
  assert.deepEqual([shiftEdges, seamEdges], [0, 1]);
});

test('a vertex on an edge of a flat triangle', async () => {
  //   3      vertex 2 lies on the edge 0-1 of the flat triangle 0-1-2
  //  /|\
  // 0-2-1
  //  \|/
  //   4
  const points = [0, 0, 0, 2, 0, 0, 1, 0, 0, 1, 1.5, 0, 1, -1.5, 0];
  const indices = [0, 2, 3, 2, 1, 3, 0, 1, 2, 0, 4, 1];
  const at = (shift) => [0, 0, 1, 0, 0.5 + shift, 0, 0.5, 0.75, 0.5, -0.75];
  for (const [shift, expected] of [
    [0, 1],
    [0.5 * TEXEL, 1],
    [2 * TEXEL, 0],
  ]) {
    const { flips, shiftEdges, largestShifts } = await run(geometryOf(points, indices, { uv: [at(shift), 2] }));
    assert.deepEqual([flips, shiftEdges > 0], [expected, !expected], `${shift}`);
    if (expected) assert.ok(Math.abs(largestShifts.uv - shift) < 1e-6, `${largestShifts.uv}`);
  }
});

/** The value of an attribute of a mesh in the plane at a point. */
function valueAt({ points, indices, values }, [x, y]) {
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => indices[i + k]);
    const [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map((v) => [points[3 * v], points[3 * v + 1]]);
    const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
    const s = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area;
    const t = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area;
    if (s < -1e-12 || t < -1e-12 || s + t > 1 + 1e-12) continue;
    return [0, 1].map((k) => (1 - s - t) * values[2 * a + k] + s * values[2 * b + k] + t * values[2 * c + k]);
  }
  return undefined;
}

/** A number from 0 to 1 for each count. */
const random = (seed) => {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
};

/** The largest shift of a texture at random points of a mesh in the plane. */
function shiftAt(points, values, before, after, next) {
  let largest = 0;
  for (let i = 0; i < 400; i++) {
    const t = Math.floor((next() * after.length) / 3);
    const weights = [next(), next(), next()];
    const sum = weights[0] + weights[1] + weights[2];
    const at = [0, 1].map((k) =>
      [0, 1, 2].reduce((x, j) => x + (weights[j] * points[3 * after[3 * t + j] + k]) / sum, 0),
    );
    const [old, now] = [before, after].map((indices) => valueAt({ points, indices, values }, at));
    if (old && now) largest = Math.max(largest, Math.hypot(old[0] - now[0], old[1] - now[1]));
  }
  return largest;
}

/** Compares a run with its input at random points. */
async function holds(points, values, indices, most, next) {
  const geometry = geometryOf(points, [...indices], { uv: [values, 2] });
  const stored = [...geometry.attributes.uv.array];
  const places = [...geometry.attributes.position.array];
  const result = await delaunayGeometry(geometry, { maxAttributeShift: most });
  const after = [...geometry.index.array];
  const largest = shiftAt(places, stored, indices, after, next);
  assert.ok(result.largestShifts.uv <= most);
  assert.ok(largest <= result.largestShifts.uv + 1e-6, `${largest} of ${result.largestShifts.uv}`);
  return result;
}

test('many flips together shift a texture no further than the limit', async () => {
  // A fan from a far corner through points on a curve along which the texture bends slowly. Every flip alone is harmless.
  const count = 40;
  const arc = Array.from({ length: count + 1 }, (_, i) => (i / count - 0.5) * 2);
  const points = [0, -9, 0, ...arc.flatMap((x) => [x, -0.3 * x * x, 0])];
  const values = [0, 0, ...arc.flatMap((x) => [x, 0.05 * x * x])];
  const indices = arc.slice(1).flatMap((_, i) => [0, i + 2, i + 1]);
  const next = random(5);
  const free = await delaunayGeometry(geometryOf(points, indices, { uv: [values, 2] }), { maxAttributeShift: 1 });
  const most = 0.002;
  assert.ok(free.flips > 10 && free.largestShifts.uv > 10 * most, `${free.largestShifts.uv}`);
  const { flips, shiftEdges } = await holds(points, values, indices, most, next);
  assert.ok(flips > 0 && flips < free.flips && shiftEdges > 0, `${flips} of ${free.flips} flips, ${shiftEdges} edges`);
});

test('at random points of random meshes, no texture shifts further than the limit', async () => {
  let [flips, locked] = [0, 0];
  for (let seed = 1; seed <= 60; seed++) {
    const next = random(seed);
    const size = 4 + Math.floor(8 * next());
    const shear = 3 * next();
    const points = [];
    for (let y = 0; y <= size; y++) {
      for (let x = 0; x <= size; x++) points.push(x + 0.4 * next() + shear * y, y + 0.4 * next(), 0);
    }
    const indices = [];
    for (let y = 0; y < size; y++) {
      for (let x = 0; x < size; x++) {
        const [a, b] = [y * (size + 1) + x, (y + 1) * (size + 1) + x];
        indices.push(...(next() < 0.5 ? [a, a + 1, b, a + 1, b + 1, b] : [a, a + 1, b + 1, a, b + 1, b]));
      }
    }
    const kinds = [
      (x, y) => [x / 9 + 0.01 * Math.sin(x), y / 9 + 0.01 * Math.cos(y)],
      (x, y) => [Math.abs(x - 3) / 9, y / 9],
      (x, y) => [x / 9 + 0.0005 * next(), y / 9],
    ];
    const map = kinds[seed % 3];
    const values = [];
    for (let i = 0; i < points.length; i += 3) values.push(...map(points[i], points[i + 1]));
    const result = await holds(points, values, indices, [TEXEL, 4 * TEXEL][seed % 2], next);
    flips += result.flips;
    locked += result.shiftEdges;
  }
  assert.ok(flips > 500 && locked > 500, `${flips} flips, ${locked} edges`);
});

test('wrong limits are refused, and a broken geometry is an error of the geometry', async () => {
  const refused = (given, pattern, code = 'invalid-option') =>
    assert.rejects(delaunayGeometry(mirror(), { maxAttributeShift: given }), (error) => {
      assert.ok(error instanceof EdgeflipError, String(error));
      assert.equal(error.code, code);
      assert.match(error.message, pattern);
      return true;
    });
  await refused(-1, /^option maxAttributeShift: -1 is not a number of at least 0/);
  await refused(NaN, /NaN is not a number/);
  await refused('1', /'1' is not a number/);
  await refused(null, /null is not a number/);
  await refused({ uv: -1 }, /-1 is not a number of at least 0/);
  const thrown = new Proxy({}, { ownKeys: () => assert.fail('a trap') });
  await refused(thrown, /cannot be read: a trap/, 'invalid-input');
  await refused({ uvs: 1 }, /there is no attribute 'uvs'; there are uv/);
  const bare = mirror().deleteAttribute('uv');
  const only = /there is no attribute 'uv'; the geometry has only positions$/;
  await assert.rejects(run(bare, { maxAttributeShift: { uv: 1 } }), { code: 'invalid-option', message: only });
  assert.equal((await run(mirror(), { maxAttributeShift: { uv: undefined } })).flips, 0);
  const many = 200_000;
  const broken = geometryOf(new Array(3 * many).fill(NaN), [0, 1, 2], { uv: [new Array(2 * many).fill(0), 2] });
  await assert.rejects(delaunayGeometry(broken), { code: 'non-finite' });
  await assert.rejects(delaunayGeometry(mirror().setIndex([0, 1, 99])), { code: 'index-out-of-range' });
});

test('values that are not finite keep their edges, and missing ones are an error', async () => {
  const stays = { flips: 0, shiftEdges: 1, largestShifts: { uv: 0 } };
  const plain = [0, 0.5, 0.5, 0, 1, 0.5, 0.5, 1];
  for (const value of [NaN, Infinity, -Infinity]) {
    for (const i of plain.keys()) {
      assert.deepEqual(await run(mirror(plain.with(i, value))), stays, `${value} at ${i}`);
      assert.deepEqual(await run(mirror(plain.with(i, value)).toNonIndexed()), stays, `${value} at ${i}, joined`);
    }
    const all = plain.map(() => value);
    for (const options of [{}, { weld: false }, { weld: true, maxAttributeShift: TEXEL }]) {
      assert.deepEqual(await run(mirror(all), options), stays);
    }
    assert.deepEqual(await run(mirror(all).toNonIndexed()), stays);
    assert.equal((await run(mirror(all), { maxAttributeShift: Infinity })).flips, 1);
  }
  // Beside such a vertex, other edges flip.
  const plane = new THREE.PlaneGeometry(4, 1, 8, 8);
  plane.applyMatrix4(new THREE.Matrix4().makeShear(0, 0, 0.9, 0, 0, 0));
  const { flips } = await run(plane.clone());
  plane.attributes.uv.setX(40, NaN);
  const found = await run(plane);
  assert.ok(found.flips > flips / 2 && found.flips < flips, `${found.flips} of ${flips}`);
  assert.ok(found.largestShifts.uv < TEXEL);
  for (const options of [{}, { weld: false }, { weld: false, maxAttributeShift: { uv1: 1 } }]) {
    const short = mirror().setAttribute('uv1', new THREE.Float32BufferAttribute([0, 0, 1, 1], 2));
    await assert.rejects(run(short, options), {
      code: 'invalid-input',
      message: 'attribute uv1: it has 2 vertices, and position has 4',
    });
  }
});

test('a vertex with very many triangles takes no longer than others', async () => {
  const count = 60_000;
  const points = [0, 0, 0];
  const [uv, indices] = [[0.5, 0.5], []];
  for (let i = 0; i < count; i++) {
    const [x, y] = [Math.cos, Math.sin].map((of) => of((2 * Math.PI * i) / count));
    points.push(x, y, 0);
    uv.push(0.5 + x / 2, 0.5 + y / 2);
    indices.push(0, i + 1, ((i + 1) % count) + 1);
  }
  const start = performance.now();
  const { shiftEdges } = await delaunayGeometry(geometryOf(points, indices, { uv: [uv, 2] }), { weld: false });
  assert.equal(shiftEdges, 0);
  assert.ok(performance.now() - start < 30_000);
});

/** A document with the mirror, and the lines of its logger. */
function documentOf(values, type = 'VEC2', semantic = 'TEXCOORD_0') {
  const document = new Document();
  const buffer = document.createBuffer();
  const accessor = (array, type) => document.createAccessor('', buffer).setType(type).setArray(array);
  const primitive = document
    .createPrimitive()
    .setAttribute('POSITION', accessor(Float32Array.from(POINTS), 'VEC3'))
    .setAttribute(semantic, accessor(Float32Array.from(values), type))
    .setIndices(accessor(Uint16Array.of(0, 1, 2, 0, 2, 3), 'SCALAR'));
  document.createMesh().addPrimitive(primitive);
  const lines = [];
  document.setLogger({ debug: () => {}, info: (line) => lines.push(line), warn: () => {}, error: () => {} });
  return { document, lines, indices: () => [...primitive.getIndices().getArray()].join() };
}

test('the transform of glTF-Transform has the same limit, and its line counts the edges', async () => {
  const transformed = async (options, ...given) => {
    const { document, lines, indices } = documentOf(...given);
    const before = indices();
    await document.transform(delaunay(options));
    return [indices() !== before, lines.join()];
  };
  const [isTorn, line] = await transformed({}, MIRROR);
  assert.equal(isTorn, false);
  assert.match(line, /locked 1; maxAttributeShift locked 1 edges; largest shifts: TEXCOORD_0 0$/);
  assert.deepEqual((await transformed({ maxAttributeShift: Infinity }, MIRROR))[0], true);
  assert.deepEqual((await transformed({ weld: true }, MIRROR))[0], true);
  assert.deepEqual((await transformed({}, MIRROR.with(2, NaN)))[0], false);
  assert.deepEqual((await transformed({}, MIRROR, 'VEC2', 'TEXCOORD_1'))[0], false);
  const colours = [0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 1];
  assert.equal((await transformed({}, colours, 'VEC3', 'COLOR_0'))[0], true);
  assert.equal((await transformed({ maxAttributeShift: { COLOR_0: 0.1 } }, colours, 'VEC3', 'COLOR_0'))[0], false);
  await assert.rejects(transformed({ maxAttributeShift: { COLOR_0: 0.1 } }, MIRROR), {
    code: 'invalid-option',
    message: /there is no attribute 'COLOR_0'; there are TEXCOORD_0/,
  });
  await assert.rejects(transformed({ maxAttributeShift: -1 }, MIRROR), { code: 'invalid-option' });
});
