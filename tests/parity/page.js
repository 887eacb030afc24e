// Runs the meshes of the parity matrix on an engine of this browser, for matrix.mjs.

import { FlipSession } from '../../dist/index.js';
import { Digest } from './digest.js';

/** The number of sessions that wait for the GPU together: in Firefox, each wait takes at least 100 ms. */
const SESSIONS = 32;

const response = await fetch(new URL('../../target/parity.json', import.meta.url));
const { cases } = await response.json();

/** Runs a mesh, and returns its result and, if `isWatched`, every iteration. */
async function run({ positions, isWide, indices, dimension, beta, deviation, locked }, backend, isWatched) {
  const mesh = {
    positions: new (isWide ? Float64Array : Float32Array)(Uint32Array.from(positions).buffer),
    indices: Uint32Array.from(indices),
    dimension,
  };
  const session = await FlipSession.create(mesh, {
    backend,
    maxNormalAngle: beta,
    maxDeviation: deviation ?? Infinity,
    lockedEdges: locked,
  });
  try {
    const iterations = [];
    if (isWatched) {
      const digest = new Digest(await session.triangles());
      for await (const { labelled, flips, blocked } of session) {
        digest.feed(await session.triangles());
        iterations.push({ labelled, flips, blocked, digest: `${digest}` });
      }
    }
    const { indices, flipsPerIteration, status, remaining, inverted, flat, backend } = await session.run();
    const [digest, flips] = [`${new Digest(indices)}`, [...flipsPerIteration]];
    const end = { digest, flips, status, remaining, inverted, flat, backend };
    return { iterations, end };
  } finally {
    session.free();
  }
}

/**
 * Runs meshes, which are given by their indices, and returns their results at these indices; for a mesh that was refused
 * or failed, the error. Meshes that need at most `watched` iterations are watched.
 */
window.runAll = async ({ backend, watched, meshes }) => {
  const start = performance.now();
  const runs = [];
  const take = async (index) => {
    const mesh = cases[index];
    runs[index] = await run(mesh, backend, mesh.iterations.length <= watched).catch(({ code, message }) => ({
      code,
      message,
    }));
  };
  // The first run opens the device for all. Then the longest runs start first.
  const [first, ...others] = meshes;
  await take(first);
  const length = (index) => cases[index].iterations.length;
  const queue = others.sort((a, b) => length(b) - length(a));
  const next = async () => {
    for (let index = queue.shift(); index !== undefined; index = queue.shift()) await take(index);
  };
  await Promise.all(Array.from({ length: SESSIONS }, next));
  return { runs, seconds: (performance.now() - start) / 1000 };
};
