// The packed package in projects of webpack and Parcel, with the settings of their lines in docs/package.md and no others:
// each of them takes apart in its own way what the page, a worker and a script that is loaded later have in common. Uses
// the existing dist/, and the programs that tests/bundlers installs.

import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { closeAll, ISOLATED, serve } from '../browsers.mjs';
import { documented, html, pageProject, textOf, WRITTEN } from './page-project.mjs';
import { Projects, repository, run } from './project.mjs';

const bundlers = join(repository, 'tests/bundlers');
const require = createRequire(join(bundlers, 'package.json'));
const projects = new Projects(join(bundlers, 'projects-'));

after(async () => {
  await closeAll();
  projects.remove();
});

/** What the page in this folder writes. */
const writtenIn = async (folder) => textOf(await serve(folder, ISOLATED));

test('webpack', async () => {
  documented('webpack 5', '`experiments: { outputModule: true }`, `output: { module: true }`');
  const root = pageProject(projects, 'webpack', {}, './main.mjs');
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
  assert.equal(await writtenIn(join(root, 'out')), WRITTEN);
});

test('Parcel', async () => {
  const settings = [
    '"@parcel/resolver-default": { "packageExports": true }',
    // Without it, a script that a worker loads later lacks what it shares with the worker's.
    '"@parcel/bundler-default": { "disableSharedBundles": true }',
  ].join(', ');
  documented('Parcel 2', settings);
  const root = pageProject(projects, 'parcel', JSON.parse(`{ ${settings} }`));
  const parcel = join(bundlers, 'node_modules/parcel/lib/bin.js');
  const paths = ['--dist-dir', 'out', '--cache-dir', 'cache', '--public-url', './'];
  run(process.execPath, [parcel, 'build', 'index.html', '--no-cache', ...paths], root);
  assert.equal(await writtenIn(join(root, 'out')), WRITTEN);
});
