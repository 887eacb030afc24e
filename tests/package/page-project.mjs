// Projects whose page runs the package on the CPU with threads, in the page and in a worker, and what the page writes.

import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { openPage, startChromium } from '../browsers.mjs';
import { repository } from './project.mjs';

const docs = readFileSync(join(repository, 'docs/package.md'), 'utf8');

/** Fails if no line of a table in docs/package.md starts with this name and has this setting. */
export function documented(name, setting) {
  const lines = docs.split('\n').filter((line) => line.startsWith(`| ${name} |`));
  assert.equal(lines.length, 1, name);
  assert.ok(lines[0].includes(setting), `${name}: ${setting}`);
}

/**
 * In this thread and from a worker: flips on several threads, the audit, two vertices that change places, and the options
 * that need other modules. In this thread: points, few and many.
 */
export const program = `
  import * as here from 'edgeflip';
  import { generate } from 'edgeflip/files';
  import { triangulate } from 'edgeflip/points';
  import * as away from 'edgeflip/worker';
  const quad = { positions: new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1]), indices: [0, 1, 2, 0, 2, 3], dimension: 2 };
  export async function flip() {
    await here.init();
    const mesh = await generate('random 190');
    const positions = mesh.positions.slice();
    positions.set(mesh.positions.subarray(40000, 40002), 2000);
    positions.set(mesh.positions.subarray(2000, 2002), 40000);
    const texts = [];
    for (const { FlipSession, makeDelaunay } of [here, away]) {
      const session = await FlipSession.create(mesh, { threads: 2 });
      const { flips, threads, hint } = await session.run();
      await session.setPositions(positions);
      const moved = await session.run();
      const { clean } = await session.verify();
      const tangled = await makeDelaunay({ ...mesh, positions }, { untangle: true, reorient: true });
      texts.push(\`\${flips} flips on \${threads} threads\${hint ?? ''}\`);
      texts.push(\`\${moved.flips} when moved, clean: \${clean}, \${tangled.flips} when tangled\`);
    }
    const { triangles } = await triangulate(quad.positions);
    let number = 1;
    const points = Float64Array.from({ length: 2 ** 18 }, () => (number = (number * 48271) % 0x7fffffff));
    const many = await triangulate(points, { threads: 2 });
    texts.push(\`\${many.triangles.length / 3} triangles on \${many.threads} threads\${many.hint ?? ''}\`);
    return [...texts, here.makeDelaunaySync(quad).indices, triangles].join(', ');
  }
`;
const written = '48643 flips on 2 threads, 7 when moved, clean: true, 48642 when tangled';
/** What \`flip\` of the program returns. */
export const WRITTEN = `${written}, ${written}, 262110 triangles on 2 threads, 3,1,2,0,1,3, 0,1,3,1,2,3`;

/** A page with a script. */
export const html = (script) => `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>edgeflip</title>
<link rel="icon" href="data:,">
<body><script type="module" src="${script}"></script></body>
</html>
`;

/** A project whose page writes what \`flip\` returns. */
export function pageProject(projects, name, more = {}, script = './main.js') {
  const root = projects.project(name, more);
  writeFileSync(join(root, 'flip.js'), program);
  writeFileSync(join(root, 'main.js'), "import { flip } from './flip.js';\ndocument.body.append(await flip());\n");
  writeFileSync(join(root, 'index.html'), html(script));
  return root;
}

/** Opens the page in Chromium and returns its text. */
export async function textOf(address, selector = 'body') {
  const { page, problems } = await openPage(await startChromium(), address);
  const text = (query) => document.querySelector(query)?.textContent.trim();
  try {
    await page.waitForFunction(text, selector, { timeout: 60_000 });
  } catch {
    // The comparison says more.
  }
  assert.deepEqual(problems, []);
  const found = await page.evaluate(text, selector);
  await page.close();
  return found;
}
