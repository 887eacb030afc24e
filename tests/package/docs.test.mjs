// Tests the JavaScript in README and docs/: every block passes strict TypeScript, and each `js` block runs in Node on
// the CPU. So do the programs in examples/. Links in the documents lead to existing files and headings.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { riggedGlb } from './gltf.mjs';

const repository = fileURLToPath(new URL('../..', import.meta.url));
const pages = readdirSync(join(repository, 'docs')).filter((name) => name.endsWith('.md'));
const documents = ['README.md', 'CONTRIBUTING.md', ...pages.map((name) => `docs/${name}`)].map((name) => ({
  name,
  text: readFileSync(join(repository, name), 'utf8'),
}));
const blocks = documents.flatMap(({ name, text }) =>
  Array.from(text.matchAll(/^```([jt]s)\n([^]*?)^```$/gm), ([, language, code], i) => ({
    name: `${name}, block ${i + 1}`,
    file: `${name.replace(/\W/g, '-')}-${i + 1}`,
    isRun: language === 'js',
    code,
  })),
);

// Inside the repository, so that 'edgeflip' resolves to this package.
mkdirSync(join(repository, 'target'), { recursive: true });
const folder = mkdtempSync(join(repository, 'target/docs-test-'));
after(() => rmSync(folder, { recursive: true, force: true }));

const node = (args) => spawnSync(process.execPath, args, { cwd: folder, encoding: 'utf8' });

test('all blocks pass strict TypeScript', () => {
  assert.ok(blocks.length > 0);
  const compilerOptions = {
    target: 'ES2022',
    module: 'NodeNext',
    lib: ['ES2022', 'ESNext.Float16', 'DOM'], // the types of glTF-Transform have a Float16Array
    types: [],
    strict: true,
    noEmit: true,
  };
  writeFileSync(join(folder, 'tsconfig.json'), JSON.stringify({ compilerOptions, include: ['*.mts'] }));
  for (const { file, code } of blocks) writeFileSync(join(folder, `${file}.mts`), code);
  writeFileSync(join(folder, 'untyped.d.mts'), "declare module '@mapbox/martini';\n");
  const { status, stdout } = node([join(repository, 'node_modules/typescript/bin/tsc'), '-p', folder]);
  assert.equal(status, 0, stdout);
});

for (const { name, file, code } of blocks.filter(({ isRun }) => isRun)) {
  test(`${name} runs`, () => {
    writeFileSync(join(folder, `${file}.mjs`), code);
    const { status, stdout, stderr } = node([`${file}.mjs`]);
    assert.equal(status, 0, stderr);
    if (name === 'README.md, block 1') assert.equal(stdout, '1 flip on cpu: 3,1,2,0,1,3\n');
  });
}

const example = (name, ...args) => {
  const { status, stdout, stderr } = node([join(repository, `examples/${name}.mjs`), ...args]);
  assert.equal(status, 0, stderr);
  return stdout;
};

test('the examples run', () => {
  assert.match(example('one-call'), /^1 flip on cpu: 3,1,2,0,1,3\n/);
  assert.match(
    example('step-by-step'),
    /^iteration 0: .*\niteration 1: .*\n(\d+ flips in \d+ iterations\n)+done; .* \{\}\n$/,
  );
  assert.match(example('delaunator'), /^(frame \d: \d+ flips; edges that are still not Delaunay: \{\}\n){5}$/);
  const [, before, after] = example('simplify').match(/below 20°: (\d+) before, (\d+) after/);
  assert.ok(Number(after) < 0.8 * Number(before));
  const map = join(folder, 'map.svg');
  const [, count] = example('map', map).match(
    /^6818 points; \d+ edges made way for the borders; (\d+) triangles of states/,
  );
  assert.equal(readFileSync(map, 'utf8').split('<path').length - 1, Number(count));
  const cells = join(folder, 'voronoi.svg');
  assert.match(example('voronoi', cells), /^400 cells with 2\d{3} corners\n$/);
  assert.equal(readFileSync(cells, 'utf8').match(/<polygon points="[\d.,]+"/g).length, 400);
  const [input, output] = ['thin.obj', 'delaunay.obj'].map((name) => join(folder, name));
  writeFileSync(input, 'v -3 0 0\nv 0 -1 0\nv 3 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nf 1 3 4\n');
  assert.equal(example('file', input, output), '1 flips\n');
  assert.match(readFileSync(output, 'utf8'), /^usemtl red$/m);
  const [rigged, result] = ['rigged.glb', 'delaunay.glb'].map((name) => join(folder, name));
  writeFileSync(rigged, riggedGlb().bytes);
  assert.match(example('gltf', rigged, result), /^delaunay: \d+ flips in 2 of 2 primitives; every edge is Delaunay\n$/);
  assert.ok(readFileSync(result).length > 1000);
});

/** GitHub's anchor of a heading. */
const anchor = (heading) =>
  heading
    .toLowerCase()
    .replace(/[^\w\- ]/g, '')
    .replaceAll(' ', '-');

test('the links lead to files and headings', () => {
  for (const { name, text } of documents) {
    for (const [, target, heading] of text.matchAll(/\]\(([^)#]*)#?([^)]*)\)/g)) {
      if (/^https?:/.test(target)) continue;
      const path = resolve(repository, target ? join(dirname(name), target) : name);
      assert.ok(existsSync(path), `${name}: ${target}`);
      if (!heading) continue;
      const headings = Array.from(readFileSync(path, 'utf8').matchAll(/^#+ (.*)$/gm), ([, words]) => anchor(words));
      assert.ok(headings.includes(heading), `${name}: ${target}#${heading}`);
    }
  }
});

test('README has at most 1,200 words', () => {
  assert.ok(documents[0].text.split(/\s+/).filter(Boolean).length <= 1200);
});
