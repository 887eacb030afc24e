// A session runs step by step, then to its end with progress: `node examples/step-by-step.mjs`, after `npm run build`.

import { FlipSession } from 'edgeflip';
import { generate } from 'edgeflip/files';

const session = await FlipSession.create(await generate('random 60'));
for await (const { index, labelled, flips } of session) {
  console.log(`iteration ${index}: ${labelled} edges may flip, ${flips} flip`);
  if (index === 1) break; // the session continues from here
}

const { status, remaining } = await session.run({
  signal: AbortSignal.timeout(60_000),
  onProgress: ({ iterations, flips }) => console.log(`${flips} flips in ${iterations} iterations`),
});
console.log(`${status}; edges that are still not Delaunay, by reason:`, remaining);
session.free();
