// Tests `edgeflip/inline`: Rollup and esbuild make one file of a program that uses it, without a plugin for WebAssembly.
// The file runs in Node and on a page that serves nothing else. Uses the existing dist/.

import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';
import { nodeResolve } from '@rollup/plugin-node-resolve';
import * as esbuild from 'esbuild';
import { rollup } from 'rollup';
import { closeAll, openPage, serve, startChromium } from '../browsers.mjs';

// Inside the repository, so that 'edgeflip' resolves to this package.
const repository = fileURLToPath(new URL('../..', import.meta.url));
mkdirSync(join(repository, 'target'), { recursive: true });
const folder = mkdtempSync(join(repository, 'target/bundlers-'));
const program = join(folder, 'program.js');
writeFileSync(
  program,
  `import { makeDelaunay } from 'edgeflip/inline';
  const positions = new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1]);
  const indices = new Uint16Array([0, 1, 2, 0, 2, 3]);
  export const made = makeDelaunay({ positions, indices, dimension: 2 }, { backend: 'cpu' })
    .then(({ flips, backend, indices }) => \`\${flips} flip on \${backend}: \${indices}\`)
    .catch(({ code, message }) => \`\${code}: \${message}\`);
  if (globalThis.document) document.body.append(await made);
`,
);
const WRITTEN = '1 flip on cpu: 3,1,2,0,1,3';

const bundles = {
  async rollup(file) {
    const bundle = await rollup({ input: program, plugins: [nodeResolve()] });
    await bundle.write({ file, inlineDynamicImports: true });
    await bundle.close();
  },
  async esbuild(file) {
    const { warnings } = await esbuild.build({
      entryPoints: [program],
      outfile: file,
      bundle: true,
      format: 'esm',
      target: 'es2022',
      logLevel: 'silent',
    });
    assert.deepEqual(warnings, []);
  },
};

after(async () => {
  await closeAll();
  rmSync(folder, { recursive: true, force: true });
});

for (const [name, bundle] of Object.entries(bundles)) {
  test(`${name} makes one file that runs in Node and in Chromium`, async () => {
    const root = join(folder, name);
    mkdirSync(root);
    await bundle(join(root, 'all.js'));
    assert.deepEqual(readdirSync(root), ['all.js']);
    const { made } = await import(pathToFileURL(join(root, 'all.js')));
    assert.equal(await made, WRITTEN);
    writeFileSync(
      join(root, 'index.html'),
      `<!doctype html><meta charset="utf-8"><title>edgeflip</title><link rel="icon" href="data:,">
      <script type="module" src="./all.js"></script>`,
    );
    const { page, problems } = await openPage(await startChromium(), `${await serve(root)}index.html`);
    await page.waitForFunction(() => document.body?.textContent.trim());
    assert.equal(await page.evaluate(() => document.body.textContent.trim()), WRITTEN);
    assert.deepEqual(problems, []);
    await page.close();
  });
}

test('esbuild puts the module of edgeflip/points into the script, as bytes', async () => {
  const [source, file] = [join(folder, 'points.js'), join(folder, 'points/all.js')];
  writeFileSync(
    source,
    `import bytes from 'edgeflip/points.wasm';
    import { init, triangulate, triangulateSync } from 'edgeflip/points';
    await init({ points: bytes });
    export const triangles = triangulateSync([0, 0, 1, 0, 0, 1]).triangles.join();
    export const many = await triangulate(Float64Array.from({ length: 2 ** 18 }, Math.random), { threads: 2 });
    `,
  );
  const loader = { '.wasm': 'binary' };
  await esbuild.build({ entryPoints: [source], outfile: file, bundle: true, format: 'esm', target: 'es2022', loader });
  const { triangles, many } = await import(pathToFileURL(file));
  assert.equal(triangles, '0,1,2');
  assert.deepEqual([many.threads, many.triangles.length > 2 ** 18], [1, true]);
  assert.match(
    many.hint,
    /^The points were triangulated on one thread: the workers could not be started \(edgeflip_points_th/,
  );
});

test('without edgeflip/inline and without the file of the module, the error says what to do', async () => {
  const [source, file] = [join(folder, 'plain.js'), join(folder, 'plain/all.js')];
  writeFileSync(source, readFileSync(program, 'utf8').replace('edgeflip/inline', 'edgeflip'));
  await esbuild.build({ entryPoints: [source], outfile: file, bundle: true, format: 'esm', logLevel: 'silent' });
  const { made } = await import(pathToFileURL(file));
  assert.match(
    await made,
    /^load-failed: edgeflip_bg\.wasm could not be loaded from file:\S+plain\/wasm\/edgeflip_bg\.wasm: .*; serve the package's /,
  );
});

test('the inline entry has at most 1.4 times the bytes of the module of the engines', () => {
  const size = (name) => gzipSync(readFileSync(join(repository, 'dist', name))).length;
  assert.ok(size('inline.js') + size('inline-core.js') <= 1.4 * size('wasm/edgeflip_bg.wasm'));
});
