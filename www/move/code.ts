/** The lines of JavaScript that keep a mesh, or points, Delaunay while they move. */

import type { Motion } from './motions.ts';

export function codeFor(motion: Motion, triangles: number): string {
  const options = motion.dimension === 3 ? `{ maxNormalAngle: ${motion.beta} }` : '';
  return [
    `import { FlipSession } from 'edgeflip';`,
    `import { generate } from 'edgeflip/files';`,
    '',
    `const { positions, indices, dimension } = await generate('${motion.spec(triangles)}');`,
    'const mesh = { positions: Float32Array.from(positions), indices, dimension };',
    `const session = await FlipSession.create(mesh${options && `, ${options}`});`,
    'await session.run();',
    'const moved = mesh.positions.slice();',
    'for (let frame = 0; frame < 60; frame++) {',
    '  for (let i = 0; i < moved.length; i++) moved[i] = mesh.positions[i] * (1 + 0.1 * Math.sin(i + frame / 10));',
    '  session.update({ positions: moved });',
    '}',
    'const triangles = await session.triangles();',
    '',
  ].join('\n');
}

export const CODE_FOR_POINTS = `import { PointSession } from 'edgeflip/points';

const points = new Float32Array(2000);
const place = (time) => {
  for (let i = 0; i < 1000; i++) {
    const [radius, angle] = [Math.sqrt(i) * (1 + 0.1 * Math.sin(i + time)), 2.4 * i + time / (1 + Math.sqrt(i))];
    points.set([radius * Math.cos(angle), radius * Math.sin(angle)], 2 * i);
  }
};
place(0);
const session = await PointSession.create(points);
for (let frame = 1; frame <= 60; frame++) {
  place(frame / 10);
  session.update(points);
}
session.moveTo(0, 50, 0); // across the hull
const triangles = session.triangles();
`;
