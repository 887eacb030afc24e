// Runs every level of tests in order and ends with a table: `npm test`, or `npm test -- NAME…` for the levels
// whose name contains one of the words. It fails when a level fails, when one ran no test, and when a test
// was ignored: a test that does not run proves nothing.

import { spawn, spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

process.chdir(fileURLToPath(new URL('..', import.meta.url)));

/**
 * A level: `checks` are its command lines. Where `counts` is set, they run the test harness of Rust or Node and
 * its tests are counted; otherwise each command is one check.
 * @typedef {{ name: string, what: string, checks: string[][], counts?: boolean, env?: Record<string, string> }} Level
 * @typedef {{ level: Level, passed: number, failed: number, why: string, seconds: number }} Result
 */

// The builds of the library that a browser gets are of `gpu,js`, of `js-webgl2`, of `js-threads`, of `js-audit` and of
// `js-files`.
const wasmWith = (features) => ['--target', 'wasm32-unknown-unknown', '--no-default-features', '--features', features];
const wasm = wasmWith('gpu,js');
const wasmCargo = ['bash', 'tools/wasm-cargo.sh'];

// Targets of cargo in levels below.
const inLevelsBelow = ['wasm', 'worker', 'parity', 'quads'];
/** Always of the whole workspace: else the dependencies, with fewer features, would be compiled again. */
const cargoTest = ['cargo', 'test', '--workspace'];
/** The tests of quads. */
const quads = [...cargoTest, '--test', 'quads', '--'];

// Formats and lints JavaScript and TypeScript: biome.json.
const biome = ['node', 'node_modules/@biomejs/biome/bin/biome', 'ci'];

// The page needs the package in dist/.
const builtPage = [
  ['node', 'node_modules/typescript/bin/tsc', '-p', 'www'],
  ['node', 'node_modules/vite/bin/vite.js', 'build', '-c', 'www/vite.config.js'],
];
const pageTests = (files, atOnce = 1) => [
  ...['node', '--test', `--test-concurrency=${atOnce}`, '--test-reporter=tap'],
  ...files.map((file) => `tests/page/${file}.test.mjs`),
];

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
    what: 'imports run down the rooms of docs/architecture.md, no files import each other in a circle, none is too long',
    checks: [['node', 'tools/layout.mjs']],
  },
  {
    name: 'lints',
    what: 'no warning from clippy in any target, nor from Biome; Cargo.lock fits Cargo.toml',
    checks: [
      ['cargo', 'clippy', '--locked', '--workspace', '--all-targets', '--', '-D', 'warnings'],
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
    what: 'the tests beside the code in src/ and in tools/glsl',
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
    what: 'the library for the browser has no warning from clippy: without what JavaScript calls, and as each module of the package',
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
    what: 'the package builds, TypeScript is strict about it, and its tests pass in Node on the CPU engine, hostile values too; so does the code in README and docs/',
    checks: [
      ['node', 'tools/build.mjs'],
      ['node', 'node_modules/typescript/bin/tsc', '-p', 'tests/package'],
      [
        'node',
        '--test',
        '--test-reporter=tap',
        'tests/package/node.test.mjs',
        'tests/package/docs.test.mjs',
        'tests/package/files.test.mjs',
        'tests/package/gltf.test.mjs',
        'tests/package/weld.test.mjs',
        'tests/package/threads.test.mjs',
        'tests/package/memory.test.mjs',
        'tests/package/limited.test.mjs',
        'tests/package/hostile.test.mjs',
        'tests/package/options.test.mjs',
      ],
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
    what: 'the packed package in fresh projects: plain pages in Chromium and Firefox, Vite, TypeScript, on the CPU and WebGPU',
    checks: [
      [
        'node',
        '--test',
        '--test-reporter=tap',
        'tests/package/browser.test.mjs',
        'tests/package/loss.test.mjs',
        'tests/package/waits.test.mjs',
        'tests/package/options.browser.test.mjs',
      ],
    ],
    counts: true,
  },
  {
    name: 'page in Chromium',
    what: 'the demo page opens files, plays, scrubs and downloads on every engine, draws from the buffer that the flips write, and recovers',
    // Two files at a time: a page mostly compiles the kernels for its software GPU, on one thread. What `handover` checks
    // is a matter of time.
    checks: [...builtPage, pageTests(['files', 'opening', 'buffer', 'controls'], 2), pageTests(['handover'])],
    counts: true,
  },
  {
    name: 'page with a large mesh',
    what: 'the demo page plays 720,000 triangles in Chromium as the native program does, without a long task',
    checks: [[...cargoTest, '--no-run'], ...builtPage, pageTests(['large'])],
    counts: true,
  },
  {
    name: 'page in Firefox',
    what: 'the demo page opens a file, plays and scrubs on every engine',
    checks: [...builtPage, pageTests(['firefox'])],
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

/** Runs a command, passes its output on as it comes, and gives its exit status and output when it ends. */
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

/** Command lines that have built something that several levels need. */
const built = new Map();

/** Builds the page once for all levels. */
function runOnce(check, env) {
  if (!builtPage.includes(check)) return run(check, env);
  if (!built.has(check)) built.set(check, run(check, env));
  return built.get(check);
}

/**
 * Sums what Rust's test harness says: `test result: ok. 5 passed; 0 failed; 0 ignored; …`, and what Node's does:
 * `# pass 5`, `# fail 0`, `# skipped 0`.
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
      // A compile error or a crash: no test of it is counted.
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
    `test: no level is named like ${words.join(' or ')}; there are ${levels.map(({ name }) => name).join(', ')}`,
  );
  process.exit(2);
}

/** @type {Result[]} */
const results = [];
// Everything is compiled first, in one go, so that the seconds of a test level are those of its tests.
if (chosen.some(({ checks }) => checks.some(([program, verb]) => program === 'cargo' && verb === 'test')))
  await run([...cargoTest, '--no-run']);
for (const level of chosen) results.push(await runLevel(level));

console.log('\n| level | what it checks | tests | result | seconds |\n|---|---|---:|---|---:|');
for (const { level, passed, failed, why, seconds } of results) {
  const result = failed === 0 ? 'passed' : `FAILED: ${why}`;
  console.log(`| ${level.name} | ${level.what} | ${passed + failed} | ${result} | ${seconds.toFixed(1)} |`);
}
const sum = (key) => results.reduce((total, result) => total + result[key], 0);
console.log(`\n${sum('passed')} passed, ${sum('failed')} failed`);
process.exitCode = sum('failed') === 0 ? 0 : 1;
