// Polygons with holes from points: delaunator, then constraints and regions. Uses the existing dist/.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import Delaunator from 'delaunator';
import { FlipSession } from 'edgeflip';
import { constrain, regions } from 'edgeflip/files';
import { orient2d } from 'robust-predicates';
import { areaOf, polygons } from './polygons.mjs';

/** The fixtures whose sides cross. */
const CROSSING = ['bad-hole.json', 'water-huge.json', 'water-huge2.json', 'water.json'];

const RUNS = [{ threads: 1 }, { threads: 2 }, { order: 'any' }];

/** Whether two segments cross in the inside of both. */
function cross(positions, [a, b], [c, d]) {
  const turn = (...vertices) =>
    Math.sign(orient2d(...vertices.flatMap((vertex) => [positions[2 * vertex], positions[2 * vertex + 1]])));
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

/** Runs with the sides as constraints, and checks the result. Returns the area inside, if no side was left out. */
async function triangulated({ positions, sides }, options) {
  const mesh = { positions, indices: new Delaunator(positions).triangles, dimension: 2 };
  const constraints = sides.flat();
  const { constraintEdges, leftOut } = await constrain(mesh, constraints, {}, true);
  const session = await FlipSession.create(mesh, { backend: 'cpu', constraints, skipConstraints: true, ...options });
  const { indices, remaining, leftOut: alsoLeftOut } = await session.run();
  assert.deepEqual(alsoLeftOut, leftOut);
  const audit = await session.verify();
  session.free();
  assert.deepEqual([audit.clean, audit.remaining], [true, remaining]);
  assert.ok(Object.keys(remaining).every((reason) => reason === 'locked'));
  // Each reason is true: the two constraints cross.
  for (const { index, reason } of leftOut) {
    const other = Number(/ crosses constraint (\d+) /.exec(reason)[1]);
    assert.ok(other < index && cross(positions, sides[index], sides[other]), reason);
  }
  const { inside } = await regions({ ...mesh, indices }, constraintEdges);
  if (leftOut.length > 0) {
    const reason = { code: 'invalid-option', message: `option constraints: ${leftOut[0].reason}` };
    await assert.rejects(FlipSession.create(mesh, { backend: 'cpu', constraints }), reason);
    return undefined;
  }
  const corner = (vertex) => [positions[2 * vertex], positions[2 * vertex + 1]];
  const areas = [...inside].map((is, t) => is * areaOf([...indices.subarray(3 * t, 3 * t + 3)].map(corner)));
  return areas.reduce((sum, area) => sum + area, 0);
}

for (const { name, area: wanted, ...given } of polygons) {
  test(`the polygons of ${name}`, async () => {
    for (const options of RUNS) {
      const area = await triangulated(given, options);
      if (CROSSING.includes(name)) assert.equal(area, undefined);
      else assert.ok(Math.abs(area - wanted) <= 1e-12 * wanted, `${area}, not ${wanted}`);
    }
  });
}

// Issue 15 of constrainautor, which does not end. delaunator takes the last point for a second copy of the third.
test('a point that delaunator leaves out is named', async () => {
  const points = [
    [0, 0],
    [0.05626429153399996, 0],
    [0.024093852080076722, 4.80267923973791e-18],
    [0.01379050745122589, 0.1463775332929564],
    [0.05177587092034522, 0.015468457826306506],
    [0.024093852080076705, -5.204170427930421e-18],
  ];
  const positions = new Float64Array(points.flat());
  const mesh = { positions, indices: new Delaunator(positions).triangles, dimension: 2 };
  const { leftOut } = await constrain(mesh, [0, 5, 5, 2, 0, 2], {}, true);
  assert.deepEqual(
    leftOut.map(({ reason }) => reason),
    [
      'constraint 0 between 0 and 5 ends at vertex 5, which no triangle has; weld it if another vertex is there',
      'constraint 1 between 5 and 2 ends at vertex 5, which no triangle has; weld it if another vertex is there',
    ],
  );
});
