// Tests the option `adjacency` on WebGPU in Chromium and Firefox: after each update, both buffers are those of the
// triangles. Uses the existing dist/.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { closeAll, openPage, serve, startFirefox } from '../browsers.mjs';
import { enginePage } from '../engine-page.mjs';
import { full } from '../full.mjs';

after(closeAll);
const repository = fileURLToPath(new URL('../..', import.meta.url));
const browsers = {
  Chromium: enginePage,
  Firefox: async () => openPage(await startFirefox(), `${await serve(repository)}tests/engines.html`),
};

for (const [name, open] of Object.entries(browsers)) {
  test(`${name}: twins and half-edges are those of the triangles after each update`, async () => {
    const { page, problems } = await open();
    const given = await page.evaluate(
      async (frames) => {
        const { FlipSession } = await import('/dist/index.js');
        const { generate } = await import('/dist/files.js');
        const { walks } = await import('/tests/package/adjacency.mjs');
        return walks({ FlipSession, generate, frames });
      },
      full ? 40 : 8,
    );
    for (const [mesh, { flips, kinds }] of Object.entries(given)) assert.ok(flips > 20 && kinds[0] > 40, mesh);
    assert.ok(given.components.kinds[1] >= 1 && given.fin.kinds[1] >= 2, JSON.stringify(given));
    assert.deepEqual(problems, []);
  });
}
