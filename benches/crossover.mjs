// From which size on a GPU is faster than the CPU, in Chromium on a software GPU: runs crossover.html on the dist/ that
// is there and prints what it prints. `node benches/crossover.mjs serve` prints the page's address instead, for a browser
// with a GPU.

import { fileURLToPath } from 'node:url';
import { closeAll, openPage, serve, startChromium } from '../tests/browsers.mjs';

const address = `${await serve(fileURLToPath(new URL('..', import.meta.url)))}benches/crossover.html`;
if (process.argv[2] === 'serve') {
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
