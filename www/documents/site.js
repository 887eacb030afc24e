// The pages of the site beside the page itself: README, CHANGELOG, docs/, all that they link to, and the examples. A file
// has the address that it has in the repository, with another ending, so that links between files stay as they are.

import { existsSync, readdirSync, readFileSync, statSync } from 'node:fs';
import { posix } from 'node:path';
import { fileURLToPath } from 'node:url';
import { codeBox, escapeHtml, render, targetsOf } from './markdown.js';

const root = fileURLToPath(new URL('../../', import.meta.url));
const text = (path) => readFileSync(root + path, 'utf8');
const namesIn = (folder) => readdirSync(root + folder).sort();

/** The page that lists the examples. */
export const EXAMPLES = 'examples/index.html';

/** The examples that are pages themselves; `examples.js` builds them. */
export const examplePages = () => namesIn('examples').filter((name) => name.endsWith('.html'));

const isPicture = (path) => /\.(png|svg)$/.test(path);
const isForeign = (target) => /^[a-z]+:/.test(target);

/** Where a target in a document is in the repository. Links name no file outside it. */
function pathOf(target, from) {
  const [name] = target.split('#');
  const path = name === '' ? from : posix.join(posix.dirname(from), name);
  if (path.startsWith('..') || !existsSync(root + path))
    throw new Error(`${from} links to ${target}, which is not there`);
  return path.replace(/\/$/, '');
}

/** The address of a file of the repository, from the root of the site. */
function addressOf(path) {
  if (path === 'examples') return EXAMPLES;
  if (path.endsWith('.md')) return path.replace(/md$/, 'html');
  const isItself = isPicture(path) || (path.startsWith('examples/') && path.endsWith('.html'));
  return isItself ? path : `${path}.html`;
}

const between = (from, to) => posix.relative(posix.dirname(from), to);

/** The origins that package.json names. A link to any other becomes plain text. */
export function namedOrigins() {
  return Object.values(addresses()).map((address) => new URL(address).origin);
}

/** The addresses of the repository and of the package, from the fields of package.json. */
export function addressesIn({ repository, homepage }) {
  const url = (repository?.url ?? repository)?.replace(/^git\+/, '').replace(/\.git$/, '');
  const named = {};
  if (url) named.repository = url.replace(/^(?:github:)?([\w-]+\/[\w.-]+)$/, 'https://github.com/$1');
  if (homepage) named.homepage = homepage;
  return named;
}

export const addresses = () => addressesIn(JSON.parse(text('package.json')));

/** What the site says until package.json names an address. */
export const notPublicIn = (named) =>
  Object.keys(named).length === 0
    ? 'The repository has no public address yet, and the package is in no registry.'
    : undefined;

/** README, then the documents in the order in which it names them, then the others. */
function documents() {
  const named = ['README.md', ...targetsOf(text('README.md')).map((target) => target.split('#')[0])];
  const all = [...named, ...namesIn('docs').map((name) => `docs/${name}`)];
  return [...new Set(all)].filter((path) => path.endsWith('.md'));
}

/** The sources of the examples. */
const sources = () =>
  namesIn('examples')
    .filter((name) => /\.(m?js|rs)$/.test(name))
    .map((name) => `examples/${name}`);

/** The files of the repository that are on the site, by their addresses. */
function filesOfSite() {
  const found = new Set([...documents(), ...sources()]);
  // What is added meanwhile is looked at too.
  for (const path of found) {
    if (!path.endsWith('.md')) continue;
    for (const target of targetsOf(text(path))) {
      if (isForeign(target)) continue;
      const other = pathOf(target, path);
      if (!statSync(root + other).isDirectory()) found.add(other);
    }
  }
  return new Map([...found].map((path) => [addressOf(path), path]));
}

