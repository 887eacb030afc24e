// Runs every level of tests in order and ends with a table: `npm test`, or `npm test -- NAME…` for the levels whose
// name contains one of the words. It fails if a level fails, if a level runs no test, or if a test is ignored: a test
// that does not run proves nothing.

import { spawn, spawnSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

process.chdir(fileURLToPath(new URL('..', import.meta.url)));

/**
 * A level: `checks` are its command lines. If `counts` is set, the commands run the test harness of Rust or Node, and
 * each of its tests counts; otherwise each command counts as one test. If `beside` is set, the level runs at the same
 * time as the one before it. That saves time, because kernels for a software GPU compile on one thread.
 * @typedef {{ name: string, what: string, checks: string[][], counts?: boolean, beside?: boolean,
 *   env?: Record<string, string> }} Level
 * @typedef {{ level: Level, passed: number, failed: number, why: string, seconds: number }} Result
 */

// The features of the modules for browsers: `gpu,js`, `js-webgl2`, `js-threads`, `js-audit` or `js-files`.
const wasmWith = (features) => ['--target', 'wasm32-unknown-unknown', '--no-default-features', '--features', features];
const wasm = wasmWith('gpu,js');
const wasmCargo = ['bash', 'tools/wasm-cargo.sh'];

// Test targets of cargo that other levels below run.
const inLevelsBelow = ['wasm', 'worker', 'parity', 'quads'];
/** Always the whole workspace: alone, the dependencies would have fewer features and would be compiled again. */
const cargoTest = ['cargo', 'test', '--workspace'];
/** The tests of quads. */
const quads = [...cargoTest, '--test', 'quads', '--'];

// Formats and lints JavaScript and TypeScript, as biome.json says.
const biome = ['node', 'node_modules/@biomejs/biome/bin/biome', 'ci'];

// Checks and builds the page, which needs the package in dist/.
const builtPage = [
  ['node', 'node_modules/typescript/bin/tsc', '-p', 'www'],
  ['node', 'node_modules/vite/bin/vite.js', 'build', '-c', 'www/vite.config.js'],
];

/** A run of files of tests in a folder, `atOnce` at a time, or as many as Node finds right. */
const nodeTests = (folder, files, atOnce) => [
  ...['node', '--test', '--test-reporter=tap', ...(atOnce ? [`--test-concurrency=${atOnce}`] : [])],
  ...files.map((file) => `tests/${folder}/${file}.test.mjs`),
];
const testsIn = (folder) =>
  readdirSync(`tests/${folder}`).flatMap((file) => file.match(/^(.*)\.test\.mjs$/)?.[1] ?? []);

// A new file of tests is in a level by its name.
const isInBrowsers = (file) => file.endsWith('.browser');
const inBrowsers = testsIn('package').filter(isInBrowsers);
const inNode = testsIn('package').filter((file) => !isInBrowsers(file));
const alone = ['handover', 'large', 'firefox'];
const onPage = testsIn('page').filter((file) => !alone.includes(file));

/** @type {Level[]} */
const levels = [
  {
    name: 'formatting',
    what: 'rustfmt and Biome would change nothing',
    checks: [
      ['cargo', 'fmt', '--all', '--check'],
      [...biome, '--linter-enabled=false'],
    ],
  },
  {
    name: 'layout',
    what: 'imports run down the rooms of docs/architecture.md, no files import each other in a circle, no file is too long',
    checks: [['node', 'tools/layout.mjs']],
  },
  {
    name: 'lints',
    what: 'clippy and Biome give no warning; Cargo.lock fits Cargo.toml',
    checks: [
      ['cargo', 'clippy', '--locked', '--workspace', '--all-targets', '--', '-D', 'warnings'],
      // `--all-targets` leaves out the benchmarks with `bench = false`, so they are named here.
      ['cargo', 'clippy', '--locked', '--workspace', '--features', 'baseline', '--bench', '*', '--', '-D', 'warnings'],
      [...biome, '--formatter-enabled=false', '--error-on-warnings'],
    ],
  },
  {
    name: 'docs',
    what: 'the API reference of both languages builds without a warning or a dead link',
    checks: [['node', 'tools/docs.mjs']],
  },
  {
    name: 'unit',
    what: 'the unit tests in src/ and tools/glsl',
    checks: [[...cargoTest, '--lib', '--bins']],
    counts: true,
  },
  ...integrationTests(),
  {
    name: 'quads',
    what: firstSentence(readFileSync('tests/quads.rs', 'utf8')),
    checks: [[...quads, '--skip', 'batches_for_browsers', '--nocapture', '--test-threads=1']],
    counts: true,
  },
  {
    name: 'doc',
    what: 'the examples in the documentation run',
    checks: [[...cargoTest, '--doc']],
    counts: true,
  },
  {
    name: 'wasm32',
    what: 'clippy gives no warning for the library in a browser: without exports for JavaScript, and as each module of the package',
    checks: [
      [...wasmCargo, 'clippy', '--lib', ...wasmWith('gpu'), '--', '-D', 'warnings'],
      [...wasmCargo, 'clippy', '--lib', ...wasmWith('js-webgl2'), '--', '-D', 'warnings'],
      [...wasmCargo, '--threads', 'clippy', '--lib', ...wasmWith('js-threads'), '--', '-D', 'warnings'],
      [...wasmCargo, 'clippy', '--lib', ...wasmWith('js-audit'), '--', '-D', 'warnings'],
      [...wasmCargo, 'clippy', '--lib', ...wasmWith('js-files'), '--', '-D', 'warnings'],
      [...wasmCargo, 'clippy', '--lib', '--test', 'wasm', '--test', 'worker', ...wasm, '--', '-D', 'warnings'],
    ],
  },
  {
    name: 'wasm in Chromium',
    what: firstSentence(readFileSync('tests/wasm.rs', 'utf8')),
    checks: [[...wasmCargo, 'test', '--test', 'wasm', '--test', 'worker', ...wasm]],
    counts: true,
    env: {
      CHROMEDRIVER: process.env.CHROMEDRIVER ?? 'chromedriver',
      CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER: `${process.cwd()}/target/setup/bin/wasm-bindgen-test-runner`,
      WASM_BINDGEN_TEST_TIMEOUT: '600',
    },
  },
  {
    name: 'npm package',
    what: 'the package builds, its types pass strict TypeScript, and its tests and the code in README and docs/ run in Node on the CPU engine',
    checks: [
      ['node', 'tools/build.mjs'],
      ['node', 'node_modules/typescript/bin/tsc', '-p', 'tests/package'],
      nodeTests('package', inNode, 2),
    ],
    counts: true,
  },
  {
    name: 'parity',
    what: `${firstSentence(readFileSync('tests/parity.rs', 'utf8'))}; in browsers also quads and locks`,
    checks: [
      [...cargoTest, '--test', 'parity'],
      [...quads, 'batches_for_browsers'],
      ['node', '--test-reporter=tap', 'tests/engines.test.mjs'],
    ],
    counts: true,
    env: { EDGEFLIP_PARITY: 'target/parity.json' },
  },
  {
    name: 'npm package in browsers',
    what: 'the packed package in fresh projects: plain pages in Chromium and Firefox, every bundler and runtime of docs/package.md, TypeScript, on the CPU and WebGPU',
    checks: [nodeTests('package', inBrowsers)],
    counts: true,
    beside: true,
  },
  {
    name: 'page in Chromium',
    what: 'the demo page opens files, plays, scrubs and downloads on every engine, draws from the buffer that the flips write, and recovers',
    // Two files at a time: a page mostly compiles kernels for the software GPU, on one thread. `handover` runs alone,
    // because it depends on timing.
    checks: [...builtPage, nodeTests('page', onPage, 2), nodeTests('page', ['handover'], 1)],
    counts: true,
  },
  {
    name: 'page with a large mesh',
    what: 'the demo page plays 720,000 triangles in Chromium as the native program does, without a long task',
    checks: [[...cargoTest, '--no-run'], ...builtPage, nodeTests('page', ['large'], 1)],
    counts: true,
  },
  {
    name: 'page in Firefox',
    what: 'the demo page opens a file, plays and scrubs on every engine',
    checks: [...builtPage, nodeTests('page', ['firefox'], 1)],
    counts: true,
  },
];

/** Each other target in tests/ is a level, described by the first sentence of its file's `//!` lines. */
function integrationTests() {
  const metadata = spawnSync('cargo', ['metadata', '--no-deps', '--format-version', '1'], {
    encoding: 'utf8',
    maxBuffer: 2 ** 28,
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  if (metadata.status !== 0) {
    console.error('test: cargo metadata failed (see above), so the tests are not known');
    process.exit(1);
  }
  return JSON.parse(metadata.stdout)
    .packages.flatMap((crate) => crate.targets)
    .filter((target) => target.kind.includes('test') && !inLevelsBelow.includes(target.name))
    .sort((a, b) => (a.name < b.name ? -1 : 1))
    .map((target) => ({
      name: target.name,
      what: firstSentence(readFileSync(target.src_path, 'utf8')) ?? '(its file has no //! line)',
      checks: [[...cargoTest, '--test', target.name]],
      counts: true,
    }));
}

function firstSentence(source) {
  const [block] = source.match(/^(\/\/!.*\n)+/m) ?? [];
  return block
    ?.replace(/^\/\/! ?/gm, '')
    .replace(/\s+/g, ' ')
    .trim()
    .split(/(?<=\.) /)[0]
    .replace(/\.$/, '');
}

/** Runs a command and prints its output as it comes. Resolves to its success and its output. */
function run([program, ...args], env = {}) {
  console.log(`$ ${[program, ...args].join(' ')}`);
  return new Promise((resolve) => {
    const child = spawn(program, args, { env: { ...process.env, ...env }, stdio: ['ignore', 'pipe', 'pipe'] });
    let output = '';
    for (const [from, to] of [
      [child.stdout, process.stdout],
      [child.stderr, process.stderr],
    ]) {
      from.setEncoding('utf8');
      from.on('data', (text) => {
        to.write(text);
        output += text;
      });
    }
    child.on('error', (error) => {
      console.log(`${program}: ${error.message}`);
      resolve({ ok: false, output });
    });
    child.on('close', (status) => resolve({ ok: status === 0, output }));
  });
}

/** The builds that several levels share, by command line. */
const built = new Map();

/** Runs a command, but the builds of the page only once for all levels. */
function runOnce(check, env) {
  if (!builtPage.includes(check)) return run(check, env);
  if (!built.has(check)) built.set(check, run(check, env));
  return built.get(check);
}

/**
 * Sums the counts in the output of a test harness. Rust's prints `test result: ok. 5 passed; 0 failed; 0 ignored; …`,
 * Node's `# pass 5`, `# fail 0`, `# skipped 0`.
 */
function count(output) {
  const sums = { passed: 0, failed: 0, ignored: 0 };
  for (const [, passed, failed, ignored] of output.matchAll(
    /test result: .*?(\d+) passed; (\d+) failed; (\d+) ignored/g,
  )) {
    sums.passed += Number(passed);
    sums.failed += Number(failed);
    sums.ignored += Number(ignored);
  }
  for (const [, what, number] of output.matchAll(/^# (pass|fail|cancelled|skipped|todo) (\d+)$/gm)) {
    const key = { pass: 'passed', fail: 'failed', cancelled: 'failed' }[what] ?? 'ignored';
    sums[key] += Number(number);
  }
  return sums;
}

/** @param {Level} level @returns {Promise<Result>} */
async function runLevel(level) {
  console.log(`\n=== ${level.name}: ${level.what}`);
  const start = performance.now();
  const sums = { passed: 0, failed: 0, ignored: 0 };
  const reasons = [];
  for (const check of level.checks) {
    const { ok, output } = await runOnce(check, level.env);
    const counted = level.counts ? count(output) : { passed: Number(ok), failed: Number(!ok), ignored: 0 };
    for (const key of Object.keys(sums)) sums[key] += counted[key];
    if (!ok && counted.failed === 0) {
      // A compile error or a crash: the harness has counted no failure.
      sums.failed += 1;
      reasons.push('did not build or run to its end');
    } else if (counted.failed > 0) {
      reasons.push(`${counted.failed} failed`);
    }
  }
  if (sums.ignored > 0) {
    reasons.push(`${sums.ignored} ignored`);
    sums.failed += sums.ignored;
  }
  if (sums.passed + sums.failed === 0) {
    reasons.push('no test ran');
    sums.failed += 1;
  }
  const { passed, failed } = sums;
  return { level, passed, failed, why: reasons.join(', '), seconds: (performance.now() - start) / 1000 };
}

const words = process.argv.slice(2);
const chosen = levels.filter(({ name }) => words.length === 0 || words.some((word) => name.includes(word)));
if (chosen.length === 0) {
  console.error(
    `test: no level has ${words.join(' or ')} in its name; the levels are ${levels.map(({ name }) => name).join(', ')}`,
  );
  process.exit(2);
}

/** @type {Result[]} */
const results = [];
// Compiles all native tests first, so that the seconds of a level do not include the compilation.
if (chosen.some(({ checks }) => checks.some(([program, verb]) => program === 'cargo' && verb === 'test')))
  await run([...cargoTest, '--no-run']);
const running = [];
for (const [index, level] of chosen.entries()) {
  running.push(runLevel(level));
  // Without its neighbour, a level runs alone: it may need the result of the level before.
  const next = chosen[index + 1];
  const isBeside = next?.beside && levels.indexOf(next) === levels.indexOf(level) + 1;
  if (!isBeside) results.push(...(await Promise.all(running.splice(0))));
}

console.log('\n| level | what it checks | tests | result | seconds |\n|---|---|---:|---|---:|');
for (const { level, passed, failed, why, seconds } of results) {
  const result = failed === 0 ? 'passed' : `FAILED: ${why}`;
  console.log(`| ${level.name} | ${level.what} | ${passed + failed} | ${result} | ${seconds.toFixed(1)} |`);
}
const sum = (key) => results.reduce((total, result) => total + result[key], 0);
console.log(`\n${sum('passed')} passed, ${sum('failed')} failed`);
process.exitCode = sum('failed') === 0 ? 0 : 1;
