// The parity matrix, continued: the engines in browsers give what the simulation does. Reads what tests/parity.rs has
// written to target/parity.json, adds a column for each engine here, and prints the whole table last. Takes the dist/
// that is there.

import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { after, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { isDeepStrictEqual } from 'node:util';
import { closeAll, openPage, serve, startChromium, startFirefox } from '../browsers.mjs';

const repository = fileURLToPath(new URL('../..', import.meta.url));
for (const [file, command] of [['dist/index.js', 'npm run build'], ['target/parity.json', 'npm test -- parity']]) {
  assert.ok(existsSync(repository + file), `${file} is not there: ${command}`);
}
const { cases, table, seconds } = JSON.parse(readFileSync(`${repository}target/parity.json`, 'utf8'));

const startBrowser = { Chromium: startChromium, Firefox: startFirefox };

/**
 * Runs of more iterations than `watched` are compared at their end only; of a GPU's, some meshes have to be refused.
 *
 * @type {{ title: string, browser: keyof typeof startBrowser, backend: string, watched: number }[]}
 */
const columns = [
  { title: 'CPU wasm', browser: 'Chromium', backend: 'cpu', watched: 1000 },
  { title: 'WebGPU Chromium', browser: 'Chromium', backend: 'webgpu', watched: 200 },
  { title: 'WebGPU Firefox', browser: 'Firefox', backend: 'webgpu', watched: 150 },
  { title: 'WebGL2 Chromium', browser: 'Chromium', backend: 'webgl2', watched: 200 },
  { title: 'WebGL2 Firefox', browser: 'Firefox', backend: 'webgl2', watched: 150 },
];

/** Throws where the run is not what the simulation of the mesh gives; else the word for its cell. */
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
  assert.deepEqual(run.end, { digest: mesh.end, flips, status: 'done', remaining: mesh.remaining, backend }, 'the end');
  return isWatched ? '=' : 'end';
}

/** The cells of a column, and a sentence for each that is `WRONG`. */
function judge(runs, column) {
  const wrong = [];
  const cells = cases.map((mesh, index) => {
    try {
      return compare(runs[index], mesh, column);
    } catch (error) {
      wrong.push(`${mesh.name} at β = ${mesh.beta}: ${error.message}`);
      return 'WRONG';
    }
  });
  return { cells, wrong };
}

after(closeAll);
process.on('exit', () => {
  for (const { title, cells, seconds: took } of columns.filter((column) => 'cells' in column)) {
    [title, '---', ...cells].forEach((cell, line) => (table[line] += ` ${cell} |`));
    seconds.push(`${title}: ${took.toFixed(1)} s`);
  }
  console.log(`\n${table.join('\n')}\n\n${seconds.join(', ')}`);
});

// Firefox mostly waits, so they share the processor well.
describe('engines give what the simulation does', { concurrency: true }, () => {
  for (const [browser, start] of Object.entries(startBrowser)) {
    test(`in ${browser}`, { timeout: 600_000 }, async () => {
      const { page, problems } = await openPage(await start(), `${await serve(repository)}tests/parity/page.html`);
      await page.waitForFunction(() => 'runAll' in window);
      for (const column of columns.filter((column) => column.browser === browser)) {
        const { runs, seconds } = await page.evaluate((column) => window.runAll(column), column);
        const { cells, wrong } = judge(runs, column);
        Object.assign(column, { cells, seconds });
        problems.push(...wrong.map((why) => `${column.title}: ${why}`));
        const equal = cells.filter((cell) => cell === '=').length;
        if (equal < 40) problems.push(`${column.title}: only ${equal} after every iteration`);
      }
      if (problems.length > 0) assert.fail(problems.join('\n'));
    });
  }
});
