// Tests the packed npm package in fresh projects and real browsers. The five lines for a page in docs/package.md run
// unchanged, and with Vite by the package's name; so do edgeflip/files, edgeflip/points and the audit. Every page has to write the same
// as Node. Packs the existing dist/.

import assert from 'node:assert/strict';
import { copyFileSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { setTimeout as pause } from 'node:timers/promises';
import { pathToFileURL } from 'node:url';
import { build, createServer } from 'vite';
import { closeAll, ISOLATED, openPage, serve, startChromium, startFirefox } from '../browsers.mjs';
import { full } from '../full.mjs';
import { Projects, repository, run } from './project.mjs';

const projects = new Projects(join(tmpdir(), 'edgeflip-package-'));

const [, fiveLines] =
  readFileSync(join(repository, 'docs/package.md'), 'utf8').match(
    /^```html\n<script type="module">\n([^]*?)<\/script>\n```$/m,
  ) ?? assert.fail('docs/package.md has no script for a page');
const withFiles = `
  import { makeDelaunay } from './node_modules/edgeflip/dist/index.js';
  import { generate } from './node_modules/edgeflip/dist/files.js';
  const mesh = await generate('random 8');
  const result = await makeDelaunay(mesh, { backend: 'auto' });
  document.body.append(\`\${result.flips} flips on \${result.backend}: \${result.indices}\`);
`;
const withAudit = `
  import { FlipSession } from './node_modules/edgeflip/dist/index.js';
  const positions = new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1]);
  const indices = new Uint32Array([0, 1, 2, 0, 2, 3]);
  const session = await FlipSession.create({ positions, indices, dimension: 2 }, { backend: 'auto' });
  const audit = await session.verify();
  document.body.append(\`\${JSON.stringify(audit.remaining)} on \${await session.backend()}: \${audit.clean}\`);
`;
const withPoints = `
  import { makeDelaunay } from './node_modules/edgeflip/dist/index.js';
  import { triangulate } from './node_modules/edgeflip/dist/points.js';
  const positions = new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1, 1, 0]);
  const { triangles, hull } = await triangulate(positions);
  const result = await makeDelaunay({ positions, indices: triangles, dimension: 2 }, { backend: 'auto' });
  document.body.append(\`\${result.flips} flips on \${result.backend}: \${triangles}, \${hull}\`);
`;
const withPointsOnThreads = `
  import { makeDelaunay } from './node_modules/edgeflip/dist/index.js';
  import { triangulate } from './node_modules/edgeflip/dist/points.js';
  let number = 1;
  const positions = Float64Array.from({ length: 2 ** 18 }, () => (number = (number * 48271) % 0x7fffffff));
  const { triangles, twins, hull } = await triangulate(positions, { threads: 3 });
  const result = await makeDelaunay({ positions, indices: triangles, dimension: 2 }, { backend: 'auto', threads: 1 });
  const sum = (words) => words.reduce((sum, word) => (Math.imul(sum, 31) + word) | 0, 0);
  document.body.append(\`\${result.flips} flips on \${result.backend}: \${sum(triangles)}, \${sum(twins)}, \${hull}\`);
`;
const withThreads = `
  import { makeDelaunay } from './node_modules/edgeflip/dist/index.js';
  import { generate } from './node_modules/edgeflip/dist/files.js';
  const mesh = await generate('random 190');
  const runs = ['reproducible', 'any'].map((order) => makeDelaunay(mesh, { backend: 'auto', order, threads: 3 }));
  const [{ backend, flips, indices }, any] = await Promise.all(runs);
  const sum = (words) => words.reduce((sum, word) => (Math.imul(sum, 31) + word) | 0, 0);
  document.body.append(\`\${flips} and \${any.flips} flips on \${backend}: \${sum(indices)}, \${sum(any.indices)}\`);
`;

const withWorker = `
  import { makeDelaunay } from './node_modules/edgeflip/dist/worker.js';
  const positions = new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1]);
  const indices = new Uint32Array([0, 1, 2, 0, 2, 3]);
  const result = await makeDelaunay({ positions, indices, dimension: 2 }, { backend: 'auto' });
  document.body.append(\`\${result.flips} flip on \${result.backend}: \${result.indices}\`);
`;

/** Lines with values that are not a GPUDevice of this window. The package refuses them before they reach the module. */
const withFakes = `
  import { makeDelaunay } from './node_modules/edgeflip/dist/index.js';
  const positions = new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1]);
  const indices = new Uint32Array([0, 1, 2, 0, 2, 3]);
  const Device = globalThis.GPUDevice ?? class {};
  const codes = [];
  for (const device of [null, {}, Object.create(Device.prototype), new Proxy(Object.create(Device.prototype), {})]) {
    await makeDelaunay({ positions, indices, dimension: 2 }, { device }).catch(({ code }) => codes.push(code));
  }
  const { backend } = await makeDelaunay({ positions, indices, dimension: 2 }, { backend: 'auto' });
  document.body.append(\`refused on \${backend}: \${codes}\`);
`;

/** A program in CommonJS. */
const inCommonJs = `
  import edgeflip = require('edgeflip');
  import files = require('edgeflip/files');
  import points = require('edgeflip/points');
  async function flips(mesh: edgeflip.Mesh, options: edgeflip.Options): Promise<number> {
    const session: edgeflip.FlipSession<edgeflip.IndexArray> = await edgeflip.FlipSession.create(mesh, options);
    const { positions }: files.Mesh32 = await files.generate('random 8');
    const { triangles }: points.Triangulation = await points.triangulate(positions);
    console.log(triangles.length);
    return (await session.run()).flips;
  }
  void flips;
`;

/** The same lines on another engine. */
function on(backend, lines) {
  assert.match(lines, /'auto'/);
  return lines.replace("'auto'", `'${backend}'`);
}

/** The same lines, which import the package by its name. */
function byName(lines) {
  const named = lines.replace('./node_modules/edgeflip/dist/index.js', 'edgeflip');
  const all = named.replaceAll(/\.\/node_modules\/edgeflip\/dist\/(\w+)\.js/g, 'edgeflip/$1');
  assert.notEqual(all, lines);
  return all;
}

// `writes`: the output of the same lines in Node, on the CPU.
const pages = [
  { name: 'index', lines: fiveLines, writes: '' },
  { name: 'cpu', lines: on('cpu', fiveLines), writes: '' },
  { name: 'webgpu', lines: on('webgpu', fiveLines), writes: '' },
  { name: 'webgl2', lines: on('webgl2', fiveLines), writes: '' },
  { name: 'files', lines: on('cpu', withFiles), writes: '' },
  { name: 'audit', lines: on('cpu', withAudit), writes: '' },
  { name: 'points', lines: on('cpu', withPoints), writes: '' },
  { name: 'points-threads', lines: on('cpu', withPointsOnThreads), writes: '' },
  { name: 'threads', lines: on('cpu', withThreads), writes: '' },
  { name: 'worker', lines: on('cpu', withWorker), writes: '' },
  { name: 'fakes', lines: withFakes, writes: '' },
];

const html = (script) => `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>edgeflip</title>
<link rel="icon" href="data:,">
${script}
`;

before(async () => {
  const root = projects.project('node');
  globalThis.document = { body: { append: (text) => (globalThis.written = text) } };
  for (const page of pages) {
    const file = join(root, `${page.name}.js`);
    writeFileSync(file, byName(page.lines).replace(/'webgpu'|'webgl2'/, "'cpu'"));
    await import(pathToFileURL(file));
    page.writes = globalThis.written;
  }
  delete globalThis.document;
});
after(async () => {
  await closeAll();
  projects.remove();
});

/**
 * Opens pages and compares their output: all, or in the short run those that are named. If memory can be shared, threads
 * have workers.
 */
async function check(browser, address, isIsolated, names) {
  for (const { name, lines, writes } of pages.filter((page) => full || !names || names.includes(page.name))) {
    const { page, problems } = await openPage(browser, `${address}${name}.html`);
    let text = '';
    // Compiling shaders for a software GPU takes seconds.
    for (const start = performance.now(); !text && problems.length === 0 && performance.now() - start < 60_000; ) {
      await pause(50);
      text = await page.evaluate(() => document.body?.textContent.trim() ?? '');
    }
    const several = isIsolated ? 3 : 0;
    const wanted = { threads: several, 'points-threads': several, worker: 1 }[name] ?? 0;
    // When the first worker has finished, the other workers may not have loaded yet.
    for (let i = 0; i < 100 && page.workers().length < wanted; i++) await pause(50);
    const workers = page.workers().length;
    const fetched = await page.evaluate(() => performance.getEntriesByType('resource').map(({ name }) => name));
    await page.close();
    // 'auto' on the CPU fetches the module of the engines and no other.
    if (name === 'index') {
      const modules = fetched.flatMap((url) => url.match(/edgeflip\w*?_bg(?=[-.\w]*\.wasm)/) ?? []);
      assert.deepEqual([...new Set(modules)], ['edgeflip_bg']);
    }
    assert.deepEqual({ name, workers }, { name, workers: wanted });
    assert.deepEqual({ name, problems }, { name, problems: [] });
    const [, backend] = lines.match(/backend: '(\w+)'/);
    const [, engine] = text.match(/ on (\w+): /) ?? assert.fail(`${name} writes “${text}”`);
    if (backend !== 'auto') assert.equal(engine, backend);
    assert.equal(text.replace(` on ${engine}: `, ' on cpu: '), writes);
  }
}

function plainPages(folder) {
  const root = projects.project(folder);
  for (const { name, lines } of pages) {
    writeFileSync(join(root, `${name}.html`), html(`<script type="module">\n${lines}</script>`));
  }
  return root;
}

function viteProject(folder) {
  const root = projects.project(folder);
  for (const { name, lines } of pages) {
    writeFileSync(join(root, `${name}.html`), html(`<script type="module" src="./${name}.js"></script>`));
    writeFileSync(join(root, `${name}.js`), byName(lines));
  }
  return root;
}

test('docs/package.md has five lines, and they flip the long diagonal', () => {
  assert.equal(fiveLines.trim().split('\n').length, 5);
  const written = pages.map(({ writes }) => writes);
  assert.deepEqual(written.slice(0, 4), Array(4).fill('1 flip on cpu: 3,1,2,0,1,3'));
  assert.equal(written[5], '{"stopped":1} on cpu: true');
  assert.match(written[4], /^47 flips on cpu: (\d+,){293}\d+$/);
});

test('the package contains the files that its entries need, and no source', () => {
  const paths = projects.packed.files.map(({ path }) => path);
  const { exports } = JSON.parse(readFileSync(join(repository, 'package.json'), 'utf8'));
  const filesOf = (entry) => (typeof entry === 'string' ? entry : Object.values(entry).flatMap(filesOf));
  const entries = Object.values(exports).flatMap(filesOf);
  for (const entry of entries) assert.ok(paths.includes(entry.replace('./', '')), entry);
  const isBuilt = (path) => /^dist\/(cjs\/)?(wasm\/)?[\w-]+(\.d\.ts|\.js|\.wasm|\.wasm\.d\.ts)$/.test(path);
  const others = paths.filter((path) => !isBuilt(path) && !/^(docs|examples)\/|^[A-Z]+\.md$/.test(path));
  assert.deepEqual(others.sort(), ['LICENSE-APACHE', 'LICENSE-MIT', 'dist/cjs/package.json', 'package.json']);
});

test('CommonJS in Node finds the package', () => {
  const root = projects.project('common');
  writeFileSync(
    join(root, 'common.cjs'),
    `const { makeDelaunay } = require('edgeflip');
    const { generate } = require('edgeflip/files');
    const { triangulate } = require('edgeflip/points');
    generate('random 8').then(async (mesh) => {
      const [{ flips }, { hull }] = [await makeDelaunay(mesh), await triangulate(mesh.positions)];
      console.log(flips, hull.length);
    });`,
  );
  assert.equal(run(process.execPath, ['common.cjs'], root), '47 28\n');
});

// The oldest version knows the fewest ways to write a type.
for (const version of full ? ['5.4', '', '6', '7'] : ['5.4']) {
  const name = `typescript${version && `-${version}`}`;
  test(`a strict project finds the types with ${name}, with a bundler and in old and new Node, and checks all declarations`, () => {
    const root = projects.project(name);
    writeFileSync(join(root, 'lines.ts'), byName(fiveLines));
    writeFileSync(join(root, 'files.ts'), byName(withFiles));
    copyFileSync(join(repository, 'tests/package/types.ts'), join(root, 'types.ts'));
    writeFileSync(join(root, 'common.cts'), inCommonJs);
    for (const [module, moduleResolution] of [
      ['ESNext', 'bundler'],
      ['NodeNext', 'NodeNext'],
      ['Node16', 'Node16'],
      // TypeScript 6 warns of it, and 7 has none.
      ...(Number(version || '5.9') < 6 ? [['ESNext', 'Node10']] : []),
    ]) {
      const compilerOptions = {
        target: 'ES2022',
        module,
        moduleResolution,
        lib: ['ES2022', 'DOM', 'DOM.Iterable'],
        types: [],
        strict: true,
        skipLibCheck: false,
        verbatimModuleSyntax: true,
        noEmit: true,
      };
      const include = ['*.ts', ...(module.startsWith('Node') ? ['*.cts'] : [])];
      writeFileSync(join(root, 'tsconfig.json'), JSON.stringify({ compilerOptions, include }));
      run(process.execPath, [join(repository, `node_modules/${name}/bin/tsc`), '-p', root], root);
    }
  });
}

/** Pages that load every module of the package. */
const BUNDLED = ['cpu', 'webgl2', 'files', 'audit', 'points', 'points-threads', 'threads', 'worker'];

// More of them at once share the processor cores until a page takes longer than it may.
describe('in a browser', { concurrency: 2 }, () => {
  let chromium;
  before(async () => {
    chromium = await startChromium();
  });

  test('plain pages in Chromium', async () => check(chromium, await serve(plainPages('plain'), ISOLATED), true));

  test('plain pages that are not isolated, in Chromium', async () =>
    check(chromium, await serve(plainPages('plain-alone')), false, ['index', 'points-threads', 'threads']));

  test('plain pages in Firefox', async () =>
    check(await startFirefox(), await serve(plainPages('plain-firefox'), ISOLATED), true, [
      ...['index', 'webgpu', 'webgl2', 'points', 'points-threads', 'threads'],
    ]));

  test('a Vite project, built, in Chromium', async () => {
    const root = viteProject('vite-build');
    const input = pages.map(({ name }) => join(root, `${name}.html`));
    await build({ root, configFile: false, logLevel: 'warn', build: { rolldownOptions: { input } } });
    await check(chromium, await serve(join(root, 'dist'), ISOLATED), true, BUNDLED);
  });

  test('a Vite project on the development server, in Chromium', async (t) => {
    const root = viteProject('vite-dev');
    const server = await createServer({
      root,
      configFile: false,
      logLevel: 'warn',
      server: { port: 0, headers: ISOLATED },
    });
    t.after(() => server.close());
    await server.listen();
    await check(chromium, server.resolvedUrls.local[0], true, BUNDLED);
  });
});
