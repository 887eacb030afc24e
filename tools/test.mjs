// Runs the levels of tests in two lanes and ends with a table: `npm test`, or `npm test -- NAME…` for the levels whose
// name contains one of the words. A level that has passed, and of which nothing has changed since, is not run again;
// `npm test -- --all` runs it. `npm run test:full` runs every level with more cases. A level fails if it runs no test or
// ignores one: a test that does not run proves nothing.

import { spawn } from 'node:child_process';
import { appendFileSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

process.chdir(fileURLToPath(new URL('..', import.meta.url)));
const { isFull, jobs: levels, lightPrograms } = await import('./test/levels.mjs');
const { runAll } = await import('./test/lanes.mjs');
const stamps = await import('./test/stamps.mjs');

/** @typedef {import('./test/levels.mjs').Level} Level */

const started = performance.now();
const words = process.argv.slice(2).filter((word) => !word.startsWith('--'));
const takesAll = isFull || process.argv.includes('--all') || Boolean(process.env.CI);
const byName = new Map(levels.map((level) => [level.name, level]));
const named = levels.filter(
  ({ isBuild, name }) => !isBuild && (words.length === 0 || words.some((word) => name.includes(word))),
);
if (named.length === 0) {
  const names = levels.filter(({ isBuild }) => !isBuild).map(({ name }) => name);
  console.error(`test: no level has ${words.join(' or ')} in its name; the levels are ${names.join(', ')}`);
  process.exit(2);
}

/** The chosen levels with the builds and levels that they come after. */
const needed = new Set(named);
for (const level of needed) for (const name of level.after ?? []) needed.add(byName.get(name));
if ([...needed].every(({ after = [], isPlain }) => isPlain || !after.includes('native programs')))
  Object.assign(byName.get('native programs'), lightPrograms);
const chosen = levels.filter((level) => needed.has(level));

/** How each level and build ended. @type {Map<Level, { passed: number, failed: number, why: string, seconds: number, isUnchanged?: boolean }>} */
const results = new Map();

/** What was kept when the level last passed, if nothing that it depends on has changed since. */
function kept(level) {
  if (takesAll) return undefined;
  const stamp = stamps.kept(level.name, stamps.key(level));
  return stamp && (level.writes ?? []).every((path) => stamps.outputAt(path) === stamp.wrote[path]) ? stamp : undefined;
}

/** Ends the level without running it again, if it can be. */
function skip(level) {
  const stamp = kept(level);
  if (stamp) end(level, { passed: stamp.passed, failed: 0, why: '', seconds: 0, isUnchanged: true });
  return stamp !== undefined;
}

function end(level, result) {
  results.set(level, result);
  const { passed, failed, why, seconds, isUnchanged } = result;
  const how = isUnchanged
    ? 'unchanged since it passed'
    : failed > 0
      ? `FAILED: ${why}`
      : level.isBuild
        ? 'built'
        : `${passed} passed`;
  console.log(`${clock()} ${level.name}: ${how}${isUnchanged ? '' : ` in ${seconds.toFixed(1)} s`}`);
}

function clock() {
  const seconds = Math.round((performance.now() - started) / 1000);
  return `[${Math.floor(seconds / 60)}:${`${seconds % 60}`.padStart(2, '0')}]`;
}

/** Runs a command, and calls `tell` with its output as it comes. Resolves to its success and its output. */
function run([program, ...args], { env = {}, cwd = '.', tell = (_) => {} } = {}) {
  let output = '';
  const add = (text) => {
    output += text;
    tell(text);
  };
  add(`$ ${[program, ...args].join(' ')}\n`);
  return new Promise((resolve) => {
    const child = spawn(program, args, {
      cwd,
      env: { ...process.env, NO_COLOR: '1', ...env },
      stdio: ['ignore', 'pipe', 'pipe'],
    });
    for (const from of [child.stdout, child.stderr]) {
      from.setEncoding('utf8');
      from.on('data', add);
    }
    child.on('error', (error) => add(`${program}: ${error.message}\n`));
    child.on('close', (status) => resolve({ ok: status === 0, output }));
  });
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

/** A program that `native programs` has compiled. */
function compiled(name) {
  const found = JSON.parse(readFileSync(byName.get('native programs').writes[0], 'utf8'))[name];
  if (!found) throw new Error(`no program ${name} was compiled`);
  return found;
}

/** Runs a level or a build. Resolves to whether it has passed. */
async function runLevel(level) {
  if (skip(level)) return true;
  const key = stamps.key(level);
  const start = performance.now();
  const sums = { passed: 0, failed: 0, ignored: 0 };
  const reasons = [];
  const log = `target/test/${level.name.replaceAll(' ', '-')}.log`;
  writeFileSync(log, '');
  const tell = (text) => {
    appendFileSync(log, text);
    if (isWatched) process.stdout.write(text);
  };
  for (const [program, ...args] of level.checks) {
    const { program: path, cwd } = program.startsWith('@') ? compiled(program.slice(1)) : { program };
    const { ok, output } = await run([path, ...args], { env: level.env, cwd, tell });
    const counted = level.counts
      ? count(output)
      : { passed: Number(ok && !level.isBuild), failed: Number(!ok), ignored: 0 };
    for (const key of Object.keys(sums)) sums[key] += counted[key];
    if (!ok && counted.failed === 0) {
      // A compile error or a crash: the harness has counted no failure.
      sums.failed += 1;
      reasons.push('did not build or run to its end');
    } else if (counted.failed > 0) {
      reasons.push(`${counted.failed} failed`);
    }
    const refused = level.refuses?.exec(output)?.[0];
    if (refused !== undefined) {
      sums.failed += 1;
      reasons.push(refused);
    }
    if (!ok && level.isBuild) break;
  }
  if (sums.ignored > 0) {
    reasons.push(`${sums.ignored} ignored`);
    sums.failed += sums.ignored;
  }
  if (sums.passed + sums.failed === 0 && !level.isBuild) {
    reasons.push('no test ran');
    sums.failed += 1;
  }
  const { passed, failed } = sums;
  if (failed > 0 && !isWatched) console.log(readFileSync(log, 'utf8'));
  end(level, { passed, failed, why: reasons.join(', '), seconds: (performance.now() - start) / 1000 });
  const wrote = Object.fromEntries((level.writes ?? []).map((path) => [path, stamps.outputAt(path)]));
  if (!isFull) stamps.keep(level.name, failed === 0 ? { key, passed, wrote } : undefined);
  return failed === 0;
}

mkdirSync('target/test', { recursive: true });
// In this order, because a level comes after its builds.
const stale = [];
for (const level of chosen) {
  const isBuilt = (level.after ?? []).every((name) => results.get(byName.get(name))?.isUnchanged);
  if (!isBuilt || !skip(level)) stale.push(level);
}
// With one level, its output is shown as it comes; otherwise that of the levels that fail.
const isWatched = stale.filter(({ isBuild }) => !isBuild).length === 1;

const parts = [...new Set(stale.flatMap(({ tools }) => tools))];
const byApt = ['rust', 'wasm', 'vulkan', 'chromium', 'firefox'];
const setUp = parts.map((part) => ({
  name: `set-up of ${part}`,
  // The compilers first: they may need packages of the system.
  after: part === 'rust' ? [] : ['set-up of rust', ...(part === 'bindgen' ? ['set-up of wasm'] : [])],
  holds: byApt.includes(part) ? ['apt'] : [],
  isLight: part !== 'bindgen',
  run: async () => {
    const { ok, output } = await run(['bash', 'tools/setup.sh', part]);
    stamps.forget();
    if (ok && output.split('\n').length > 3) console.log(`${clock()} set-up of ${part}: done`);
    if (!ok) console.log(output);
    return ok;
  },
  drop: () => {},
}));
await runAll(
  [
    ...setUp,
    ...stale.map((level) => ({
      ...level,
      after: [...(level.after ?? []), ...level.tools.map((part) => `set-up of ${part}`)],
      run: () => runLevel(level),
      drop: (failed) => end(level, { passed: 0, failed: 1, why: `${failed} failed`, seconds: 0 }),
    })),
  ],
  2,
);

console.log('\n| level | what it checks | tests | result | seconds |\n|---|---|---:|---|---:|');
for (const level of chosen) {
  const { passed, failed, why, seconds, isUnchanged } = results.get(level);
  const result =
    failed > 0 ? `FAILED: ${why}` : isUnchanged ? 'unchanged since it passed' : level.isBuild ? 'built' : 'passed';
  console.log(
    `| ${level.name} | ${level.what} | ${level.isBuild ? '' : passed + failed} | ${result} | ${seconds.toFixed(1)} |`,
  );
}
const all = [...results.values()];
const sum = (key) => all.reduce((total, result) => total + result[key], 0);
console.log(
  `\n${clock()} ${all.filter(({ isUnchanged }) => isUnchanged).length} of ${all.length} levels and builds unchanged`,
);
console.log(`\n${sum('passed')} passed, ${sum('failed')} failed`);
process.exitCode = sum('failed') === 0 ? 0 : 1;
