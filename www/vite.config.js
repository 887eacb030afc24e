// Serves the page during development, and builds it into target/www: static files that any server can serve.

import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import subsetFont from 'subset-font';
import { build, defineConfig } from 'vite';
import { hashOf } from './documents/hash.js';
import { serveDocuments, writeDocuments } from './documents/plugin.js';
import { examplePages } from './documents/site.js';
import { recordedRun } from './engines/read-record.js';
import { packageFacts } from './package/facts.js';

const at = (path) => fileURLToPath(new URL(path, import.meta.url));

/** The address under which the style sheet asks for the font while the server of `npm start` runs. */
const withFont = (html) => html.replace('../target/fonts/inter.woff2', `/@fs${font}`);

// Inter with the characters and the weights of the page.
const [font, fontMark] = [at('../target/fonts/inter.woff2'), at('../target/fonts/inter.stamp')];
const fontStamp = hashOf(at('vite.config.js'), at('../package-lock.json'));
if (!existsSync(font) || !existsSync(fontMark) || readFileSync(fontMark, 'utf8') !== fontStamp) {
  const whole = readFileSync(createRequire(import.meta.url).resolve('inter-ui/variable/InterVariable.woff2'));
  const latin = Array.from({ length: 0x7f - 0x20 }, (_, i) => String.fromCharCode(0x20 + i)).join('');
  const subset = await subsetFont(whole, `${latin} °²×–—‘’“”…→←↑↓αβγλτπ·≤≥✕`, {
    targetFormat: 'woff2',
    variationAxes: { wght: { min: 400, max: 650 }, opsz: { min: 14, max: 32 } },
    // Kerning, digits of one width, and what browsers turn on by themselves; not the other shapes of letters.
    keepFeatures: ['kern', 'tnum', 'calt', 'ccmp', 'locl', 'mark', 'mkmk', 'liga'],
  });
  mkdirSync(at('../target/fonts'), { recursive: true });
  writeFileSync(font, subset);
  writeFileSync(fontMark, fontStamp);
}

// They take seconds, so they are made again only after a change of what makes them.
const sources = ['models.js', 'samples.js', 'scramble.js', 'wireframe.js'].map((name) => at(`models/${name}`));
const [stamp, mark] = [hashOf(...sources, at('../package-lock.json')), at('../target/public.stamp')];
if (!existsSync(mark) || readFileSync(mark, 'utf8') !== stamp) {
  rmSync(at('../target/public'), { recursive: true, force: true });
  await (await import('./models/models.js')).writeModels(at('../target/public'));
  writeFileSync(mark, stamp);
}

// The page's policy, for the header: workers take their policy only from a header.
const [, policy] = readFileSync(at('index.html'), 'utf8').match(/content="(default-src [^"]*)"/);

// The development server inserts imported styles into the page, and serves the examples, whose icons are empty.
const whileWorking = (text) =>
  text
    .replace("style-src 'self'", "style-src 'self' 'unsafe-inline'")
    .replace("img-src 'self'", "img-src 'self' data:");

// Cross-origin isolated, so that the threads of the CPU engine can share memory.
const headersWith = (policy) => ({
  'Content-Security-Policy': policy,
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Embedder-Policy': 'require-corp',
});

// In a project of one's own, `edgeflip` is in node_modules.
const alias = [
  { find: /^edgeflip$/, replacement: at('../dist/index.js') },
  { find: /^edgeflip\/(.*)$/, replacement: at('../dist/$1.js') },
];

/** Modules that the build computes. */
const COMPUTED = { 'virtual:recorded': recordedRun, 'virtual:package': packageFacts };
const computed = {
  name: 'computed',
  resolveId: (id) => (id in COMPUTED ? `\0${id}` : undefined),
  load: async (id) =>
    id.slice(1) in COMPUTED ? `export default ${JSON.stringify(await COMPUTED[id.slice(1)]())}` : undefined,
};

const out = at('../target/www');

/** Too large to be loaded for a visit without a network: the API reference, the examples, and README's picture. */
const large = ['api/', 'examples/assets/', 'docs/page.png', ...examplePages().map((name) => `examples/${name}`)];

/** Builds the service worker, with the list of the files that it keeps. */
async function writeServiceWorker() {
  const all = readdirSync(out, { recursive: true }).map((path) => path.replaceAll('\\', '/'));
  const paths = all.filter(
    (path) => statSync(join(out, path)).isFile() && !large.some((start) => path.startsWith(start)),
  );
  const files = paths.map((path) => ({
    url: path,
    // The names of the other files change with their content.
    revision: path.startsWith('assets') ? null : hashOf(join(out, path)),
  }));
  const lib = { entry: at('shell/offline.ts'), formats: ['iife'], name: 'offline', fileName: () => 'offline.js' };
  await build({
    configFile: false,
    publicDir: false,
    logLevel: 'warn',
    define: { FILES: JSON.stringify(files), 'process.env.NODE_ENV': '"production"' },
    build: { outDir: out, emptyOutDir: false, lib },
  });
}

/** What stands beside the page, and then the list of all files. */
async function writeTheRest() {
  await writeDocuments(out, policy, alias);
  await writeServiceWorker();
}

const serveWhileWorking = (server) => serveDocuments(server, headersWith(whileWorking(policy)), `/@fs${font}`);

export default defineConfig({
  root: at('.'),
  base: './',
  publicDir: at('../target/public'),
  resolve: { alias },
  worker: { format: 'es' },
  // The server of the examples, which has another, may run at the same time.
  cacheDir: at('../target/vite/page'),
  // Found late, these would be bundled apart, each with a copy of three.js.
  optimizeDeps: { include: ['three', 'three/webgpu', 'three/tsl', 'three/addons/controls/OrbitControls.js'] },
  plugins: [
    { name: 'policy-while-working', apply: 'serve', transformIndexHtml: whileWorking },
    { name: 'font-while-working', apply: 'serve', transformIndexHtml: { order: 'pre', handler: withFont } },
    computed,
    { name: 'documents-while-working', apply: 'serve', configureServer: serveWhileWorking },
    { name: 'documents', apply: 'build', closeBundle: writeTheRest },
  ],
  server: { headers: headersWith(whileWorking(policy)), fs: { allow: [at('..')] } },
  preview: { headers: headersWith(policy) },
  build: {
    outDir: out,
    emptyOutDir: true,
    target: 'es2022',
    // The first browsers with `light-dark()`.
    cssTarget: ['chrome123', 'firefox120', 'safari17.5'],
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1500,
    // All browsers with `light-dark()` have it.
    modulePreload: { polyfill: false },
    // What stands beside the page takes longer than the page.
    rolldownOptions: { checks: { pluginTimings: false } },
  },
});
