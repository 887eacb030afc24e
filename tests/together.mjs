// Runs files of tests in one process, one after the other, so that they share a browser, its pages and the packed
// package: `node --test-reporter=tap tests/together.mjs FILE…`. Each file also runs alone.

import { resolve } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';

const files = process.argv.slice(2);
// Tests run in the order in which they are registered. No other test ends before all files are loaded.
const load = async () => {
  for (const file of files) await import(pathToFileURL(resolve(file)).href);
};
const loaded = load();
test(`${files.length} files of tests are there`, () => loaded);
