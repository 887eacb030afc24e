// One call makes a mesh Delaunay: `node examples/one-call.mjs`, after `npm run build`.

import { makeDelaunay } from 'edgeflip';

// A thin diamond, split along its long diagonal.
const positions = new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1]);
const indices = new Uint32Array([0, 1, 2, 0, 2, 3]);
const result = await makeDelaunay({ positions, indices, dimension: 2 });
console.log(`${result.flips} flip on ${result.backend}: ${result.indices}`);
console.log('edges that are still not Delaunay, by reason:', result.remaining);
