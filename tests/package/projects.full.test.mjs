// In the full run: the packed package in fresh projects of the bundlers and runtimes of docs/package.md, each with the
// settings of its line in the tables there and no others; and beside the functions of glTF-Transform. Uses the existing
// dist/, and the programs that tests/peers installs.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { closeAll, ISOLATED, openPage, serve, startChromium } from '../browsers.mjs';
import { faults } from './gltf.mjs';
import { primitivesOf, surfaceOf } from './primitives.mjs';
import { Projects, repository, run } from './project.mjs';
import { badEdges, border } from './surfaces.mjs';

const peers = join(repository, 'tests/peers');
const require = createRequire(join(peers, 'package.json'));
// Inside tests/peers, so that a project of Next finds React.
const projects = new Projects(join(peers, 'projects-'));
const docs = readFileSync(join(repository, 'docs/package.md'), 'utf8');

/** Fails if no line of a table in docs/package.md starts with this name and has this setting. */
function documented(name, setting) {
  const lines = docs.split('\n').filter((line) => line.startsWith(`| ${name} |`));
  assert.equal(lines.length, 1, name);
  assert.ok(lines[0].includes(setting), `${name}: ${setting}`);
}

/** Runs on the CPU with threads, in this thread and from a worker. */
const program = (entry) => `
  import { init, makeDelaunay, makeDelaunaySync } from '${entry}';
  import { generate } from 'edgeflip/files';
  import { triangulate } from 'edgeflip/points';
  import * as away from 'edgeflip/worker';
  const quad = { positions: new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1]), indices: [0, 1, 2, 0, 2, 3], dimension: 2 };
  export async function flip() {
    await init();
    const mesh = await generate('random 190');
    const [here, there] = [await makeDelaunay(mesh, { threads: 2 }), await away.makeDelaunay(mesh, { threads: 2 })];
    const texts = [here, there].map(({ flips, threads, hint }) => \`\${flips} flips on \${threads} threads\${hint ?? ''}\`);
    const { triangles } = await triangulate(quad.positions);
    return [...texts, makeDelaunaySync(quad).indices, triangles].join(', ');
  }
`;
const onPage = "import { flip } from './flip.js';\ndocument.body.append(await flip());\n";
const inConsole = "import { flip } from './flip.js';\nconsole.log(await flip());\n";
const WRITTEN = '48643 flips on 2 threads, 48643 flips on 2 threads, 3,1,2,0,1,3, 0,1,3,1,2,3';

const html = (script) => `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>edgeflip</title>
<link rel="icon" href="data:,">
<body><script type="module" src="${script}"></script></body>
</html>
`;

/** A project whose page writes what \`flip\` returns. */
function pageProject(name, more = {}, script = './main.js') {
  const root = projects.project(name, more);
  writeFileSync(join(root, 'flip.js'), program('edgeflip'));
  writeFileSync(join(root, 'main.js'), onPage);
  writeFileSync(join(root, 'index.html'), html(script));
  return root;
}

/** Fails if a primitive has another material, a vertex with other attributes, or another border or seam. */
function sameSurfaces(before, after) {
  const [all, now] = [before, after].map(primitivesOf);
  const name = (primitive) => primitive.getMaterial()?.getName();
  assert.deepEqual(now.map(name), all.map(name));
  all.map(surfaceOf).forEach((old, i) => {
    const surface = surfaceOf(now[i]);
    const [vertices, left] = [old, surface].map(({ positions, records }) =>
      records.map((record, v) => `${positions.slice(3 * v, 3 * v + 3)}|${record}`),
    );
    assert.deepEqual(new Set(left), new Set(vertices));
    assert.deepEqual(border(surface), border(old));
    assert.equal(surface.indices.length, old.indices.length);
    assert.ok(badEdges(surface) < badEdges(old) / 2);
  });
}

let chromium;
before(async () => {
  chromium = await startChromium();
});
after(async () => {
  await closeAll();
  projects.remove();
});

