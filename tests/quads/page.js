// Runs batches of quads on an engine of this browser, for browsers.mjs.

import { FlipSession } from '../../dist/index.js';

const read = async (file) => (await fetch(new URL(`../../target/quads/${file}`, import.meta.url))).arrayBuffer();

/** As `Verdict` in batch.rs. */
const LABELLED = 1;

/**
 * Runs one iteration of a batch. Returns the engine's counts before it, and the quads with wrong triangles after it.
 * The mesh has the layout of `Batch` in batch.rs.
 */
window.iterate = async ({ index, dimension, isWide, beta, deviation }, backend) => {
  const numbers = new Float64Array(await read(`${index}.positions`));
  const positions = isWide ? numbers : Float32Array.from(numbers);
  const verdicts = new Uint8Array(await read(`${index}.verdicts`));
  const of = (a, isFlipped) =>
    isFlipped ? [a, a + 3, a + 2, a + 1, a + 2, a + 3] : [a, a + 1, a + 2, a + 1, a, a + 3];
  const indices = new Uint32Array(6 * verdicts.length);
  for (let quad = 0; quad < verdicts.length; quad++) indices.set(of(4 * quad, false), 6 * quad);

  const mesh = { positions, indices, dimension };
  const limits = { maxNormalAngle: beta, maxDeviation: deviation ?? Infinity, maxIterations: 1 };
  const session = await FlipSession.create(mesh, { backend, ...limits });
  const iteration = await session.step();
  const { labelled, blocked } = iteration ?? { labelled: 0, blocked: (await session.result()).remaining };
  const triangles = await session.triangles();
  session.free();

  const wrong = [];
  verdicts.forEach((verdict, quad) => {
    if (of(4 * quad, verdict === LABELLED).some((v, i) => triangles[6 * quad + i] !== v)) wrong.push(quad);
  });
  return { labelled, blocked, wrong };
};
