// Builds the npm package into dist/: `npm run build`. For each of its modules, cargo compiles the library for wasm32.
// If the compiled code has changed, wasm-bindgen writes the glue, the panic code is removed and wasm-opt shrinks the
// module. tools/glsl writes the shaders of the WebGL2 engine; tsc checks and compiles the TypeScript. Ends with a table
// of sizes.

import { spawn, spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import binaryen from 'binaryen';

process.chdir(fileURLToPath(new URL('..', import.meta.url)));

/** Runs a program. If it fails, the build stops. */
function run(program, ...args) {
  console.log(`$ ${[program, ...args].join(' ')}`);
  return new Promise((resolve) => {
    const stop = (why) => {
      console.error(`build: stopped: ${program} failed${why}`);
      console.error('  If a tool is missing: bash tools/setup.sh');
      process.exit(1);
    };
    const child = spawn(program, args, { stdio: 'inherit' });
    child.on('error', (error) => stop(`: ${error.message}`));
    child.on('close', (status) => (status === 0 ? resolve() : stop(' (see above)')));
  });
}

const glue = 'target/js/wasm'; // src/js/tsconfig.json finds the types of the modules here
// In the engines, only functions with an attribute and tiny functions are inlined. The hot functions have the
// attribute; the module is a quarter smaller. Only loops of a known length are unrolled, and wholly only those of up to 4
// rounds: 4 % smaller.
const engine = ['-C', 'llvm-args=-inline-threshold=10 -unroll-runtime=0 -unroll-full-max-count=4'];
// Only explicit vector code uses vectors: no slower, and 2 % smaller.
// The panic code is removed below, so the modules need no source locations.
const all = ['-C', 'no-vectorize-loops', '-C', 'no-vectorize-slp', '-Z', 'location-detail=none'];
// One module for each entry of the package that has its own, and one each for the WebGL2 engine, the threads of the CPU
// engine and of the points, the repair and the audit. wasm-opt takes longest over the files, so they come first.
const modules = [
  { name: 'edgeflip_files', features: 'js-files', flags: [] },
  { name: 'edgeflip', features: 'gpu,js', flags: engine },
  { name: 'edgeflip_webgl2', features: 'js-webgl2', flags: engine },
  { name: 'edgeflip_threads', features: 'js-threads', flags: engine, options: ['--threads'] },
  { name: 'edgeflip_untangle', features: 'js-untangle', flags: engine },
  { name: 'edgeflip_audit', features: 'js-audit', flags: [] },
  { name: 'edgeflip_points', features: 'js-points', flags: engine },
  { name: 'edgeflip_point_session', features: 'js-point-session', flags: engine },
  { name: 'edgeflip_points_threads', features: 'js-points-threads', flags: engine, options: ['--threads'] },
];
// The features that rustc enables for wasm32, and SIMD. All browsers have had them since 2023, and so has every browser
// with WebGPU.
const wasmFeatures = [
  'bulk-memory',
  'bulk-memory-opt',
  'call-indirect-overlong',
  'multivalue',
  'mutable-globals',
  'nontrapping-float-to-int',
  'reference-types',
  'sign-ext',
  'simd',
];

const sha256 = (...parts) => parts.reduce((hash, part) => hash.update(part), createHash('sha256')).digest('hex');
// The tools that process the output of cargo: this file, wasm-bindgen and binaryen.
const bindgen = 'target/setup/bin/wasm-bindgen';
const tools = [
  readFileSync('tools/build.mjs'),
  spawnSync(bindgen, ['--version']).stdout ?? '',
  readFileSync('node_modules/binaryen/package.json'),
];

// Runs in parallel with the modules. Not optimized: it compiles in a third of the time, and runs once.
const shaders = run('cargo', 'run', '--package', 'glsl', '--profile', 'tool', '--', 'target/js/glsl.js');

mkdirSync(glue, { recursive: true });
const finishing = [];

/** Compiles a module. It is finished while cargo compiles the next one. */
async function compile(module) {
  const { name, features, flags, options = [] } = module;
  await run(
    'bash',
    'tools/wasm-cargo.sh',
    ...options,
    'rustc',
    '--lib',
    '--crate-type',
    'cdylib',
    '--profile',
    'web',
    '--target',
    'wasm32-unknown-unknown',
    '--no-default-features',
    '--features',
    features,
    '--',
    ...all,
    ...flags,
  );
  const folder = options.includes('--threads') ? 'wasm-threads' : 'wasm';
  const compiled = `target/${folder}/wasm32-unknown-unknown/web/edgeflip.wasm`;
  // If cargo's file and the tools are unchanged, so is the module.
  const stamp = `${glue}/${name}.sha256`;
  const inputs = sha256(readFileSync(compiled), ...tools);
  if (existsSync(stamp) && readFileSync(stamp, 'utf8') === inputs) return;
  rmSync(stamp, { force: true });
  // The scripts always say where the module is. With another path in the script of a thread, webpack's workers hang.
  const more = ['--remove-producers-section', '--omit-default-module-path'];
  await run(bindgen, '--target', 'web', '--out-dir', glue, '--out-name', name, ...more, compiled);
  finishing.push(optimize(module).then(() => writeFileSync(stamp, inputs)));
}

async function compileAll(chosen) {
  for (const module of chosen) await compile(module);
}

// The threads have a target directory of their own (tools/wasm-cargo.sh), so that cargo can compile them beside the
// other modules, each of which it links on one core.
await Promise.all([
  compileAll(modules.filter(({ options }) => !options)),
  compileAll(modules.filter(({ options }) => options)),
]);
await Promise.all(finishing);

rmSync('dist', { recursive: true, force: true });
for (const { name } of modules) {
  for (const end of ['.js', '.d.ts', '_bg.wasm', '_bg.wasm.d.ts'])
    cpSync(`${glue}/${name}${end}`, `dist/wasm/${name}${end}`);
}

// `edgeflip/inline` has the module of the engines inside its script.
const inlined = gzipSync(readFileSync('dist/wasm/edgeflip_bg.wasm'), { level: 9 }).toString('base64');
writeFileSync('dist/inline-core.js', `export default '${inlined}';\n`);

/** Removes the panic code of a module and shrinks it. */
async function optimize({ name, options }) {
  const wasm = `${glue}/${name}_bg.wasm`;
  cutPanics(wasm);
  // --low-memory-unused: no pointer of Rust is below 1024, because the stack is first in memory and grows down from 1
  // MiB. The first -Oz makes further savings possible. --flatten and --rereloop then make the control flow anew, and
  // the last two shrink it.
  const features = options ? [...wasmFeatures, 'threads'] : wasmFeatures;
  await run(
    process.execPath,
    'node_modules/binaryen/bin/wasm-opt',
    '-Oz',
    '--flatten',
    '--rereloop',
    '-Oz',
    '-Oz',
    '--low-memory-unused',
    '--strip-debug',
    ...features.map((feature) => `--enable-${feature}`),
    wasm,
    '-o',
    wasm,
  );
}

/**
 * Replaces the body of each panic function by a trap. A panic ends with a trap anyway, and nobody sees its message.
 * The functions that run when memory runs out get a call of `outOfMemory`, which throws.
 */
function cutPanics(file) {
  const panics = /^(core|alloc)\b.*::(panicking::.*|panic_\w+|\w+_fail(ed)?)$/;
  // Writes the formats of textures, for a message of a panic in wgpu.
  const formats = /^<wgpu_types\b.*::TextureFormat as core\b.*::Debug>::fmt$/;
  const memory = /^alloc\b.*::(handle_alloc_error|handle_error|capacity_overflow)$/;
  const module = binaryen.readBinary(readFileSync(file));
  const outOfMemory = binaryen.getExportInfo(module.getExport('outOfMemory')).value;
  const hooks = new Set();
  for (let i = 0; i < module.getNumFunctions(); i++) {
    const found = module.getFunctionByIndex(i);
    const { name } = binaryen.getFunctionInfo(found);
    if (panics.test(name) || formats.test(name)) binaryen.Function.setBody(found, module.unreachable());
    const [, hook] = memory.exec(name) ?? [];
    if (!hook) continue;
    hooks.add(hook);
    binaryen.Function.setBody(
      found,
      module.block(null, [module.call(outOfMemory, [], binaryen.none), module.unreachable()]),
    );
  }
  if (hooks.size < 3)
    throw new Error(`${file}: found ${hooks.size} of the 3 functions of alloc that run when memory runs out`);
  writeFileSync(file, module.emitBinary());
  module.dispose();
}

await Promise.all([
  shaders.then(() => cpSync('target/js/glsl.js', 'dist/glsl.js')),
  // --skipLibCheck: checking the types of Node and WebGPU would double the time.
  run(process.execPath, 'node_modules/typescript/bin/tsc', '-p', 'src/js', '--skipLibCheck'),
]);

// Programs in CommonJS get the same modules by `require`; TypeScript needs declarations of its own for them.
mkdirSync('dist/cjs');
writeFileSync('dist/cjs/package.json', '{ "type": "commonjs" }\n');
for (const file of readdirSync('dist', { recursive: true })) {
  if (file.endsWith('.d.ts') && !file.startsWith('cjs')) cpSync(`dist/${file}`, `dist/cjs/${file}`);
}
const { exports } = JSON.parse(readFileSync('package.json', 'utf8'));
for (const { require } of Object.values(exports)) {
  if (!require) continue;
  const file = require.default.split('/').at(-1);
  writeFileSync(`dist/cjs/${file}`, `module.exports = require('../${file}');\n`);
}

await run(process.execPath, 'tools/sizes.mjs');
