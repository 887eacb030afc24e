// Builds the npm package into dist/: `npm run build`. For each of its modules, cargo compiles the library for wasm32,
// wasm-bindgen writes the glue and wasm-opt makes it smaller; tools/glsl writes the programs of the WebGL2 engine; then
// tsc checks the TypeScript and compiles it. Ends with a table of sizes.

import { spawnSync } from 'node:child_process';
import { cpSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { brotliCompressSync, gzipSync } from 'node:zlib';

process.chdir(fileURLToPath(new URL('..', import.meta.url)));

function run(program, ...args) {
  console.log(`$ ${[program, ...args].join(' ')}`);
  const { status, error } = spawnSync(program, args, { stdio: 'inherit' });
  if (status === 0) return;
  console.error(`build: stopped: ${program} failed${error ? `: ${error.message}` : ' (see above)'}`);
  console.error('  If a tool is missing: bash tools/setup.sh');
  process.exit(1);
}

const glue = 'target/js/wasm'; // also where src/js/tsconfig.json finds the types of the modules
// One module for each entry of the package.
const modules = [
  { name: 'edgeflip', features: 'gpu,js' },
  { name: 'edgeflip_files', features: 'js-files' },
];
for (const folder of ['dist', glue]) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
}

for (const { name, features } of modules) {
  run('bash', 'tools/wasm-cargo.sh', 'build', '--lib', '--profile', 'web', '--target', 'wasm32-unknown-unknown',
    '--no-default-features', '--features', features);
  run('target/setup/bin/wasm-bindgen', '--target', 'web', '--out-dir', glue, '--out-name', name,
    '--remove-producers-section', 'target/wasm/wasm32-unknown-unknown/web/edgeflip.wasm');
}
cpSync(glue, 'dist/wasm', { recursive: true });
// The features that rustc turns on for wasm32; every browser with WebGPU has them, and all since 2022.
const wasmFeatures = ['bulk-memory', 'bulk-memory-opt', 'call-indirect-overlong', 'multivalue', 'mutable-globals',
  'nontrapping-float-to-int', 'reference-types', 'sign-ext'];
for (const { name } of modules) {
  const wasm = `dist/wasm/${name}_bg.wasm`;
  run(process.execPath, 'node_modules/binaryen/bin/wasm-opt', '-Oz', '--strip-debug',
    ...wasmFeatures.map((feature) => `--enable-${feature}`), wasm, '-o', wasm);
}
run('cargo', 'run', '--package', 'glsl', '--', 'dist/glsl.js');
run(process.execPath, 'node_modules/typescript/bin/tsc', '-p', 'src/js');

console.log('\n| file | bytes | gzip | brotli |\n|---|---:|---:|---:|');
const glueFiles = modules.flatMap(({ name }) => [`wasm/${name}_bg.wasm`, `wasm/${name}.js`]);
for (const file of [...glueFiles, 'glsl.js', 'session.js', 'index.js', 'files.js'].map((file) => `dist/${file}`)) {
  const bytes = readFileSync(file);
  console.log(`| ${file} | ${bytes.length} | ${gzipSync(bytes).length} | ${brotliCompressSync(bytes).length} |`);
}
