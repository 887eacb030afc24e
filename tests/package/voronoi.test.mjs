// Voronoi diagrams of the entry `edgeflip/points` in Node: next to d3-delaunay, every form of input, and errors. The cells
// are compared with their definition in tests/native/points/voronoi.rs.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { test } from 'node:test';
import { Delaunay } from 'd3-delaunay';
import { init, PointSession, triangulateSync, voronoi, voronoiSync } from 'edgeflip/points';
import { KINDS, randomOf, refused } from './points.mjs';

await init();
const NONE = 0xffffffff;

/** The corners of a cell. */
const cellOf = ({ starts, corners }, i) =>
  Array.from({ length: starts[i + 1] - starts[i] }, (_, k) => [...corners.subarray(2 * (starts[i] + k)).slice(0, 2)]);

/** Twice the area of a polygon. */
const areaOf = (polygon) =>
  polygon.reduce((sum, [x, y], k) => {
    const [[ox, oy], [nx, ny]] = [polygon[0], polygon[(k + 1) % polygon.length]];
    return sum + (x - ox) * (ny - oy) - (y - oy) * (nx - ox);
  }, 0);

const diagramOf = (points, bounds) => voronoiSync(points, triangulateSync(points), { bounds });

/** The sum of the areas of all cells, in areas of the box. */
function filled(diagram, [left, bottom, right, top]) {
  let sum = 0;
  for (let i = 0; i + 1 < diagram.starts.length; i++) sum += areaOf(cellOf(diagram, i));
  return sum / (2 * (right - left) * (top - bottom));
}

test('before `init`, the error says what to do; `voronoi` loads the module itself', () => {
  const program = `import { triangulate, voronoi, voronoiSync } from 'edgeflip/points';
    const points = Float64Array.of(0, 0, 2, 0, 0, 2);
    const given = { triangles: Uint32Array.of(0, 1, 2), twins: Int32Array.of(-1, -1, -1), hull: [], duplicates: [] };
    try { voronoiSync(points, given); } catch ({ code, message }) { console.log(code, message); }
    const asked = voronoi(points, given);
    points.fill(NaN);
    given.triangles.fill(7);
    const { circumcentres, starts, corners } = await asked;
    console.log(circumcentres.join(), starts.join(), corners.join());`;
  const { stdout, stderr } = spawnSync(process.execPath, ['--input-type=module', '-e', program], { encoding: 'utf8' });
  const expected = [
    'load-failed the module of the points is not loaded; call `await init()` before voronoiSync',
    '1,1 0,4,8,12 1,0,1,1,0,1,0,0,2,2,1,1,1,0,2,0,0,1,1,1,2,2,0,2',
  ];
  assert.equal(stdout, `${expected.join('\n')}\n`, stderr);
});

/** Two polygons are the same up to their first corner and rounding. */
function assertSame(ours, theirs, size, what) {
  assert.equal(ours.length, theirs.length, `${what}: ${JSON.stringify([ours, theirs])}`);
  const distance = ([ax, ay], [bx, by]) => Math.hypot(ax - bx, ay - by);
  const nearest = theirs.reduce((best, p, k) => (distance(p, ours[0]) < distance(theirs[best], ours[0]) ? k : best), 0);
  ours.forEach((p, k) => {
    assert.ok(distance(p, theirs[(nearest + k) % theirs.length]) < 1e-9 * size, what);
  });
}

test('the cells are those of d3-delaunay', () => {
  const random = randomOf(11);
  for (const count of [1, 2, 3, 10, 300, 5000]) {
    const points = Float64Array.from({ length: 2 * count }, () => random(2 ** 20) / 2 ** 10);
    const delaunay = new Delaunay(points);
    for (const bounds of [
      [0, 0, 1024, 1024],
      [-100, -200, 1500, 1300],
      [400.25, 300.5, 600, 700],
      [-3000, 0, -2000, 500],
    ]) {
      const diagram = diagramOf(points, bounds);
      const other = delaunay.voronoi(bounds);
      for (let i = 0; i < count; i++) {
        // Its polygons are closed, and in the other direction, because its y is down.
        const polygon = other.cellPolygon(i)?.slice(1) ?? [];
        if (areaOf(polygon) < 0) polygon.reverse();
        const what = `${count} points, cell ${i} in ${bounds}`;
        // It halves the side between two points.
        if (count === 2) assert.ok(Math.abs(areaOf(cellOf(diagram, i)) - areaOf(polygon)) < 1e-3, what);
        else assertSame(cellOf(diagram, i), polygon, 1024, what);
      }
      assert.ok(Math.abs(filled(diagram, bounds) - 1) < 1e-9);
    }
  }
});

