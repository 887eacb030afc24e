// What a release needs: the versions agree, and the packages for npm and crates.io are complete and small.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join, posix } from 'node:path';
import { test } from 'node:test';
import { repository, run } from './project.mjs';

const text = (name) => readFileSync(join(repository, name), 'utf8');
const npm = JSON.parse(text('package.json'));

test('the npm package and the crate have one version', () => {
  const [, crate] = text('Cargo.toml').match(/^version = "(.*)"$/m);
  assert.equal(npm.version, crate);
  assert.equal(npm.version, JSON.parse(text('package-lock.json')).version);
  assert.match(npm.version, /^\d+\.\d+\.\d+$/);
});

test('npm packs what README links to, and warns of nothing', () => {
  const [{ files }] = JSON.parse(run('npm', ['pack', '--json', '--dry-run', '--ignore-scripts'], repository));
  const packed = new Set(files.map(({ path }) => path));
  for (const [, target] of text('README.md').matchAll(/\]\(([^)#:]+)(#[^)]*)?\)/g)) {
    const path = posix.normalize(target).replace(/\/$/, '');
    assert.ok(packed.has(path) || [...packed].some((file) => file.startsWith(`${path}/`)), target);
  }
});

test('cargo packs the sources that the crate needs', () => {
  const files = run('cargo', ['package', '--list', '--allow-dirty', '--offline'], repository).split('\n');
  for (const name of ['src/lib.rs', 'build.rs', 'README.md', 'LICENSE-MIT', 'LICENSE-APACHE', 'shaders/compose.rs'])
    assert.ok(files.includes(name), name);
  const others = files.filter((name) => /^(dist|target|node_modules|www|tests|benches|\.github|\.ci)\//.test(name));
  assert.deepEqual(others, []);
});
