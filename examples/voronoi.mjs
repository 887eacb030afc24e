// A Voronoi diagram as a picture, in place of d3-delaunay: `node examples/voronoi.mjs voronoi.svg`, after `npm run build`.

import { writeFileSync } from 'node:fs';
import { triangulate, voronoi } from 'edgeflip/points';

const [width, height] = [960, 500];
const points = Array.from({ length: 400 }, (_, i) => [(i * 0.618034 * width) % width, (i * i * 1.2345) % height]);
const triangulation = await triangulate(points); // in place of Delaunay.from(points)
const { starts, corners } = await voronoi(points, triangulation, { bounds: [0, 0, width, height] });
const cell = (i) => corners.subarray(2 * starts[i], 2 * starts[i + 1]); // in place of cellPolygon(i)
const shapes = points.map(([x, y], i) => `<polygon points="${cell(i)}"/><circle cx="${x}" cy="${y}" r="2"/>`);

const style = '<style>polygon { fill: none; stroke: #333 }</style>';
const picture = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}">${style}`;
writeFileSync(process.argv[2] ?? 'voronoi.svg', `${picture}\n${shapes.join('\n')}\n</svg>\n`);
console.log(`${points.length} cells with ${corners.length / 2} corners`);
