// Checks the layout: imports run down the rooms of docs/architecture.md, no files import each other in a circle, no file
// is longer than 450 lines, and each heading in a comment of rustdoc is alone on its line. `node tools/layout.mjs`; with
// -v it prints every import.

import { readdirSync, readFileSync } from 'node:fs';
import { posix } from 'node:path';
import { fileURLToPath } from 'node:url';

process.chdir(fileURLToPath(new URL('..', import.meta.url)));

const MOST_LINES = 450;
const folders = ['benches', 'examples', 'fuzz/src', 'shaders', 'src', 'tests', 'tools', 'www'];
const files = folders.flatMap((folder) =>
  readdirSync(folder, { recursive: true })
    .sort()
    .map((file) => posix.join(folder, file)),
);
const text = new Map(
  files
    .filter((file) => /\.(rs|ts|m?js|css|html|wgsl)$/.test(file) && !file.includes('/node_modules/'))
    .map((file) => [file, readFileSync(file, 'utf8')]),
);
const errors = [];

for (const [file, content] of text) {
  const lines = content.split('\n').length - 1;
  if (lines > MOST_LINES) errors.push(`${file}: ${lines} lines; at most ${MOST_LINES} are allowed`);
  if (!file.endsWith('.rs')) continue;
  content.split('\n').forEach((line, i) => {
    const [, heading] = line.match(/^\s*\/\/[/!] (#+ (?:Errors|Examples?|Panics|Safety)) /) ?? [];
    if (heading) errors.push(`${file}:${i + 1}: text follows the heading \`${heading}\`; begin a new line`);
  });
}

// Rust: what each file imports, by the path of its module, such as `engine::cpu::engine`.

const isTest = (file) => /(^|\/)tests(\/|\.rs$)|predicates\/tiers\.rs$/.test(file);
const crate = [...text.keys()].filter((file) => /^src\/.*\.rs$/.test(file) && !file.startsWith('src/bin/'));
const moduleOf = (file) =>
  file
    .slice('src/'.length)
    .replace(/(\/?mod)?\.rs$/, '')
    .replace(/^lib$/, '')
    .replaceAll('/', '::');
const fileOf = new Map(crate.map((file) => [moduleOf(file), file]));

/** The source without comments and tests. */
function bare(source) {
  const code = source.replace(/\/\/[^\n]*/g, '').replace(/pub\(in [\w:]+\)/g, 'pub');
  const tests = code.search(/#\[cfg\([^\n]*\btest\b[^\n]*\)\]\nmod tests \{/);
  return (tests < 0 ? code : code.slice(0, tests))
    .replace(/#\[cfg\(test\)\]\s*(pub(\([^)]*\))?\s+)?use [^;]+;/g, '')
    .replace(/#\[cfg\(test\)\]\s*impl \w+ \{[^]*?\n\}\n/g, '');
}

/** The paths of a use tree: `a::{b, c::{self, d}}` is `a::b`, `a::c` and `a::c::d`. */
function expand(tree) {
  const open = tree.indexOf('{');
  if (open < 0) return [tree.split(' as ')[0].trim()];
  const prefix = tree.slice(0, open).trim();
  const parts = [''];
  let depth = 0;
  for (const character of tree.slice(open + 1, tree.lastIndexOf('}'))) {
    depth += Number(character === '{') - Number(character === '}');
    if (character === ',' && depth === 0) parts.push('');
    else parts[parts.length - 1] += character;
  }
  const paths = parts.map((part) => part.trim()).filter(Boolean);
  return paths.flatMap(expand).map((path) => (path === 'self' ? prefix.replace(/::$/, '') : prefix + path));
}

/** The path from the root of the crate; `undefined` for another crate. */
function absolute(path, module) {
  const [first, ...rest] = path.split('::');
  if (first === 'crate') return rest.join('::');
  if (first === 'self') return [module, ...rest].join('::');
  if (first === 'super') {
    const parent = module.split('::').slice(0, -1).join('::');
    return rest[0] === 'super' ? absolute(rest.join('::'), parent) : [parent, ...rest].filter(Boolean).join('::');
  }
  const child = [module, first].filter(Boolean).join('::');
  return fileOf.has(child) ? [child, ...rest].join('::') : undefined;
}

const used = new Map();
const renamed = new Map();
for (const [module, file] of fileOf) {
  const code = bare(text.get(file));
  const uses = [...code.matchAll(/\buse\s+([^;]+);/g)].flatMap(([, tree]) => expand(tree));
  const inline = [...code.replace(/\buse\s+[^;]+;/g, '').matchAll(/\b(?:crate|super)(?:::\w+)+/g)].map(
    ([path]) => path,
  );
  const paths = [...uses, ...inline].map((path) => absolute(path, module)).filter((path) => path !== undefined);
  used.set(module, paths);
  for (const path of paths) renamed.set([module, path.split('::').at(-1)].filter(Boolean).join('::'), path);
}

/** The module that defines the name in a path; follows re-exports. */
function definer(path, depth = 0) {
  const words = path.split('::');
  for (let length = words.length; length >= 0; length--) {
    const module = words.slice(0, length).join('::');
    if (!fileOf.has(module)) continue;
    const to = length < words.length && depth < 8 ? renamed.get(words.slice(0, length + 1).join('::')) : undefined;
    if (to === undefined || to === words.slice(0, length + 1).join('::')) return module;
    return definer([to, ...words.slice(length + 1)].join('::'), depth + 1);
  }
  return '';
}

const imports = new Map();
for (const [module, paths] of used) {
  if (module === '' || isTest(fileOf.get(module))) continue;
  const file = fileOf.get(module);
  const to = paths.map((path) => fileOf.get(definer(path)));
  imports.set(file, new Set(to.filter((other) => other !== file && other !== 'src/lib.rs')));
}

// The order: the first column of the tables in docs/architecture.md, of the crate and then of its engines.

const [, , house] =
  readFileSync('docs/architecture.md', 'utf8')
    .split(/^## /m)[1]
    .match(/(^|\n)(\|[^]*)/) ?? [];
const rows = (house ?? '').split('\n').filter((line) => line.startsWith('| `'));
const rooms = rows.map((row) => [...row.split('|')[1].matchAll(/`([^`]+)`/g)].map(([, name]) => name));
const engine = rooms.findIndex(([name]) => name === 'engine/');
const order = rooms.slice(0, rooms.findIndex((names) => names.includes('error.rs')) + 1);
const inside = rooms.slice(order.length).filter((names) => !names.some((name) => /^(src|shaders|www)\//.test(name)));
order.splice(engine, 0, ...inside.map((names) => names.map((name) => `engine/${name}`)));
const room = (file) => order.findIndex((names) => names.some((name) => file.startsWith(`src/${name}`)));
const isFacade = (file) => file === 'src/engine/mod.rs';
for (const [file, to] of imports) {
  for (const other of to) {
    if (process.argv.includes('-v')) console.log(`${file} -> ${other}`);
    if (isFacade(file) || isFacade(other)) continue;
    if (room(file) < 0 || room(other) < 0)
      errors.push(`${file} imports ${other}, and docs/architecture.md has no room for one of them`);
    else if (room(other) < room(file)) errors.push(`${file} imports ${other}, which is in a room above`);
  }
}

// The program, and TypeScript: paths of files.

for (const [file, content] of text) {
  const to = new Set();
  if (/^src\/bin\//.test(file)) {
    for (const [, module] of bare(content).matchAll(/\b(?:mod|use crate::|use)\s+?(\w+)(?=;|::)/g))
      to.add(posix.join(posix.dirname(file), `${module}.rs`));
    for (const [, module] of bare(content).matchAll(/\bcrate::(\w+)/g))
      to.add(posix.join(posix.dirname(file), `${module}.rs`));
  } else if (/^(src\/js|www)\/.*\.ts$/.test(file)) {
    const code = content.replace(/\/\*[^]*?\*\//g, '').replace(/(^|\s)\/\/[^\n]*/g, '');
    for (const [, path] of code.matchAll(/(?:\bfrom\s*|\bimport\s*\(?\s*|new URL\()['"](\.[^'"?]+)/g)) {
      to.add(posix.join(posix.dirname(file), path.replace(/\.js$/, '.ts')));
    }
  } else continue;
  imports.set(file, new Set([...to].filter((other) => other !== file && text.has(other))));
}

// Circles, by Tarjan's algorithm.

const index = new Map();
const low = new Map();
const stack = [];
function visit(file) {
  index.set(file, index.size);
  low.set(file, index.get(file));
  stack.push(file);
  for (const other of imports.get(file) ?? []) {
    if (!index.has(other)) visit(other);
    if (stack.includes(other)) low.set(file, Math.min(low.get(file), low.get(other)));
  }
  if (low.get(file) !== index.get(file)) return;
  const circle = stack.splice(stack.indexOf(file));
  if (circle.length > 1) errors.push(`files import each other in a circle: ${circle.join(', ')}`);
}
for (const file of imports.keys()) if (!index.has(file)) visit(file);

const count = [...imports.values()].reduce((sum, to) => sum + to.size, 0);
for (const error of errors) console.error(`layout: ${error}`);
console.log(`layout: ${imports.size} files, ${count} imports, ${order.length} rooms, ${errors.length} errors`);
process.exitCode = errors.length === 0 ? 0 : 1;