test('the cells of every kind of points fill the box', () => {
  for (const [name, kind] of Object.entries(KINDS)) {
    const random = randomOf(name.length);
    for (let i = 0; i < 40; i++) {
      const points = kind(1 + random(40), random);
      const [xs, ys] = [0, 1].map((axis) => points.map((point) => point[axis]));
      const bounds = [
        Math.min(...xs) - random(2),
        Math.min(...ys) - 1,
        Math.max(...xs) + 1,
        Math.max(...ys) + random(2),
      ];
      if (bounds[3] <= bounds[1]) bounds[3] = bounds[1] + 1;
      const diagram = diagramOf(points, bounds);
      assert.ok(Math.abs(filled(diagram, bounds) - 1) < 1e-9, `${name}: ${JSON.stringify(points)}`);
      const { triangles } = triangulateSync(points);
      assert.equal(diagram.circumcentres.length, (2 / 3) * triangles.length);
    }
  }
});

// https://github.com/d3/d3-delaunay/issues: 29, 65 and 141.
test('points that d3-delaunay had trouble with', () => {
  const bounds = [0, 0, 960, 500];
  for (const points of [
    [
      [100, 100],
      [200, 100],
      [100, 200],
    ],
    Array.from({ length: 100 }, (_, i) => [1 + 0.001 * i, 0.1 + 0.01 * i]),
    [[10, 190], ...Array.from({ length: 7 }, (_, i) => [i * 80, (i * 50) / 7])],
    Array.from({ length: 200 }, (_, i) => [480 + 200 * Math.cos(i), 250 + 200 * Math.sin(i)]),
    [
      [289.5015212245313, 124.5],
      [670.5, 124.5],
      [289.5, 375.5],
      [670.5, 375.5000000001],
      [480, 250],
    ],
  ]) {
    const diagram = diagramOf(points, bounds);
    assert.ok(Math.abs(filled(diagram, bounds) - 1) < 1e-12);
    points.forEach(([x, y], i) => {
      const cell = cellOf(diagram, i);
      const isInside = cell.every(([px, py], k) => {
        const [qx, qy] = cell[(k + 1) % cell.length];
        return (qx - px) * (y - py) - (qy - py) * (x - px) > -1e-9;
      });
      assert.ok(isInside && (cell.length > 2 || x < 0 || x > 960 || y < 0 || y > 500), `${i}`);
    });
  }
});

test('few points, equal points and points on a line have their cells', () => {
  const bounds = [0, 0, 4, 2];
  const cells = (points) => {
    const diagram = diagramOf(points, bounds);
    return points.map((_, i) => cellOf(diagram, i).sort());
  };
  const half = (left) => [[left, 0], [left, 2], [left + 2, 0], [left + 2, 2]]; // biome-ignore format: a box
  assert.deepEqual([...voronoiSync([], triangulateSync([]), { bounds }).starts], [0]);
  assert.deepEqual(cells([[7, 7]]), [[[0, 0], [0, 2], [4, 0], [4, 2]]]); // biome-ignore format: a box
  assert.deepEqual(cells([[3, 1], [3, 1], [1, 1]]), [half(2), [], half(0)]); // biome-ignore format: three points
  assert.deepEqual(cells([[5, 1], [3, 1], [1, 1]]), [[], half(2), half(0)]); // biome-ignore format: three points
});