/** The first sentence of a source's comment: what it is for. */
function purposeOf(path) {
  const [comment] = text(path).match(/^(\/\/!? ?.*\n)+/) ?? [''];
  return comment
    .replace(/^\/\/!? ?/gm, '')
    .replace(/\s+/g, ' ')
    .replace(/:? `.*/, '')
    .replace(/\.? *$/, '.');
}

const link = (from, to, words) => `<a href="${between(from, to)}">${escapeHtml(words)}</a>`;

/** The list of the examples. */
function examples() {
  const pages = examplePages().map((name) => {
    const [, title] = text(`examples/${name}`).match(/<title>(.*)<\/title>/);
    const script = `examples/${name.replace(/html$/, 'js')}`;
    return `<li>${link(EXAMPLES, `examples/${name}`, title)}<br>${escapeHtml(purposeOf(script))} ${link(EXAMPLES, `${script}.html`, 'Its source')}</li>`;
  });
  const programs = sources()
    .filter((path) => /\.(mjs|rs)$/.test(path))
    .map(
      (path) => `<li>${link(EXAMPLES, `${path}.html`, posix.basename(path))}<br>${escapeHtml(purposeOf(path))}</li>`,
    );
  return `<h1>Examples</h1>
<h2>Pages</h2>
<ul class="examples">${pages.join('\n')}</ul>
<h2>Programs</h2>
<ul class="examples">${programs.join('\n')}</ul>`;
}

/** The page around a document. `list` has the documents, with their titles. */
function frame(address, title, contents, policy, list) {
  const note = notPublicIn(addresses());
  const to = (place, words) =>
    `<a href="${between(address, place)}"${place === address ? ' aria-current="page"' : ''}>${escapeHtml(words)}</a>`;
  const items = list.map(([place, words]) => `<li>${to(place, words)}</li>`);
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<title>${escapeHtml(title)} – edgeflip</title>
<link rel="icon" href="${between(address, 'icon.svg')}" type="image/svg+xml">
<link rel="stylesheet" href="${between(address, 'documents.css')}">
</head>
<body>
<header>
<a class="mark" href="${between(address, 'index.html')}">edgeflip</a>
<nav aria-label="Site">${to('index.html#package', '← The page')} ${to('README.html', 'Documents')} ${to('api/index.html', 'API')} ${to(EXAMPLES, 'Examples')} ${to('CHANGELOG.html', 'Changes')}</nav>
</header>
<div class="columns">
<main>
${contents}
</main>
<nav class="list" aria-label="Documents"><ul>
${items.join('\n')}
</ul></nav>
</div>${note ? `\n<footer>${escapeHtml(note)}</footer>` : ''}
</body>
</html>
`;
}

/** What the site calls a document. */
export const titleOf = (path) => (path === 'README.md' ? 'Overview' : render(text(path), () => undefined).title);

/**
 * The pages of the site by their addresses: functions that make them. `policy` is the page's policy.
 *
 * @returns {Map<string, () => string | Buffer>}
 */
export function pagesOf(policy) {
  const named = namedOrigins();
  const list = documents().map((path) => [addressOf(path), titleOf(path)]);
  const page = (address, title, contents) => frame(address, title, contents, policy, list);
  const pages = new Map([[EXAMPLES, () => page(EXAMPLES, 'Examples', examples())]]);
  for (const [address, path] of filesOfSite()) {
    if (isPicture(path)) pages.set(address, () => readFileSync(root + path));
    else if (path.endsWith('.md')) {
      pages.set(address, () => {
        const { title, html } = render(text(path), (target) => {
          if (isForeign(target)) return named.includes(new URL(target).origin) ? target : undefined;
          const [, anchor] = target.split('#');
          const to = pathOf(target, path);
          return `${to === path ? '' : between(address, addressOf(to))}${anchor ? `#${anchor}` : ''}`;
        });
        const heading = title ? '' : `<h1>${path}</h1>\n`;
        return page(address, title || path, heading + html);
      });
    } else if (!path.endsWith('.html')) {
      pages.set(address, () => page(address, path, `<h1>${path}</h1>\n${codeBox(text(path))}`));
    }
  }
  return pages;
}

/** The style sheet of the documents. `font` is the address of the font. */
export function styleOf(font) {
  const tokens = text('www/tokens.css');
  return tokens + text('www/documents/documents.css').replace('../../target/fonts/inter.woff2', font);
}
