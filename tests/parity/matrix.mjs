// The browser columns of the parity matrix: compares the engines in browsers with the simulation. Reads
// target/parity.json, which tests/native/parity.rs writes, and adds a column for each engine.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { isDeepStrictEqual } from 'node:util';

const { cases, table, seconds } = JSON.parse(
  readFileSync(new URL('../../target/parity.json', import.meta.url), 'utf8'),
);

/**
 * Compares a run with the simulation of the mesh. Throws if they differ; else returns the text of the cell. Runs of
 * more than `watched` iterations are compared only at their end. GPUs have to refuse some meshes.
 */
function compare(run, mesh, { backend, watched }) {
  if (backend !== 'cpu' && mesh.isRefusedByGpus) {
    assert.equal(run.code, 'backend-limit', 'was not refused');
    return 'refused';
  }
  assert.equal(run.message, undefined, run.message);
  const isWatched = mesh.iterations.length <= watched;
  if (isWatched) {
    const first = mesh.iterations.findIndex((wanted, index) => !isDeepStrictEqual(run.iterations[index], wanted));
    assert.deepEqual(run.iterations[first], mesh.iterations[first], `iteration ${first}`);
    assert.equal(run.iterations.length, mesh.iterations.length, 'iterations');
  }
  const flips = mesh.iterations.map((iteration) => iteration.flips);
  const { end: digest, remaining, inverted, flat } = mesh;
  assert.deepEqual(run.end, { digest, flips, status: 'done', remaining, inverted, flat, backend }, 'the end');
  return isWatched ? '=' : 'end';
}

/** The cells of a column, and a sentence for each that is `WRONG`. */
function judge(runs, column, takes) {
  const wrong = [];
  const cells = cases.map((mesh, index) => {
    if (!takes(mesh)) return 'full';
    try {
      return compare(runs[index], mesh, column);
    } catch (error) {
      wrong.push(`${mesh.name} at β = ${mesh.beta}: ${error.message}`);
      return 'WRONG';
    }
  });
  return { cells, wrong };
}

/** Adds the column of an engine, and fails if a cell is wrong. The full run alone runs meshes that `takes` refuses. */
export async function fill(page, column, takes) {
  const meshes = cases.flatMap((mesh, index) => (takes(mesh) ? [index] : []));
  const { runs, seconds: took } = await page.evaluate((column) => window.runAll(column), { ...column, meshes });
  const { cells, wrong } = judge(runs, column, takes);
  [column.title, '---', ...cells].forEach((cell, line) => (table[line] += ` ${cell} |`));
  seconds.push(`${column.title}: ${took.toFixed(1)} s`);
  assert.deepEqual(wrong, []);
  const equal = cells.filter((cell) => cell === '=').length;
  assert.ok(equal >= 40, `only ${equal} after every iteration`);
}

/** The whole table. */
export const matrix = () => `${table.join('\n')}\n\n${seconds.join(', ')}`;
