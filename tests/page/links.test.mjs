// Tests the way out: every link of the built page leads to something that is there, and none to an origin that
// package.json does not name. What stands beside the page keeps its policy, and axe-core finds nothing there.

import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { parseHTML } from 'linkedom';
import { addressesIn } from '../../www/documents/site.js';
import site from '../../www/vite.config.js';
import { openPage, serve, startChromium } from '../browsers.mjs';
import { sharedPage } from './page.mjs';

const at = (path) => fileURLToPath(new URL(`../../${path}`, import.meta.url));
const namesIn = (folder, end) => readdirSync(at(folder)).filter((name) => name.endsWith(end));
const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const address = () => serve(at('target/www'), site.preview.headers);

/** The addresses that a page names. */
function namedIn(html, url) {
  const { document } = parseHTML(html);
  const attributes = { a: 'href', link: 'href', script: 'src', img: 'src' };
  const found = Object.entries(attributes).flatMap(([tag, attribute]) =>
    [...document.querySelectorAll(`${tag}[${attribute}]`)].map((element) => element.getAttribute(attribute)),
  );
  const ids = new Set([...document.querySelectorAll('[id]')].map(({ id }) => id));
  return { ids, links: found.map((link) => new URL(link, url).href) };
}

test('every link leads to a page that is there', async () => {
  const edgeflip = await sharedPage();
  for (const section of ['explain', 'engines', 'paper', 'package']) {
    await edgeflip.page.evaluate((id) => document.getElementById(id).scrollIntoView(), section);
    await edgeflip.page.waitForSelector(`#${section} h2`);
  }
  const links = await edgeflip.page.locator('a[href]').evaluateAll((all) => all.map(({ href }) => href));
  await edgeflip.close();
  const { origin } = new URL(await address());
  const named = Object.values(addressesIn(JSON.parse(readFileSync(at('package.json'), 'utf8'))));
  const origins = named.map((url) => new URL(url).origin);

  const pages = new Map();
  const wrong = [];
  const visit = async (link, from) => {
    const url = new URL(link);
    if (url.origin !== origin) {
      if (!origins.includes(url.origin)) wrong.push(`${from} leads to ${link}`);
      return;
    }
    if (pages.has(url.pathname)) return;
    pages.set(url.pathname, undefined);
    const response = await fetch(`${origin}${url.pathname}`);
    const isPage = response.headers.get('content-type')?.startsWith('text/html');
    if (response.status !== 200) wrong.push(`${from} leads to ${link}: ${response.status}`);
    const contents = await response.text();
    if (response.status === 200 && isPage) pages.set(url.pathname, namedIn(contents, url));
  };
  for (const link of links) await visit(link, 'the page');
  for (const [from, page] of pages) for (const link of page?.links ?? []) await visit(link, from);
  for (const [from, page] of pages) {
    for (const link of page?.links ?? []) {
      const { pathname, hash } = new URL(link);
      const anchor = decodeURIComponent(hash.slice(1));
      if (anchor && pages.get(pathname) && !pages.get(pathname).ids.has(anchor)) wrong.push(`${from}: no ${link}`);
    }
  }
  assert.deepEqual(wrong, []);
  const expected = [
    ...['api/index.html', 'README.html', 'CHANGELOG.html', 'LICENSE-MIT.html', 'examples/index.html'],
    ...namesIn('docs', '.md').map((name) => `docs/${name.replace('.md', '.html')}`),
    ...namesIn('examples', '.html').map((name) => `examples/${name}`),
  ];
  assert.deepEqual(
    expected.filter((path) => !pages.get(`/${path}`)),
    [],
  );
});

test('the addresses are those of package.json, and none if it has none', () => {
  assert.deepEqual(addressesIn({}), {});
  const url = 'https://example.org/someone/edgeflip';
  for (const repository of [url, { type: 'git', url: `git+${url}.git` }])
    assert.deepEqual(addressesIn({ repository, homepage: `${url}#readme` }), {
      repository: url,
      homepage: `${url}#readme`,
    });
  assert.deepEqual(addressesIn({ repository: 'github:someone/edgeflip' }), {
    repository: 'https://github.com/someone/edgeflip',
  });
});

test('the documents are readable everywhere, and lead back', async () => {
  const { page, problems } = await openPage(await startChromium(), 'about:blank');
  const found = {};
  for (const [colorScheme, width] of [
    ['light', 1440],
    ['dark', 390],
  ]) {
    await page.emulateMedia({ colorScheme });
    await page.setViewportSize({ width, height: 844 });
    for (const path of ['README.html', 'docs/benchmarks.html', 'examples/index.html', 'examples/one_call.rs.html']) {
      await page.goto(`${await address()}${path}`);
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width, path);
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
      if (violations.length > 0) found[`${path}, ${width}`] = violations.map(({ id, nodes }) => [id, nodes[0].target]);
    }
  }
  assert.deepEqual(found, {});
  await page.click('text=← The page');
  await page.waitForSelector('#package h2');
  assert.deepEqual(problems, []);
  await page.close();
});

test('the API reference and the examples keep the policy of the page', async () => {
  const { page, problems } = await openPage(await startChromium(), `${await address()}api/index.html`);
  await page.waitForSelector('.tsd-navigation a');
  // Each module says what it is for.
  const modules = await page.locator('dd.tsd-member-summary').allTextContents();
  assert.equal(modules.length, 7);
  for (const words of modules) assert.match(words.trim(), /^[A-Z].*\.$/s);
  await page.goto(`${await address()}api/functions/index.makeDelaunay.html`);
  await page.waitForSelector('h1');
  assert.equal(await page.getAttribute('#tsd-toolbar-links a', 'href'), '../../index.html#package');
  await page.setViewportSize({ width: 390, height: 844 });
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
  await page.goto(`${await address()}examples/worker.html?size=30`);
  await page.click('#run:enabled');
  await page.waitForFunction(() => document.querySelector('output').value.startsWith('done'));
  await page.goto(`${await address()}examples/three.html`);
  await page.waitForSelector('#flip:enabled');
  await page.click('#back');
  assert.equal(await page.textContent('h1'), 'Examples');
  assert.deepEqual(problems, []);
  await page.close();
});
