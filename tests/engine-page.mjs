// A page of Chromium for tests of the engines. All tests of a process share it, because a software GPU takes longer to
// compile kernels than to run them. Uses the existing dist/.

import { fileURLToPath } from 'node:url';
import { openPage, serve, startChromium } from './browsers.mjs';

let opened;

/** The page with its problems. Its scripts import the package from `/dist/index.js`. */
export const enginePage = () => (opened ??= open());

async function open() {
  const address = await serve(fileURLToPath(new URL('..', import.meta.url)));
  const { page, problems } = await openPage(await startChromium(), `${address}tests/engines.html`);
  await page.evaluate(async () => {
    const { init } = await import('/dist/index.js');
    await init({ base: '../dist/wasm' });
  });
  return { page, problems };
}
