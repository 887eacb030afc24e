// Brings what the page links to: the documents, the API reference and the examples. The build writes them beside the
// page; the server of `npm start` makes them when they are asked for.

import { mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'vite';
import { referenceOf } from './reference.js';
import { examplePages, pagesOf, styleOf } from './site.js';

const at = (path) => fileURLToPath(new URL(`../../${path}`, import.meta.url));

const TYPES = {
  '.html': 'text/html; charset=utf-8',
  '.css': 'text/css',
  '.js': 'text/javascript',
  '.svg': 'image/svg+xml',
  '.png': 'image/png',
};

/** The examples have an empty icon, which the page's policy forbids, and no link to the site. */
const onSite = (html) =>
  html
    .replace('href="data:,"', 'href="../icon.svg"')
    .replace('</head>', '  <link rel="stylesheet" href="./back.css">\n  </head>')
    .replace('</body>', '  <a id="back" href="./index.html">← Examples</a>\n  </body>');

/** Builds the pages in examples/, apart from the page, so that the page's scripts stay as they are. */
async function buildExamples(out, alias) {
  await build({
    configFile: false,
    root: at('examples'),
    base: './',
    publicDir: false,
    logLevel: 'warn',
    resolve: { alias },
    worker: { format: 'es' },
    plugins: [{ name: 'on-site', transformIndexHtml: { order: 'post', handler: onSite } }],
    build: {
      outDir: join(out, 'examples'),
      emptyOutDir: true,
      target: 'es2022',
      assetsInlineLimit: 0,
      chunkSizeWarningLimit: 1500,
      rolldownOptions: { input: examplePages().map((name) => at(`examples/${name}`)) },
    },
  });
}

function writeAll(out, files) {
  for (const [address, contents] of files) {
    const path = join(out, address);
    mkdirSync(dirname(path), { recursive: true });
    writeFileSync(path, contents());
  }
}

/** Writes everything into the folder of the built page. */
export async function writeDocuments(out, policy, alias) {
  await buildExamples(out, alias);
  const font = `assets/${readdirSync(join(out, 'assets')).find((name) => name.endsWith('.woff2'))}`;
  const pages = pagesOf(policy);
  pages.set('documents.css', () => styleOf(font));
  // The page's own icon has another name, which changes with its content.
  pages.set('icon.svg', () => readFileSync(at('www/icon.svg')));
  pages.set('examples/back.css', () => readFileSync(at('www/documents/back.css')));
  writeAll(out, pages);
  writeAll(out, await referenceOf(`../../${font}`));
}

/** Serves the same while the page is worked on. */
export function serveDocuments({ middlewares }, headers, font) {
  const policy = headers['Content-Security-Policy'];
  let reference;
  middlewares.use(async (request, response, next) => {
    const address = decodeURIComponent(request.url.replace(/[?#].*/, '')).slice(1);
    try {
      let contents = address === 'documents.css' ? () => styleOf(font) : undefined;
      if (address.startsWith('api/')) contents = (await (reference ??= referenceOf(font))).get(address);
      else if (/\.(html|png|svg)$/.test(address)) contents = pagesOf(policy).get(address);
      if (contents) {
        response.writeHead(200, { ...headers, 'Content-Type': TYPES[extname(address)] ?? 'application/octet-stream' });
        return response.end(contents());
      }
      if (address.startsWith('examples/')) request.url = `/@fs${at('')}${request.url.slice(1)}`;
      next();
    } catch (error) {
      next(error);
    }
  });
}
