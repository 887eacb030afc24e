// Tests the section "Use it in your project": code in tabs, by keyboard too, sizes that are measured and those that a
// program really loads, and what it says as long as package.json names no address.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, rmSync, writeFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { measured } from '../../tools/sizes.mjs';
import { notPublicIn } from '../../www/documents/site.js';
import { sharedPage } from './page.mjs';

const text = (path) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');

async function openSection() {
  const edgeflip = await sharedPage();
  await edgeflip.page.evaluate(() => document.getElementById('package').scrollIntoView());
  await edgeflip.page.waitForSelector('#package h2');
  return edgeflip;
}

test('the code of each tab is the code that other tests run', async () => {
  const edgeflip = await openSection();
  const panels = await edgeflip.page.locator('.package-panel').evaluateAll((all) =>
    all.map((panel) => ({
      page: panel.querySelector('a').getAttribute('href'),
      title: panel.querySelector('a').textContent,
      blocks: [...panel.querySelectorAll('pre')].map(({ textContent }) => textContent),
    })),
  );
  assert.deepEqual(
    panels.map(({ page, title }) => [page, title]),
    [
      ['docs/peers.html', 'With three.js and glTF-Transform'],
      ['README.html', 'Overview'],
      ['examples/gltf.mjs.html', 'examples/gltf.mjs'],
      ['docs/points.html', 'Points'],
      ['README.html', 'Overview'],
      ['examples/one_call.rs.html', 'examples/one_call.rs'],
    ],
  );
  const readme = text('README.md');
  for (const { page, blocks } of panels) {
    const code = blocks.at(-1);
    const source = /\.(md|mjs|rs)$/.test(page.slice(0, -5)) ? page.slice(0, -5) : page.replace(/html$/, 'md');
    assert.ok(code.split('\n').length > 2, source);
    // A whole block of a document, or a whole file.
    const whole = source.endsWith('.md') ? text(source).includes(`\n${code}\n\`\`\``) : text(source) === `${code}\n`;
    assert.ok(whole, `${source}: ${code}`);
    for (const install of blocks.slice(0, -1)) assert.ok(readme.includes(`\n${install}\n\`\`\``), install);
    assert.ok(!/\[\.\.\./.test(code), 'no copy of the indices into an array of numbers');
  }
  await edgeflip.close();
});

test('the tabs work by keyboard, and the tool does not step meanwhile', async () => {
  const edgeflip = await openSection();
  const { page } = edgeflip;
  const tabs = page.getByRole('tab');
  const names = await tabs.allTextContents();
  assert.equal(names.length, 6);
  const now = () =>
    page.evaluate(() => ({
      focus: document.activeElement.textContent,
      chosen: [...document.querySelectorAll('[role=tab][aria-selected=true]')].map((tab) => tab.textContent),
      reachable: [...document.querySelectorAll('[role=tab]')].filter((tab) => tab.tabIndex === 0).length,
      panels: [...document.querySelectorAll('[role=tabpanel]:not([hidden])')].map(
        (panel) => document.getElementById(panel.getAttribute('aria-labelledby')).textContent,
      ),
    }));
  const { at } = await edgeflip.look();
  await tabs.first().focus();
  for (const [key, i] of [
    ['ArrowRight', 1],
    ['ArrowRight', 2],
    ['ArrowLeft', 1],
    ['End', 5],
    ['ArrowRight', 0],
    ['ArrowLeft', 5],
    ['Home', 0],
  ]) {
    await page.keyboard.press(key);
    const name = names[i];
    assert.deepEqual(await now(), { focus: name, chosen: [name], reachable: 1, panels: [name] }, key);
  }
  assert.equal((await edgeflip.look()).at, at);
  // From the tab, the next key leads to the code.
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.tagName), 'PRE');
  await edgeflip.close();
});