test('each form of the same input gives the same cells', async () => {
  const random = randomOf(3);
  const numbers = Array.from({ length: 400 }, () => random(100));
  const pairs = Array.from({ length: 200 }, (_, i) => numbers.slice(2 * i, 2 * i + 2));
  const triangulation = triangulateSync(numbers);
  const bounds = [5, 5, 90, 80];
  const expected = voronoiSync(numbers, triangulation, { bounds });
  const spaced = Int16Array.from(pairs.flatMap(([x, y]) => [77, x, y]));
  const accessors = { x: ([x]) => x, y: ([, y]) => y };
  const lists = ['triangles', 'twins', 'hull', 'duplicates'].map((name) => [name, [...triangulation[name]]]);
  for (const [points, given, options] of [
    [Float32Array.from(numbers), triangulation, { bounds }],
    [Uint8Array.from(numbers), triangulation, { bounds: Uint8Array.from(bounds) }],
    [spaced, triangulation, { bounds, stride: 3, offset: 1 }],
    [pairs, { ...triangulation, hint: 7 }, { bounds: Float32Array.from(bounds) }],
    [pairs, { ...triangulation, twins: new Int32Array(triangulation.twins) }, { ...accessors, bounds }],
    [numbers, Object.fromEntries(lists), { bounds }],
    [numbers, { ...triangulation, hull: [] }, { bounds }],
  ]) {
    assert.deepEqual(voronoiSync(points, given, options), expected);
    assert.deepEqual(await voronoi(points, given, options), expected);
  }
  const box = [Math.min, Math.max].flatMap((most) => [0, 1].map((axis) => most(...pairs.map((pair) => pair[axis]))));
  assert.deepEqual(voronoiSync(numbers, triangulation), voronoiSync(numbers, triangulation, { bounds: box }));
  assert.deepEqual(await voronoi(numbers, triangulation, { bounds: undefined }), voronoiSync(numbers, triangulation));
});

test('the triangulation of a session has cells, unless a point was removed', async () => {
  const random = randomOf(23);
  const points = Array.from({ length: 200 }, () => [random(1000), random(1000)]);
  const bounds = [0, 0, 1000, 1000];
  const session = await PointSession.create(points);
  for (const [i, [x, y]] of points.entries()) if (i % 7 === 0) points[i] = [y, x];
  session.update(points);
  points.push([-5, 500]);
  session.add(-5, 500);
  const diagram = voronoiSync(points, session.triangulation(), { bounds });
  assert.deepEqual(diagram, diagramOf(points, bounds));
  session.remove(100);
  assert.throws(
    () => voronoiSync(points, session.triangulation(), { bounds }),
    refused('invalid-input', /^triangulation: a point is neither in it nor a duplicate; /),
  );
  session.free();
});

test('the caller keeps its arrays, and gets arrays of its own', () => {
  const points = Float64Array.of(0, 0, 4, 0, 4, 3, 0, 3, 4, 0);
  const triangulation = triangulateSync(points);
  const copies = structuredClone([points, triangulation]);
  const first = voronoiSync(points, triangulation);
  assert.deepEqual([points, triangulation], copies);
  for (const list of Object.values(first)) assert.equal(list.buffer.byteLength, list.byteLength);
  const copy = structuredClone(first);
  diagramOf(
    Float32Array.from({ length: 2000 }, (_, i) => (i * i) % 997),
    [0, 0, 9, 9],
  );
  assert.deepEqual(first, copy);
});

