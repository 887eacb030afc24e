// The API reference of the site, by TypeDoc. rustdoc's is not there: it would need Rust and the compilation of the crate,
// and the page's build needs neither. `npm run docs` writes both.

import { spawn } from 'node:child_process';
import { existsSync, readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { typedocTo } from '../../tools/typedoc.mjs';
import { hashOf } from './hash.js';
import { namedOrigins } from './site.js';

const at = (path) => fileURLToPath(new URL(`../../${path}`, import.meta.url));
const [folder, mark] = [at('target/api'), at('target/api.stamp')];
const STYLE = 'www/documents/reference.css';

const filesIn = (path) => readdirSync(path, { recursive: true }).map((name) => name.replaceAll('\\', '/'));

/** Runs TypeDoc, unless what it reads is unchanged. It takes seconds. */
async function write() {
  const sources = filesIn(at('src/js')).filter((name) => name.endsWith('.ts'));
  const read = [...sources.map((name) => `src/js/${name}`), 'tools/typedoc.mjs', 'package-lock.json'];
  const stamp = hashOf(...read.sort().map(at));
  if (existsSync(mark) && readFileSync(mark, 'utf8') === stamp) return;
  const args = typedocTo(folder, '--customCss', STYLE, '--hideGenerator', '--logLevel', 'Warn');
  const typedoc = spawn(process.execPath, args, { cwd: at(''), stdio: 'inherit' });
  const status = await new Promise((resolve) => typedoc.once('close', resolve));
  if (status !== 0) throw new Error('TypeDoc failed: see above');
  writeFileSync(mark, stamp);
}

/** TypeDoc's script in its pages. The page's policy forbids scripts that are not files. */
const INLINE = /<script>([^<]+)<\/script>/;
const THEME = 'assets/theme.js';

/** TypeDoc's script writes rules into an element, which the policy forbids; it allows sheets made by a script. */
const ELEMENT = 'document.head.appendChild(document.createElement("style"))';
const SHEET = `(() => {
  const sheet = new CSSStyleSheet();
  document.adoptedStyleSheets.push(sheet);
  let rules = '';
  return { dataset: {}, get innerHTML() { return rules; }, set innerHTML(text) { sheet.replaceSync((rules = text)); } };
})()`;

const LINKS = [
  ['index.html#package', '← The page'],
  ['README.html', 'Documents'],
  ['examples/index.html', 'Examples'],
];

/** A page of TypeDoc as it is on the site. */
function adapted(html, named) {
  const [, base] = html.match(/data-base="([^"]*)"/);
  const links = LINKS.map(([to, words]) => `<a href="${base}../${to}">${words}</a>`);
  return html
    .replace('</head>', `<link rel="icon" href="${base}../icon.svg" type="image/svg+xml"/></head>`)
    .replace(INLINE, `<script src="${base}${THEME}"></script>`)
    .replace('<div id="tsd-toolbar-links"></div>', `<div id="tsd-toolbar-links">${links.join('')}</div>`)
    .replace(/<a href="(https?:[^"]*)"[^>]*>(.*?)<\/a>/g, (link, to, words) =>
      named.includes(new URL(to).origin) ? link : words,
    );
}

/**
 * The files of the reference by their addresses: functions that read them. `font` is the address of the font, from the
 * root of the site.
 *
 * @returns {Promise<Map<string, () => string | Buffer>>}
 */
export async function referenceOf(font) {
  await write();
  const named = namedOrigins();
  const files = new Map();
  for (const name of filesIn(folder)) {
    const path = join(folder, name);
    if (statSync(path).isDirectory()) continue;
    files.set(`api/${name}`, () => {
      const isPage = name.endsWith('.html');
      return isPage ? adapted(readFileSync(path, 'utf8'), named) : readFileSync(path);
    });
  }
  const [, theme] = readFileSync(join(folder, 'index.html'), 'utf8').match(INLINE);
  files.set(`api/${THEME}`, () => theme);
  const script = readFileSync(join(folder, 'assets/main.js'), 'utf8');
  if (!script.includes(ELEMENT)) throw new Error('TypeDoc’s script has changed: does it keep the policy of the page?');
  files.set('api/assets/main.js', () => script.replace(ELEMENT, SHEET));
  const style = () => readFileSync(at('www/tokens.css'), 'utf8') + readFileSync(at(STYLE), 'utf8');
  files.set('api/assets/custom.css', () => style().replace('../../target/fonts/inter.woff2', font));
  return files;
}