test('the sizes are measured, and the browsers are those of docs/package.md', async () => {
  const edgeflip = await openSection();
  const { page } = edgeflip;
  const bytes = await measured();
  const rows = await page
    .locator('.package-below tr')
    .evaluateAll((all) => all.map((row) => [...row.cells].map(({ textContent }) => textContent)));
  const sizeOf = (name) => Math.round(gzipSync(bytes.get(name)).length / 1024);
  const kilobytes = (...names) => names.reduce((sum, name) => sum + sizeOf(name), 0);
  const core = kilobytes('edgeflip', 'edgeflip_bg.wasm');
  const files = kilobytes('edgeflip/files', 'edgeflip_files_bg.wasm');
  const three = kilobytes('edgeflip/three, whole', 'edgeflip_files_bg.wasm');
  const gltf = kilobytes('edgeflip/gltf-transform, whole', 'edgeflip_files_bg.wasm');
  const points = kilobytes('edgeflip/points', 'edgeflip_points_bg.wasm');
  const untangle = kilobytes('edgeflip_untangle_bg.wasm');
  assert.deepEqual(
    rows.filter(([what]) => !/worker|CPU|WebGL2/.test(what)),
    [
      ['edgeflip', `${core} KB`],
      ['+ for three.js', `${three} KB`],
      ['+ for glTF-Transform', `${gltf} KB`],
      ['+ to untangle points that move', `${untangle} KB`],
      ['+ to read and write files', `${files} KB`],
      ['edgeflip/points, by itself', `${points} KB`],
    ],
  );
  const loads = await page.locator('.package-row').allTextContents();
  assert.deepEqual(
    loads.map((words) => Number(words.match(/loads (\d+) KB/)?.[1])),
    [core + three, core, core + gltf, points, Number.NaN, Number.NaN],
  );
  // The document has the same sizes.
  const table = text('docs/package.md').split('\n## Sizes\n')[1];
  for (const [entry, size] of [
    ['edgeflip', core],
    ['edgeflip/inline', sizeOf('edgeflip/inline')],
    ['edgeflip/worker', sizeOf('edgeflip/worker')],
    ['edgeflip/files', files],
    ['edgeflip/points', points],
    ['edgeflip/three', three],
    ['edgeflip/gltf-transform', gltf],
  ])
    assert.ok(table.includes(`\n| \`${entry}\` | ${size} KB`), `${entry}: ${size} KB`);
  assert.ok(table.includes(`loads ${untangle} KB more`), `the repair: ${untangle} KB`);
  const [threads, alone] = ['_threads', ''].map((end) => sizeOf(`edgeflip_points${end}_bg.wasm`));
  assert.ok(table.includes(`load ${threads} KB of WebAssembly instead of the ${alone} KB`), `points: ${threads} KB`);
  const [first] = await page.locator('.package-below li').allTextContents();
  const oldest = first.replace(/, or newer\.$/, '');
  assert.match(oldest, /^Chrome .*Safari/);
  assert.ok(text('docs/package.md').includes(oldest), oldest);
  await edgeflip.close();
});

/** Runs first in Node: prints the files of dist/ that are read. */
const SPY = `
import fs from 'node:fs';
import { syncBuiltinESMExports } from 'node:module';
const seen = new Set();
for (const [of, name] of [[fs, 'readFileSync'], [fs.promises, 'readFile']]) {
  const read = of[name];
  of[name] = function (path, ...more) {
    seen.add(String(path).split('/dist/')[1]);
    return read.call(this, path, ...more);
  };
}
syncBuiltinESMExports();
process.on('exit', () => console.log(JSON.stringify([...seen])));
`;

test('the code for three.js loads what the size for it counts', () => {
  const [, code] = text('docs/peers.md').match(/\n## three\.js\n[^]*?```js\n([^]*?)```/);
  const at = fileURLToPath(new URL('../../target/three-code.mjs', import.meta.url));
  writeFileSync(at, code);
  const spy = `data:text/javascript,${encodeURIComponent(SPY)}`;
  const read = JSON.parse(
    execFileSync(process.execPath, ['--import', spy, at], { encoding: 'utf8' }).split('\n').at(-2),
  );
  rmSync(at);
  assert.deepEqual(read.filter((path) => path?.endsWith('.wasm')).sort(), [
    'wasm/edgeflip_bg.wasm',
    'wasm/edgeflip_files_bg.wasm',
  ]);
  for (const name of ['three.js', 'shift.js', 'prepare.js', 'files.js']) assert.ok(read.includes(name), name);
});

test('the crate is added as Cargo.toml has it, and the page names what it takes', async () => {
  const edgeflip = await openSection();
  const panel = edgeflip.page.locator('.package-panel').last();
  const [install] = await panel.locator('pre').allTextContents();
  const note = await panel.locator('.package-note').textContent();
  await edgeflip.close();
  const cargo = text('Cargo.toml');
  const field = (name) => cargo.match(new RegExp(`^${name} = "(.*)"$`, 'm'))[1];
  assert.match(install, new RegExp(`^edgeflip = \\{ version = "${field('version')}", path = "`, 'm'));
  assert.ok(note.startsWith(`Rust ${field('rust-version')} or newer.`), note);
  for (const [, feature, crate] of note.matchAll(/“(\w+)” takes (?:the crate )?(\w+)/g)) {
    assert.match(cargo, new RegExp(`^${feature} = .*"dep:${crate}"`, 'm'));
    assert.match(install, new RegExp(`features = .*"${feature}"`));
  }
  assert.equal([...note.matchAll(/ takes /g)].length, 2);
});

test('as long as package.json names no address, the page says so, and the documents too', async () => {
  assert.equal(notPublicIn({ repository: 'https://example.org' }), undefined);
  const { repository, homepage } = JSON.parse(text('package.json'));
  const isPublic = repository !== undefined || homepage !== undefined;
  const says = notPublicIn({ ...(isPublic && { repository }) });
  const edgeflip = await openSection();
  const { page } = edgeflip;
  const [until, foot] = await Promise.all(
    ['.package-until', '#package .foot'].map((place) => page.locator(place).allTextContents()),
  );
  const document = await (await fetch(new URL('README.html', page.url()))).text();
  assert.equal(await page.getByText('Not released yet').isVisible(), !isPublic);
  await edgeflip.close();
  for (const words of [until.join(''), foot.join(''), document]) {
    if (isPublic) assert.ok(!words.includes('no public address'), words);
    else assert.ok(words.includes(says), words);
  }
  // These lines need a hand then.
  for (const path of ['README.md', 'SECURITY.md'])
    assert.equal(/not published yet|no public address/.test(text(path)), !isPublic, path);
});
