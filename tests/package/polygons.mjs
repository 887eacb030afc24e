// Polygons as points and sides: those of earcut's tests, and the inputs of issues of constrainautor.

import { readdirSync, readFileSync } from 'node:fs';

const fixtures = new URL('../../node_modules/earcut-fixtures/test/fixtures/', import.meta.url);

/** The different points of rings, and their sides as pairs of vertices. */
function pointsAndSides(rings) {
  const vertices = new Map();
  const at = ([x, y]) => {
    const key = `${x} ${y}`;
    if (!vertices.has(key)) vertices.set(key, vertices.size);
    return vertices.get(key);
  };
  const sides = rings.flatMap((ring) =>
    ring.map((point, i) => [at(ring[(i || ring.length) - 1]), at(point)]).filter(([u, v]) => u !== v),
  );
  const positions = Float64Array.from([...vertices.keys()].flatMap((key) => key.split(' ').map(Number)));
  return { positions, sides };
}

/** The area of a ring, by its corners. */
export function areaOf(ring) {
  const twice = ring.reduce((sum, [x, y], i) => {
    const [p, q] = ring[(i || ring.length) - 1];
    return sum + p * y - x * q;
  }, 0);
  return Math.abs(twice) / 2;
}

/** Inputs of issues of constrainautor: of issue 4, and as that of issue 2. */
const issues = {
  'edges that others have to give way to': {
    points: [
      [544, 480],
      [512, 192],
      [544, 160],
      [512, 384],
      [512, 224],
      [544, 320],
      [704, 128],
      [576, 352],
      [672, 352],
      [576, 128],
      [608, 384],
      [672, 96],
      [640, 96],
      [608, 160],
      [672, 160],
      [608, 288],
    ],
    sides: [
      [1, 2],
      [4, 5],
      [5, 0],
      [6, 8],
      [8, 7],
      [7, 9],
    ],
  },
  'sides along the points of a lattice, each twice': {
    points: Array.from({ length: 144 }, (_, i) => [i % 12, Math.floor(i / 12)]),
    sides: [26, 33, 117, 110].flatMap((corner, i, all) => [
      [all[(i || 4) - 1], corner],
      [corner, all[(i || 4) - 1]],
    ]),
  },
};

/**
 * @typedef {{ name: string, positions: Float64Array, sides: number[][], area: number }} Polygons
 *   `area` is that inside, if no sides cross.
 */

/** @type {Polygons[]} */
export const polygons = [
  ...readdirSync(fixtures).flatMap((name) => {
    const rings = JSON.parse(readFileSync(new URL(name, fixtures), 'utf8'));
    // Two files are lists of numbers.
    if (!Array.isArray(rings[0]?.[0])) return [];
    const [outer, ...holes] = rings.map(areaOf);
    return { name, ...pointsAndSides(rings), area: holes.reduce((rest, hole) => rest - hole, outer) };
  }),
  // No closed polygon, and one that is given twice.
  ...Object.entries(issues).map(([name, { points, sides }]) => {
    return { name, positions: Float64Array.from(points.flat()), sides, area: 0 };
  }),
];
