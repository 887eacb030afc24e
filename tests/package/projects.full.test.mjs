// In the full run: the packed package in fresh projects of the bundlers and runtimes of docs/package.md, each with the
// settings of its line in the tables there and no others; and beside the functions of glTF-Transform. Uses the existing
// dist/, and the programs that tests/peers installs. workers.browser.test.mjs has webpack and Parcel.

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { closeAll, ISOLATED, serve } from '../browsers.mjs';
import { faults } from './gltf.mjs';
import { documented, pageProject, program, textOf, WRITTEN } from './page-project.mjs';
import { primitivesOf, surfaceOf } from './primitives.mjs';
import { Projects, repository, run } from './project.mjs';
import { badEdges, border } from './surfaces.mjs';

const peers = join(repository, 'tests/peers');
const require = createRequire(join(peers, 'package.json'));
// Inside tests/peers, so that a project of Next finds React.
const projects = new Projects(join(peers, 'projects-'));

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

after(async () => {
  await closeAll();
  projects.remove();
});

test('Vite 7, built and on the development server', async (t) => {
  documented('Vite 7', "`optimizeDeps: { exclude: ['edgeflip'] }`");
  const { build, createServer } = await import(pathToFileURL(require.resolve('vite-7')));
  const root = pageProject(projects, 'vite');
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
  write('app/flip.js', program);
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
  writeFileSync(join(root, 'flip.js'), program);
  writeFileSync(join(root, 'main.js'), "import { flip } from './flip.js';\nconsole.log(await flip());\n");
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
  const { exports } = JSON.parse(readFileSync(join(repository, 'package.json'), 'utf8'));
  // They have no types.
  const wasm = Object.keys(exports).flatMap((name) => (name.endsWith('.wasm') ? name.slice(2) : []));
  const types = [bin('@arethetypeswrong/cli/dist/index.js'), projects.tarball, '--exclude-entrypoints', ...wasm];
  assert.match(run(process.execPath, types, projects.folder), /No problems found/);
});
