// A map, from points to a picture: delaunator triangulates the points of the borders, edgeflip brings the borders in, and
// the regions tell states from sea. `node examples/map.mjs map.svg`, after `npm run build`.

import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import Delaunator from 'delaunator';
import { makeDelaunay } from 'edgeflip';
import { constrain, regions } from 'edgeflip/files';
import { feature } from 'topojson-client';

// The states of the USA, by its Census Bureau, in the public domain, as polygons of GeoJSON.
const path = createRequire(import.meta.url).resolve('us-atlas/states-albers-10m.json');
const map = JSON.parse(readFileSync(path, 'utf8'));
const rings = feature(map, map.objects.states).features.flatMap(({ geometry: { type, coordinates } }) =>
  type === 'Polygon' ? coordinates : coordinates.flat(),
);

// A vertex for each point, and the sides of the rings as pairs of vertices. Two states have most borders in common.
const vertices = new Map();
const vertexAt = ([x, y]) => {
  const key = `${x} ${y}`;
  if (!vertices.has(key)) vertices.set(key, vertices.size);
  return vertices.get(key);
};
// The coordinates are rounded, so a point may come twice in a row.
const sides = rings.flatMap((ring) => {
  const corners = ring.map(vertexAt).filter((vertex, i, all) => vertex !== all[i - 1]);
  return corners.slice(1).flatMap((vertex, i) => [corners[i], vertex]);
});
const positions = Float64Array.from([...vertices.keys()].flatMap((key) => key.split(' ').map(Number)));

const points = { positions, indices: new Delaunator(positions).triangles, dimension: 2 };
const { indices: start, lockedEdges, constraintEdges, crossedEdges } = await constrain(points, sides);
const { indices } = await makeDelaunay({ ...points, indices: start }, { lockedEdges });
const { inside, ofTriangles } = await regions({ ...points, indices }, constraintEdges);

const corner = (vertex) => `${positions[2 * vertex]} ${positions[2 * vertex + 1]}`;
const land = Array.from(inside.keys()).filter((t) => inside[t] === 1);
const triangles = land.map((t) => {
  const corners = [...indices.subarray(3 * t, 3 * t + 3)].map(corner);
  return `<path fill="hsl(${(ofTriangles[t] * 137) % 360} 45% 70%)" d="M${corners.join('L')}Z"/>`;
});
const picture = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 975 610" stroke="#333" stroke-width="0.15">
${triangles.join('\n')}
</svg>
`;
writeFileSync(process.argv[2] ?? 'map.svg', picture);
console.log(
  `${vertices.size} points; ${crossedEdges} edges made way for the borders; ${land.length} triangles of states`,
);
