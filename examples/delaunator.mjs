// delaunator triangulates points once; when they move, edgeflip keeps the triangulation Delaunay, and the vertices keep
// their neighbours where nothing flips: `node examples/delaunator.mjs`, after `npm run build`.

import Delaunator from 'delaunator';
import { FlipSession } from 'edgeflip';

const count = 2000;
const points = Float64Array.from({ length: 2 * count }, (_, i) => (i % 2 ? (i * 0.618034) % 1 : i / (2 * count)));
const { triangles } = new Delaunator(points);
const session = await FlipSession.create({ positions: points, indices: triangles, dimension: 2 });

for (let frame = 1; frame <= 5; frame++) {
  // A slow shear turns no triangle over.
  for (let i = 0; i < count; i++) points[2 * i] += 0.05 * points[2 * i + 1];
  await session.setPositions(points);
  const { flips, remaining } = await session.run();
  console.log(`frame ${frame}: ${flips} flips; edges that are still not Delaunay:`, remaining);
}
session.free();
