/** The lines of JavaScript that keep a mesh Delaunay while it moves. */

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
