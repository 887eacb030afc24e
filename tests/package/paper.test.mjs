// The writer of docs/paper.md on fixed measurements, and the arithmetic of the paper's counts.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { DOMParser } from 'linkedom';
import { misfits, paysFrom } from '../../tools/paper/document.mjs';
import { euler, judged, MESHES, speedUpFits, swapped } from '../../tools/paper/theirs.mjs';
import { repository } from './project.mjs';

const folder = mkdtempSync(join(tmpdir(), 'edgeflip-paper-'));
after(() => rmSync(folder, { recursive: true }));

const way = { iterations: 2, total: 4, flips: 3, runs: 5 };
const mesh = (theirs) => ({
  ...judged(theirs).fitting,
  ...{ name: `mesh ${theirs.id}`, beta: 10, boundary: Math.abs(euler(judged(theirs).fitting).boundary) },
  ...{ iterations: 2, flips: 12, remaining: 0, flips_per_iteration: [9, 3] },
  ...{ gpu: way, baseline: { ...way, fault: theirs.id === '1' ? 'edge 1-2 has 4 half-edges' : null } },
  ...{ cpu: { ...way, total: 40 }, lawson: way },
});
const rows = ['random', 'uvsphere', 'delaunay'].flatMap((family) =>
  [100, 1000, 10000].map((edges) => ({ family, edges, flips: 9, gpu: 1, cpu: edges / 500, cores: edges / 2000 })),
);
const strips = (nodes, flips) => ({ name: `strips ${nodes}`, flips });
const data = {
  ...{ commit: 'abc', date: '2026-01-02', runs: 5, enough_s: 10 },
  machine: { cpu: 'a CPU', threads: 16, adapter: 'NVIDIA H200, NVIDIA 580', software: false },
  meshes: [...MESHES.map(mesh), { ...mesh(MESHES[4]), id: '', name: 'uvsphere 4083' }],
  strips: [strips(8, [1, 2, 3, 2, 1]), strips(12, [1, 2, 1]), strips(16, [1, 2, 1]), strips(1000, Array(200).fill(1))],
  figure11: {
    positions: [0, 0, 1, 0, 1, 1, 0, 1],
    triangles: [
      [0, 1, 2, 0, 2, 3],
      [0, 1, 3, 1, 2, 3],
    ],
  },
  crossover: rows,
};

/** The cells of the rows of each table. */
const tables = (text) =>
  text
    .split(/\n\n/)
    .filter((part) => part.startsWith('| '))
    .map((part) => part.split('\n').map((line) => line.slice(2, -2).split(' | ')));

test('the writer puts the paper’s number beside each of ours', () => {
  const from = join(folder, 'measured.json');
  writeFileSync(from, JSON.stringify(data));
  execFileSync('node', ['tools/paper.mjs', '--from', from, '--to', folder], { cwd: repository });
  const text = readFileSync(join(folder, 'docs/paper.md'), 'utf8');
  const compared = tables(text).filter(([head]) => head.includes('paper'));
  assert.equal(compared.length, 5);
  for (const [head, , ...body] of compared) {
    for (const row of body) {
      assert.equal(row.length, head.length, row.join(' | '));
      assert.ok(
        row.every((cell) => cell.length > 0 && !/undefined|NaN|null/.test(cell)),
        row.join(' | '),
      );
      if (/^\d$/.test(row[0]))
        assert.ok(
          head.every((name, i) => name !== 'paper' || row[i] !== '–'),
          row.join(' | '),
        );
    }
  }
  const performance = compared[1];
  assert.deepEqual(performance[6].slice(3, 12), [
    '2',
    '7',
    '0.004',
    '0.003',
    '1.3884',
    '0.04',
    '55.678',
    '10',
    '40.1022',
  ]);
  assert.match(text, /On mesh 1 it is wrong/);
  assert.deepEqual(readdirSync(join(folder, 'benches/results')), ['2026-01-02-h200-paper-abc.json']);
  for (const [, name] of text.matchAll(/\]\((paper\/[^)]+\.svg)\)/g)) {
    const svg = new DOMParser().parseFromString(readFileSync(join(folder, 'docs', name), 'utf8'), 'image/svg+xml');
    assert.equal(svg.documentElement.localName, 'svg', name);
    assert.ok(svg.querySelectorAll('path, rect, line').length > 3, name);
    assert.doesNotMatch(svg.toString(), /NaN|undefined/, name);
  }
});

test('the counts of the paper’s meshes', () => {
  const kinds = MESHES.map((mesh) => judged(mesh).kind);
  assert.deepEqual(kinds, ['swapped', 'swapped', 'closed', 'open', 'closed']);
  const [first, second, third, fourth, fifth] = MESHES;
  for (const mesh of [swapped(first), swapped(second)])
    assert.deepEqual(euler(mesh), { characteristic: -2, boundary: 0 });
  for (const mesh of [third, fifth]) assert.deepEqual(euler(mesh), { characteristic: 2, boundary: 0 });
  assert.deepEqual(euler(fourth), { characteristic: -6152, boundary: 18636 });
  assert.ok(MESHES.every(speedUpFits));
  assert.match(misfits().join('\n'), /Meshes 1 and 2: .*swapped[^]*Mesh 4: 2E − 3T = 18,636[^]*46,860 triangles/);
});

test('the GPU pays from the size on at which it is faster at all larger sizes', () => {
  const at = (edges, gpu, cpu) => ({ edges, gpu, cpu });
  assert.equal(paysFrom([at(10, 2, 1), at(20, 1, 2), at(40, 1, 3)], 'cpu'), 20);
  assert.equal(paysFrom([at(10, 1, 2), at(20, 2, 1), at(40, 1, 3)], 'cpu'), 40);
  assert.equal(paysFrom([at(10, 1, 2), at(20, 2, 1)], 'cpu'), undefined);
});
