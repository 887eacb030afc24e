// Runs a benchmark page, crossover.html or peers.html, in Chromium on a software GPU and prints its output: `node
// benches/page.mjs peers`. `node benches/page.mjs peers serve` prints the page's URL instead, for a browser with a
// hardware GPU. Uses the existing dist/.

import { fileURLToPath } from 'node:url';
import { closeAll, ISOLATED, openPage, serve, startChromium } from '../tests/browsers.mjs';

const [name, verb] = process.argv.slice(2);
const address = `${await serve(fileURLToPath(new URL('..', import.meta.url)), ISOLATED)}benches/${name}.html`;
if (verb === 'serve') {
  console.log(address);
} else {
  try {
    const { page, problems } = await openPage(await startChromium(), address);
    await page.waitForFunction(() => 'done' in document.body.dataset, null, { timeout: 0, polling: 1000 });
    console.log(`${await page.textContent('pre')}${problems.join('\n')}`);
  } finally {
    await closeAll();
  }
}
