// Each option of src/js/types.ts has the same effect on the WebGL2 engine as on the CPU. The module of the WebGL2
// engine gets the options from the module of the engines. Runs in Chromium; uses the existing dist/.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { closeAll } from '../browsers.mjs';
import { enginePage } from '../engine-page.mjs';

after(closeAll);

/** Runs in the page: returns the result of each case, or its exception. */
async function askAll(backend) {
  const { FlipSession, makeDelaunay } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  const { cases } = await import('/tests/package/options.mjs');
  const [mesh, base] = [await generate('uvsphere 24'), { backend }];
  const plain = await makeDelaunay(mesh, base);
  const given = {};
  for (const [option, run] of Object.entries(cases)) {
    given[option] = await run({ makeDelaunay, FlipSession, mesh, base, plain }).then(
      (value) => JSON.stringify(value ?? null),
      (error) => `${error}`,
    );
  }
  return given;
}

test('every option takes effect on WebGL2', async () => {
  const { page } = await enginePage();
  const [webgl2, cpu] = [await page.evaluate(askAll, 'webgl2'), await page.evaluate(askAll, 'cpu')];
  assert.deepEqual(webgl2, cpu);
  for (const [option, value] of Object.entries(webgl2)) assert.doesNotMatch(value, /Error/, option);
});
