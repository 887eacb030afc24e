// Functions that the benchmark pages share: output, a line of a table, the median, and a whole job of edgeflip.

import { FlipSession } from '../dist/index.js';

export const print = (line) => document.querySelector('pre').append(`${line}\n`);
export const row = (cells) => print(`| ${cells.join(' | ')} |`);
/** The text of a number; a dash if it is missing. */
export const cell = (number, digits = 2) => number?.toFixed(digits) ?? '–';
export const median = (times) => times.sort((a, b) => a - b)[times.length >> 1];

/** The result of a whole job, and its milliseconds. */
export async function run(mesh, options) {
  const start = performance.now();
  const session = await FlipSession.create(mesh, options);
  const result = await session.run();
  const ms = performance.now() - start;
  session.free();
  return { result, ms };
}