/** Opens the page and returns its text. */
async function textOf(address, selector = 'body') {
  const { page, problems } = await openPage(chromium, address);
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

test('webpack', async () => {
  documented('webpack 5', '`experiments: { outputModule: true }`, `output: { module: true }`');
  const root = pageProject('webpack', {}, './main.mjs');
  const webpack = require('webpack');
  const config = {
    mode: 'production',
    context: root,
    entry: './main.js',
    output: { path: join(root, 'out'), module: true },
  };
  const compiler = webpack({ ...config, experiments: { outputModule: true }, performance: false });
  const stats = await new Promise((resolve, reject) => {
    compiler.run((error, stats) => (error ? reject(error) : resolve(stats)));
  });
  assert.equal(stats.toString({ all: false, errors: true, warnings: true }), '');
  writeFileSync(join(root, 'out/index.html'), html('./main.mjs'));
  assert.equal(await textOf(await serve(join(root, 'out'), ISOLATED)), WRITTEN);
});

test('Parcel', async () => {
  const setting = '"@parcel/resolver-default": { "packageExports": true }';
  documented('Parcel 2', setting);
  const root = pageProject('parcel', JSON.parse(`{ ${setting} }`));
  const parcel = join(peers, 'node_modules/parcel/lib/bin.js');
  run(
    process.execPath,
    [parcel, 'build', 'index.html', '--dist-dir', 'out', '--no-cache', '--cache-dir', 'cache', '--public-url', './'],
    root,
  );
  assert.equal(await textOf(await serve(join(root, 'out'), ISOLATED)), WRITTEN);
});

test('Vite 7, built and on the development server', async (t) => {
  documented('Vite 7', "`optimizeDeps: { exclude: ['edgeflip'] }`");
  const { build, createServer } = await import(pathToFileURL(require.resolve('vite-7')));
  const root = pageProject('vite');
  const config = { root, configFile: false, logLevel: 'warn', worker: { format: 'es' }, build: { target: 'es2022' } };
  await build(config);
  assert.equal(await textOf(await serve(join(root, 'dist'), ISOLATED)), WRITTEN);
  const server = await createServer({
    ...config,
    optimizeDeps: { exclude: ['edgeflip'] },
    server: { port: 0, headers: ISOLATED },
  });
  t.after(() => server.close());
  await server.listen();
  assert.equal(await textOf(server.resolvedUrls.local[0]), WRITTEN);
});

test('Vite for servers, with the package in the bundle', async () => {
  documented('a bundle for Node', '`edgeflip/inline`');
  const { build } = await import(pathToFileURL(require.resolve('vite-7')));
  const root = projects.project('vite-ssr');
  const line = "import { makeDelaunay } from 'edgeflip/inline';\n";
  const mesh = '{ positions: new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1]), indices: [0, 1, 2, 0, 2, 3], dimension: 2 }';
  writeFileSync(join(root, 'main.js'), `${line}console.log((await makeDelaunay(${mesh})).indices.join());\n`);
  await build({ root, configFile: false, logLevel: 'warn', ssr: { noExternal: true }, build: { ssr: 'main.js' } });
  assert.equal(run(process.execPath, [join(root, 'dist/main.js')], root), '3,1,2,0,1,3\n');
});

test('Next, in the browser and in a server component', { timeout: 180_000 }, async (t) => {
  const setting = "serverExternalPackages: ['edgeflip']";
  documented('Next', `\`${setting}\``);
  const root = projects.project('next');
  mkdirSync(join(root, 'app'));
  const write = (name, text) => writeFileSync(join(root, name), text);
  const headers = Object.entries(ISOLATED).map(([key, value]) => ({ key, value }));
  write(
    'next.config.mjs',
    `export default { ${setting}, async headers() { return [{ source: '/:path*', headers: ${JSON.stringify(headers)} }]; } };`,
  );
  write('app/flip.js', program('edgeflip'));
  write(
    'app/layout.jsx',
    `export const metadata = { title: 'edgeflip', icons: 'data:,' };
    export default ({ children }) => <html lang="en"><body>{children}</body></html>;`,
  );
  write(
    'app/page.jsx',
    `import { makeDelaunay } from 'edgeflip';
    import Client from './client';
    export const dynamic = 'force-dynamic';
    export default async function Page() {
      const positions = new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1]);
      const { indices } = await makeDelaunay({ positions, indices: [0, 1, 2, 0, 2, 3], dimension: 2 });
      return <main><p id="server">{indices.join()}</p><Client /></main>;
    }`,
  );
  write(
    'app/client.jsx',
    `'use client';
    import { useEffect, useState } from 'react';
    import { flip } from './flip';
    export default function Client() {
      const [text, setText] = useState('');
      useEffect(() => void flip().then(setText, (error) => setText(String(error))), []);
      return <p id="client">{text}</p>;
    }`,
  );
  const next = join(peers, 'node_modules/next/dist/bin/next');
  const env = { NEXT_TELEMETRY_DISABLED: '1', NODE_ENV: 'production' };
  run(process.execPath, [next, 'build'], root, env);
  const server = spawn(process.execPath, [next, 'start', '-p', '0'], { cwd: root, env: { ...process.env, ...env } });
  t.after(() => server.kill());
  const address = await new Promise((resolve, reject) => {
    let output = '';
    const read = (chunk) => {
      output += chunk;
      const [url] = output.match(/http:\/\/localhost:\d+/) ?? [];
      if (url) resolve(url);
    };
    server.stdout.on('data', read);
    server.stderr.on('data', read);
    server.on('close', () => reject(new Error(output)));
  });
  assert.equal(await textOf(address, '#server'), '3,1,2,0,1,3');
  assert.equal(await textOf(address, '#client'), WRITTEN);
});

test('Node, Bun and Deno; CommonJS too', () => {
  const root = projects.project('runtimes');
  writeFileSync(join(root, 'flip.js'), program('edgeflip'));
  writeFileSync(join(root, 'main.js'), inConsole);
  writeFileSync(
    join(root, 'common.cjs'),
    `const { makeDelaunay } = require('edgeflip');
    const { generate } = require('edgeflip/files');
    generate('random 8').then(makeDelaunay).then(({ flips }) => console.log(flips));`,
  );
  const installed = (scope, file) => {
    const folder = join(peers, 'node_modules', scope);
    const [name] = readdirSync(folder);
    return join(folder, name, process.platform === 'win32' ? `${file}.exe` : file);
  };
  for (const [name, path, ...args] of [
    ['Node', process.execPath],
    ['Bun', installed('@oven', 'bin/bun')],
    ['Deno', installed('@deno', 'deno'), 'run', '-A'],
  ]) {
    documented(name, 'yes');
    assert.equal(run(path, [...args, 'main.js'], root), `${WRITTEN}\n`, name);
    assert.equal(run(path, [...args, 'common.cjs'], root), '47\n', name);
  }
});

test('glTF-Transform: weld, delaunay and reorder, on models as they are and quantized', async () => {
  const root = projects.project('gltf');
  copyFileSync(join(repository, 'tests/package/pipeline.mjs'), join(root, 'pipeline.mjs'));
  const io = new NodeIO().registerExtensions(ALL_EXTENSIONS);
  for (const name of ['bunny', 'suzi', 'pmndrs']) {
    const { default: uri } = await import(`@pmndrs/assets/models/${name}.glb.js`);
    writeFileSync(join(root, 'in.glb'), Buffer.from(uri.split(',')[1], 'base64'));
    for (const quantized of [[], ['quantized']]) {
      const line = run(process.execPath, ['pipeline.mjs', 'in.glb', 'before.glb', 'after.glb', ...quantized], root);
      assert.match(line, /^delaunay: [1-9]\d+ flips in /, name);
      const [before, after] = ['before.glb', 'after.glb'].map((file) => readFileSync(join(root, file)));
      assert.deepEqual(await faults(after), [], name);
      sameSurfaces(await io.readBinary(before), await io.readBinary(after));
    }
  }
});

test('publint and arethetypeswrong find nothing', () => {
  const bin = (path) => join(peers, 'node_modules', path);
  assert.match(
    run(process.execPath, [bin('publint/src/cli.js'), 'run', projects.tarball, '--strict'], projects.folder),
    /All good!/,
  );
  const wasm = ['edgeflip', 'webgl2', 'threads', 'untangle', 'audit', 'files', 'points'].map((name) => `${name}.wasm`);
  const types = [bin('@arethetypeswrong/cli/dist/index.js'), projects.tarball, '--exclude-entrypoints', ...wasm];
  assert.match(run(process.execPath, types, projects.folder), /No problems found/);
});
