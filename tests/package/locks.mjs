// Checks that locks and limits hold on the engines of a browser after the vertices move.

import assert from 'node:assert/strict';

/** Runs in the page: returns the answers of a session after each step. The vertices move between steps. */
async function runAndMove({ backend, name, isWide }) {
  const { FlipSession } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  const mesh = await generate(name);
  const lockedEdges = mesh.indices.filter((_, i) => i % 21 < 2);
  if (isWide) mesh.positions = Float64Array.from(mesh.positions, (x) => x * (1 + 2 ** -40));
  const limits = { maxNormalAngle: 60, maxDeviation: 0.05 };
  const session = await FlipSession.create(mesh, { backend, lockedEdges, ...limits });
  const said = [];
  for (const stretch of [1, 4, 0.5]) {
    await session.setPositions(mesh.positions.map((x, i) => (i % mesh.dimension ? x : x * stretch)));
    for await (const { labelled, flips, blocked } of session) said.push({ labelled, flips, blocked });
    const { indices, remaining } = await session.result();
    said.push({ indices: [...indices], remaining, audit: await session.verify() });
  }
  session.free();
  return said;
}

/** Compares an engine with the CPU, and the CPU with the audit. */
export async function holdLocks(page, { title, backend }) {
  for (const mesh of [{ name: 'random 12' }, { name: 'uvsphere 10' }, { name: 'uvsphere 10', isWide: true }]) {
    const expected = await page.evaluate(runAndMove, { backend: 'cpu', ...mesh });
    for (const { audit, remaining } of expected.filter((said) => said.audit)) {
      assert.ok(audit.clean, audit.violations.join());
      assert.deepEqual(audit.remaining, remaining);
      assert.ok(remaining.locked > 0, mesh.name);
      assert.equal(remaining.deviation > 0, mesh.name !== 'random 12');
    }
    assert.deepEqual(await page.evaluate(runAndMove, { backend, ...mesh }), expected, `${mesh.name}, ${title}`);
  }
}
