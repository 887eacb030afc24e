// Builds the npm package into dist/: `npm run build`. For each of its modules, cargo compiles the library for wasm32,
// wasm-bindgen writes the glue, panics are cut off and wasm-opt makes the module smaller; tools/glsl writes the programs of the WebGL2
// engine; then tsc checks the TypeScript and compiles it. Ends with a table of sizes.

import { spawnSync } from 'node:child_process';
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { brotliCompressSync, gzipSync } from 'node:zlib';
import binaryen from 'binaryen';

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
// A function of the engines is inlined where it is marked so or nearly free: what is hot is marked, and the rest is a
// quarter smaller. Loops are unrolled only where their length is known: it is no slower, and 2 % smaller.
const engine = ['-C', 'llvm-args=-inline-threshold=10 -unroll-runtime=0'];
// Vectors where they are written, and nowhere else: it is no slower, and 2 % smaller.
// Panics are cut off below, so nothing needs to know where in the source they are.
const all = ['-C', 'no-vectorize-loops', '-C', 'no-vectorize-slp', '-Z', 'location-detail=none'];
// One module for each entry of the package, one for the WebGL2 engine, one for the CPU engine's threads, and one for the
// audit.
const modules = [
  { name: 'edgeflip', features: 'gpu,js', flags: engine },
  { name: 'edgeflip_webgl2', features: 'js-webgl2', flags: engine },
  { name: 'edgeflip_threads', features: 'js-threads', flags: engine, options: ['--threads'] },
  { name: 'edgeflip_audit', features: 'js-audit', flags: [] },
  { name: 'edgeflip_files', features: 'js-files', flags: [] },
];
for (const folder of ['dist', glue]) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
}

for (const { name, features, flags, options = [] } of modules) {
  run('bash', 'tools/wasm-cargo.sh', ...options, 'rustc', '--lib', '--crate-type', 'cdylib', '--profile', 'web',
    '--target', 'wasm32-unknown-unknown', '--no-default-features', '--features', features, '--', ...all, ...flags);
  run('target/setup/bin/wasm-bindgen', '--target', 'web', '--out-dir', glue, '--out-name', name,
    '--remove-producers-section', `${options.length > 0 ? 'target/wasm-threads' : 'target/wasm'}/wasm32-unknown-unknown/web/edgeflip.wasm`);
}
cpSync(glue, 'dist/wasm', { recursive: true });
// The features that rustc turns on for wasm32, and vectors: every browser with WebGPU has them, and all since 2023.
const wasmFeatures = ['bulk-memory', 'bulk-memory-opt', 'call-indirect-overlong', 'multivalue', 'mutable-globals',
  'nontrapping-float-to-int', 'reference-types', 'sign-ext', 'simd'];
for (const { name, options } of modules) {
  const wasm = `dist/wasm/${name}_bg.wasm`;
  cutPanics(wasm);
  // No pointer of Rust is below 1024: the stack, which comes first, grows down from 1 MiB. Done twice, since the first
  // time uncovers more.
  const features = options ? [...wasmFeatures, 'threads'] : wasmFeatures;
  run(process.execPath, 'node_modules/binaryen/bin/wasm-opt', '-Oz', '-Oz', '--low-memory-unused', '--strip-debug',
    ...features.map((feature) => `--enable-${feature}`), wasm, '-o', wasm);
}

/**
 * Where a panic begins, a trap is left, with which it would end: nobody hears what it says before. Where memory cannot be
 * had, `out_of_memory` is called instead, which throws.
 */
function cutPanics(file) {
  const panics = /^(core|alloc)\b.*::(panicking::.*|panic_\w+|\w+_fail(ed)?)$/;
  const memory = /^alloc\b.*::(handle_alloc_error|handle_error|capacity_overflow)$/;
  const module = binaryen.readBinary(readFileSync(file));
  const outOfMemory = binaryen.getExportInfo(module.getExport('outOfMemory')).value;
  const hooks = new Set();
  for (let i = 0; i < module.getNumFunctions(); i++) {
    const place = module.getFunctionByIndex(i);
    const { name } = binaryen.getFunctionInfo(place);
    if (panics.test(name)) binaryen.Function.setBody(place, module.unreachable());
    const [, hook] = memory.exec(name) ?? [];
    if (!hook) continue;
    hooks.add(hook);
    binaryen.Function.setBody(place, module.block(null, [module.call(outOfMemory, [], binaryen.none), module.unreachable()]));
  }
  if (hooks.size < 3) throw new Error(`${file}: of what follows where memory cannot be had, too little has a name that is known`);
  writeFileSync(file, module.emitBinary());
  module.dispose();
}

run('cargo', 'run', '--package', 'glsl', '--', 'dist/glsl.js');
run(process.execPath, 'node_modules/typescript/bin/tsc', '-p', 'src/js');

console.log('\n| file | bytes | gzip | brotli |\n|---|---:|---:|---:|');
const glueFiles = modules.flatMap(({ name }) => [`wasm/${name}_bg.wasm`, `wasm/${name}.js`]);
for (const file of [...glueFiles, 'glsl.js', 'session.js', 'index.js', 'files.js'].map((file) => `dist/${file}`)) {
  const bytes = readFileSync(file);
  console.log(`| ${file} | ${bytes.length} | ${gzipSync(bytes).length} | ${brotliCompressSync(bytes).length} |`);
}
const [engines, most] = ['dist/wasm/edgeflip_bg.wasm', 140 * 1024]; // bytes, gzipped
if (gzipSync(readFileSync(engines)).length > most) {
  console.error(`build: ${engines} has more than ${most} bytes gzipped (see the table)`);
  process.exitCode = 1;
}
