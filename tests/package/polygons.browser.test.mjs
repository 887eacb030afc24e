// Constraints on WebGPU and WebGL2 in Chromium: the same triangles as on the CPU, and a clean audit. The constraints stay
// while the mesh moves. Uses the existing dist/.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import Delaunator from 'delaunator';
import { closeAll } from '../browsers.mjs';
import { enginePage } from '../engine-page.mjs';
import { full } from '../full.mjs';
import { polygons } from './polygons.mjs';

after(closeAll);

let page;
before(async () => {
  ({ page } = await enginePage());
  await page.evaluate(prepare);
});

/** Runs in the page: defines what the tests call. */
async function prepare() {
  const { FlipSession } = await import('/dist/index.js');
  /** Runs on an engine. Returns the result and its audit, and the triangles after each motion, all as text. */
  window.runOn = async (backend, { positions, indices, constraints }) => {
    const mesh = { positions: Float64Array.from(positions), indices: Uint32Array.from(indices), dimension: 2 };
    const session = await FlipSession.create(mesh, { backend, constraints, skipConstraints: true });
    const result = await session.run();
    if (result.backend !== backend) throw new Error(`it ran on ${result.backend}`);
    const audit = await session.verify();
    const { flips, crossedEdges, leftOut, remaining } = result;
    // Motions take 32-bit floats.
    const frames = mesh.positions.every(Number.isInteger) ? [1, 2, 3] : [];
    const moved = [];
    for (const frame of frames) {
      const sheared = Float32Array.from(mesh.positions, (x, i) => (i % 2 ? x : x + frame * mesh.positions[i + 1]));
      session.update({ positions: sheared, iterations: 3 });
      moved.push([...(await session.triangles())]);
    }
    await session.setPositions(mesh.positions);
    await session.run();
    const last = await session.verify();
    session.free();
    const clean = audit.clean && last.clean;
    return {
      clean,
      flips,
      crossedEdges,
      frames: frames.length,
      all: JSON.stringify([[...result.indices], leftOut, remaining, moved]),
    };
  };
}

test('every engine brings polygons in alike, and keeps them', async () => {
  let [runs, constrained, frames] = [0, 0, 0];
  // The two largest have two thirds of all points, and take a software GPU most of the time.
  for (const { name, positions, sides } of full ? polygons : polygons.filter(({ sides }) => sides.length < 4000)) {
    const { triangles } = new Delaunator(positions);
    const mesh = { positions: [...positions], indices: [...triangles], constraints: sides.flat() };
    const run = (backend) => page.evaluate(([backend, mesh]) => runOn(backend, mesh), [backend, mesh]);
    const cpu = await run('cpu');
    assert.ok(cpu.clean, name);
    for (const backend of ['webgpu', 'webgl2']) assert.deepEqual(await run(backend), cpu, `${name}, ${backend}`);
    runs += cpu.flips;
    constrained += cpu.crossedEdges;
    frames += cpu.frames;
  }
  const [fewest, fewestConstrained] = full ? [200, 2000] : [50, 500];
  assert.ok(runs > fewest && constrained > fewestConstrained && frames > 10, `${runs}, ${constrained}, ${frames}`);
});
