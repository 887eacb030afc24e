// Measures the package in dist/: the WebAssembly modules, and the scripts of each entry, bundled and minified as in a
// program that uses it. `node tools/sizes.mjs` prints the sizes and fails if one exceeds its budget.

import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { brotliCompressSync, gzipSync } from 'node:zlib';
import * as esbuild from 'esbuild';

const root = fileURLToPath(new URL('..', import.meta.url));

/** The most bytes after gzip. */
const BUDGETS = {
  'edgeflip_bg.wasm': 172 * 1024,
  edgeflip: 22 * 1024,
  'edgeflip/inline': 1.4 * 140 * 1024,
  'edgeflip/worker': 2_700,
  'edgeflip/files': 6_000,
  'edgeflip/three': 6_000,
  'edgeflip/gltf-transform': 6_000,
  // Together never more than 60 KB.
  'edgeflip_points_bg.wasm': 52 * 1024,
  'edgeflip/points': 8_000,
  'edgeflip_point_session_bg.wasm': 50 * 1024,
};

/** The entry that does not need `edgeflip`: all that it loads at once counts, bundled alone. */
const ALONE = 'edgeflip/points';
/** The same, with what the page loads for threads. */
const THREADED = 'edgeflip/points, with threads';

/** What else is measured: scripts that are loaded when a run needs them. */
const WHOLE = {
  'edgeflip/three, whole': ['edgeflip/three', 'dist/shift.js', 'dist/prepare.js'],
  'edgeflip/gltf-transform, whole': ['edgeflip/gltf-transform', 'dist/shift.js', 'dist/prepare.js'],
  'scripts of WebGL2': ['dist/wasm/edgeflip_webgl2.js', 'dist/glsl.js'],
};

/** Bundles entries: their outputs by name, and what esbuild says about them. */
async function bundled(entryPoints) {
  const { outputFiles, metafile } = await esbuild.build({
    absWorkingDir: root,
    entryPoints,
    bundle: true,
    splitting: true,
    minify: true,
    format: 'esm',
    outdir: 'target/sizes',
    metafile: true,
    write: false,
  });
  const nameOf = ({ path }) => path.replaceAll('\\', '/').split('target/sizes/')[1];
  return { text: new Map(outputFiles.map((file) => [nameOf(file), file])), metafile };
}

/**
 * The bytes of each module, of the scripts of each entry, and of scripts that are loaded later. Those of `edgeflip` count
 * only for it, `edgeflip/inline` and `edgeflip/points`.
 */
export async function measured() {
  const { exports } = JSON.parse(readFileSync(`${root}package.json`, 'utf8'));
  const entries = Object.fromEntries(
    Object.entries(exports).flatMap(([path, { import: given }]) =>
      given ? [[`edgeflip${path.slice(1)}`, given.default.replace('./', '')]] : [],
    ),
  );
  const { [ALONE]: alone, ...others } = entries;
  const { text, metafile } = await bundled(Object.values(others));
  const { text: textAlone, metafile: metafileAlone } = await bundled([alone]);

  /** What an entry, or a script that is loaded later, loads at once. */
  function scripts(entry, { outputs: all } = metafile) {
    const outputs = Object.entries(all);
    const [first] = outputs.find(([, { entryPoint }]) => entryPoint === (entries[entry] ?? entry));
    const found = new Set([first]);
    for (const output of found) {
      for (const { path, kind, external } of all[output].imports) {
        if (kind === 'import-statement' && !external) found.add(path);
      }
    }
    return found;
  }

  const core = scripts('edgeflip');
  const all = (names, from = text) =>
    Buffer.concat([...names].map((name) => from.get(name.split('target/sizes/')[1]).contents));
  return new Map([
    ...['', '_threads', '_webgl2', '_untangle', '_audit', '_files', '_points', '_points_threads', '_point_session'].map(
      (name) => [`edgeflip${name}_bg.wasm`, readFileSync(`${root}dist/wasm/edgeflip${name}_bg.wasm`)],
    ),
    ...Object.keys(others).map((entry) => {
      const isWhole = ['edgeflip', 'edgeflip/inline'].includes(entry);
      return [entry, all([...scripts(entry)].filter((name) => isWhole || !core.has(name)))];
    }),
    [ALONE, all(scripts(ALONE, metafileAlone), textAlone)],
    [THREADED, Buffer.concat([...textAlone.values()].map(({ contents }) => contents))],
    ...Object.entries(WHOLE).map(([name, parts]) => {
      const found = new Set(parts.flatMap((part) => [...scripts(part)]));
      return [name, all([...found].filter((script) => !core.has(script)))];
    }),
  ]);
}

/** Kilobytes after gzip, in whole numbers, so that sums agree wherever they are written. */
export async function kilobytes() {
  const names = [...(await measured())].map(([name, bytes]) => [name, Math.round(gzipSync(bytes).length / 1024)]);
  return Object.fromEntries(names);
}

async function print() {
  console.log('\n| module, or scripts of an entry beside those of `edgeflip` | bytes | gzip | brotli | budget, gzip |');
  console.log('|---|---:|---:|---:|---:|');
  for (const [name, bytes] of await measured()) {
    const zipped = gzipSync(bytes).length;
    const most = BUDGETS[name];
    console.log(`| ${name} | ${bytes.length} | ${zipped} | ${brotliCompressSync(bytes).length} | ${most ?? ''} |`);
    if (zipped > most) {
      console.error(`sizes: ${name} has ${zipped} bytes gzipped; its budget is ${most}`);
      process.exitCode = 1;
    }
  }
}

if (process.argv[1] === fileURLToPath(import.meta.url)) await print();
