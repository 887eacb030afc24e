// Runs each fuzz target for SECONDS seconds, by default 60, and prints a table: `npm run fuzz -- SECONDS`. It keeps
// inputs with new coverage in fuzz/corpus for the next run, and inputs that fail in fuzz/artifacts. Installs cargo-fuzz
// if it is missing; needs a C++ compiler.

import { spawnSync } from 'node:child_process';
import { mkdirSync, readdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

process.chdir(fileURLToPath(new URL('..', import.meta.url)));
const seconds = Number(process.argv[2] ?? 60);
if (!(seconds > 0)) {
  console.error('fuzz: expected a number of seconds, as in npm run fuzz -- 60');
  process.exit(2);
}

// The coverage for libFuzzer needs unstable flags of the compiler.
const env = { ...process.env, RUSTC_BOOTSTRAP: '1' };

/** Runs cargo. If `captured` is set, the result has its standard error. */
function cargo(args, captured = false) {
  return spawnSync('cargo', args, {
    env,
    encoding: 'utf8',
    maxBuffer: 1 << 30,
    stdio: ['ignore', 'inherit', captured ? 'pipe' : 'inherit'],
  });
}

function orStop({ status, error }, what) {
  if (status === 0) return;
  console.error(`fuzz: ${what} failed${error ? `: ${error.message}` : ' (see above)'}`);
  process.exit(1);
}

if (cargo(['fuzz', '--version'], true).status !== 0) {
  console.error('fuzz: cargo-fuzz is missing; installing it: cargo install cargo-fuzz --locked');
  orStop(cargo(['install', 'cargo-fuzz', '--locked']), 'the installation');
}
orStop(cargo(['fuzz', 'build', '--sanitizer', 'none']), 'the build');

const limits = [`-max_total_time=${seconds}`, '-rss_limit_mb=512', '-malloc_limit_mb=256', '-timeout=5'];
const rows = [];
for (const target of readdirSync('fuzz/seeds').sort()) {
  const corpus = `fuzz/corpus/${target}`;
  mkdirSync(corpus, { recursive: true });
  const run = ['fuzz', 'run', '--sanitizer', 'none', target, corpus, `fuzz/seeds/${target}`, '--', ...limits];
  const { status, stderr } = cargo(run, true);
  const last = (pattern) => [...stderr.matchAll(pattern)].at(-1)?.[1] ?? '–';
  rows.push([target, last(/^#(\d+)\t/gm), last(/ cov: (\d+) /g), status === 0 ? 0 : 1]);
  if (status !== 0) {
    console.error(stderr.slice(-4000));
    process.exitCode = 1;
  }
}
console.log('| target | runs | coverage | crashes |\n|---|---:|---:|---:|');
for (const row of rows) console.log(`| ${row.join(' | ')} |`);
