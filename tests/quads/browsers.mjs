// Tests quads in browsers: compares the GPU engines with the expected verdicts in target/quads, which the test
// `batches_for_browsers` in ../quads.rs writes.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { isDeepStrictEqual } from 'node:util';

const folder = new URL('../../target/quads/', import.meta.url);

/**
 * @typedef {{ kind: string, quads: number, ties: number, labelled: number, angle: number, fold: number, deviation: number }} Tally
 * @type {{ index: number, dimension: 2 | 3, isWide: boolean, beta: number, deviation: number | null, tallies: Tally[] }[]}
 */
const batches = JSON.parse(readFileSync(new URL('batches.json', folder), 'utf8'));

/** The coordinates of a quad. */
function numbers({ index, dimension }, quad) {
  const { buffer } = new Uint8Array(readFileSync(new URL(`${index}.positions`, folder)));
  return `[${new Float64Array(buffer, 32 * dimension * quad, 4 * dimension).join(', ')}]`;
}

const columns = ['quads', 'ties', 'labelled', 'angle', 'fold', 'deviation', 'mismatches'];

/** Adds the numbers of each column to `sums`. */
function add(sums, numbers) {
  for (const column of columns) sums[column] = (sums[column] ?? 0) + numbers[column];
}

/** Runs batches on an engine, prints its table, and fails if a quad is decided wrongly. */
export async function check(page, { title, backend }, takes) {
  const began = performance.now();
  /** @type {Map<string, Record<string, number>>} */
  const rows = new Map();
  const all = {};
  const mismatches = [];
  for (const batch of batches.filter(takes)) {
    const found = await page.evaluate(([batch, backend]) => window.iterate(batch, backend), [batch, backend]);
    const expected = { labelled: 0, angle: 0, fold: 0, deviation: 0 };
    let first = 0;
    for (const { kind, ...tally } of batch.tallies) {
      const wrong = found.wrong.filter((quad) => quad >= first && quad < first + tally.quads);
      first += tally.quads;
      const of = `of batch ${batch.index}, ${kind}, β = ${batch.beta}`;
      mismatches.push(...wrong.map((quad) => `quad ${quad} ${of}: ${numbers(batch, quad)}`));
      const row = `${batch.dimension}D ${batch.isWide ? 'f64' : 'f32'} | ${kind}`;
      rows.set(row, rows.get(row) ?? {});
      for (const sums of [rows.get(row), all]) add(sums, { ...tally, mismatches: wrong.length });
      for (const verdict of Object.keys(expected)) expected[verdict] += tally[verdict];
    }
    const counted = { labelled: found.labelled, angle: 0, fold: 0, deviation: 0, ...found.blocked };
    if (!isDeepStrictEqual(counted, expected)) {
      mismatches.push(`batch ${batch.index}: ${JSON.stringify(counted)}, not ${JSON.stringify(expected)}`);
    }
  }
  const seconds = ((performance.now() - began) / 1000).toFixed(1);
  const line = (row, sums, last) => `| ${[title, row, ...columns.map((column) => sums[column]), last].join(' | ')} |`;
  console.log(
    [
      '',
      '| engine | mesh | kind | quads | exact ties | labelled | angle | fold | deviation | mismatches | seconds |',
      '|---|---|---|---:|---:|---:|---:|---:|---:|---:|---:|',
      ...[...rows].map(([row, sums]) => line(row, sums, '')).sort(),
      line('all | all', all, seconds),
    ].join('\n'),
  );
  assert.deepEqual(mismatches, []);
}
