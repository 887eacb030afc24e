// Builds the npm package into dist/: `npm run build`. Cargo compiles the library for wasm32, wasm-bindgen writes the
// glue, wasm-opt makes it smaller, tsc checks the TypeScript and compiles it. Ends with a table of sizes.

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

const glue = 'target/js/wasm'; // also where src/js/tsconfig.json finds the types of the module
const wasm = 'dist/wasm/edgeflip_bg.wasm';
for (const folder of ['dist', glue]) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
}

run('bash', 'tools/wasm-cargo.sh', 'build', '--lib', '--profile', 'web', '--target', 'wasm32-unknown-unknown',
  '--no-default-features', '--features', 'gpu,js');
run('target/setup/bin/wasm-bindgen', '--target', 'web', '--out-dir', glue, '--out-name', 'edgeflip',
  '--remove-producers-section', 'target/wasm/wasm32-unknown-unknown/web/edgeflip.wasm');
cpSync(glue, 'dist/wasm', { recursive: true });
// The features that rustc turns on for wasm32; every browser with WebGPU has them, and all since 2022.
const features = ['bulk-memory', 'bulk-memory-opt', 'call-indirect-overlong', 'multivalue', 'mutable-globals',
  'nontrapping-float-to-int', 'reference-types', 'sign-ext'];
run(process.execPath, 'node_modules/binaryen/bin/wasm-opt', '-Oz', '--strip-debug',
  ...features.map((feature) => `--enable-${feature}`), wasm, '-o', wasm);
run(process.execPath, 'node_modules/typescript/bin/tsc', '-p', 'src/js');

console.log('\n| file | bytes | gzip | brotli |\n|---|---:|---:|---:|');
for (const file of [wasm, 'dist/wasm/edgeflip.js', 'dist/session.js', 'dist/index.js']) {
  const bytes = readFileSync(file);
  console.log(`| ${file} | ${bytes.length} | ${gzipSync(bytes).length} | ${brotliCompressSync(bytes).length} |`);
}