test('wrong arguments are named', async () => {
  const points = [0, 0, 4, 0, 0, 4];
  const good = triangulateSync(points);
  const line = [0, 1, 2, 1, 3, 1];
  const mine = new Error('mine');
  const throwing = {
    get triangles() {
      throw mine;
    },
  };
  for (const [given, triangulation, options, code, message] of [
    [points, undefined, {}, 'invalid-input', /^triangulation: undefined is not an object$/],
    [points, {}, {}, 'invalid-input', /^triangulation\.triangles: it|^triangulation\.triangles: undefined is/],
    [points, throwing, {}, 'invalid-input', /^the triangulation cannot be read: mine$/],
    [points, { ...good, twins: 'none' }, {}, 'invalid-input', /^triangulation\.twins: 'none' is/],
    [points, { ...good, hull: new Float32Array(3) }, {}, 'invalid-input', /^triangulation\.hull: a Float32Array is/],
    [points, { ...good, triangles: [0, 1] }, {}, 'ragged-array', /^triangulation\.triangles has 2 numbers, not a mul/],
    [points, { ...good, duplicates: [0] }, {}, 'ragged-array', /^triangulation\.duplicates has 1 numbers/],
    [points, { ...good, triangles: [0, 1, 9] }, {}, 'index-out-of-range', /^triangle 0: index 9 is .* are 3 points$/],
    [points, { ...good, triangles: [0, 2, 1] }, {}, 'invalid-input', /^triangulation: a triangle .* unchanged$/],
    [points, { ...good, triangles: [] }, {}, 'invalid-input', /^triangulation: it has another number of twins/],
    [points, { ...good, twins: [1, 0, NONE] }, {}, 'invalid-input', /^triangulation: a twin of it/],
    [points, { ...good, twins: [0, 1, 2] }, {}, 'invalid-input', /^triangulation: a twin of it/],
    [points, { ...good, twins: [NONE, NONE, 7] }, {}, 'invalid-input', /^triangulation: a twin of it/],
    [[...points, 9, 9], good, {}, 'invalid-input', /^triangulation: a point is neither in it nor a duplicate/],
    [[...points, 0, 0], { ...good, duplicates: [3, 1] }, {}, 'invalid-input', /^triangulation: its duplicates/],
    [points.slice(2), good, {}, 'index-out-of-range', /^triangle 0: index 2/],
    [[0, 0, NaN, 0, 0, 4], good, {}, 'non-finite', /^point 1: coordinate x is NaN/],
    [[0, 0, 4], good, {}, 'ragged-array', /^points: the last point has 1 of 2 coordinates/],
    [line, triangulateSync(line), {}, 'invalid-option', /^option bounds: there are no two points .* pass the bounds$/],
    [[], triangulateSync([]), {}, 'invalid-option', /^option bounds: there are no two points/],
    [points, good, { bounds: [0, 0, 1] }, 'invalid-option', /^option bounds: it has 3 numbers, not the 4 of \[xmin, /],
    [
      points,
      good,
      { bounds: [0, 0, 0, 1] },
      'invalid-option',
      /^option bounds: give finite \[xmin, ymin, xmax, ymax\]/,
    ],
    [points, good, { bounds: [0, 0, 1, NaN] }, 'invalid-option', /^option bounds: give finite/],
    [points, good, { bounds: '0011' }, 'invalid-input', /^bounds: '0011' is neither/],
    [points, good, { bounds: [[0, 0], [1, 1]] }, 'invalid-input', /^bounds: it is neither/], // biome-ignore format: short
    [points, good, { bound: [0, 0, 1, 1] }, 'invalid-option', /bound is not an option; did you mean bounds\?$/],
    [points, good, null, 'invalid-input', /^options: null is not an object$/],
  ]) {
    assert.throws(() => voronoiSync(given, triangulation, options), refused(code, message), `${message}`);
    await assert.rejects(voronoi(given, triangulation, options), refused(code, message));
  }
  const failing = () => {
    throw mine;
  };
  assert.throws(
    () => voronoiSync([[0, 0]], good, { x: failing, y: failing }),
    (error) => error === mine,
  );
  assert.deepEqual([...voronoiSync(points, good).starts], [0, 4, 8, 12]);
});

test('ten thousand calls leave nothing behind', async () => {
  const points = [0, 0, 4, 1, 5, 3, 1, 3, 2, 2];
  const triangulation = triangulateSync(points);
  const { memory } = await (await import('../../dist/wasm/edgeflip_points.js')).default();
  const call = () => voronoiSync(points, triangulation).starts.length;
  for (let i = 0; i < 100; i++) call();
  const bytes = memory.buffer.byteLength;
  for (let i = 0; i < 10_000; i++) assert.equal(call(), 6);
  assert.equal(memory.buffer.byteLength, bytes);
});

test('points that do not fit into the memory are refused, and the next call works', () => {
  const { triangles, twins, hull, duplicates } = triangulateSync([0, 0, 1, 0, 0, 1]);
  const given = { triangles, twins, hull, duplicates };
  for (const huge of [new Float32Array(2 ** 27), new Float64Array(2 ** 28), new Uint8Array(2 ** 29)]) {
    assert.throws(() => voronoiSync(huge, given, { bounds: [0, 0, 1, 1] }), refused('too-large', /memory|bytes/));
  }
  const words = { ...given, duplicates: new Uint32Array(2 ** 29) };
  assert.throws(() => voronoiSync([0, 0, 1, 0, 0, 1], words), refused('too-large', /memory|bytes/));
  assert.equal(voronoiSync([0, 0, 1, 0, 0, 1], given).starts.length, 4);
});
