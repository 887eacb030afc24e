// Tests the section "Use it in your project": code in tabs, by keyboard too, and sizes that are measured.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { measured } from '../../tools/sizes.mjs';
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
      source: panel.querySelector('a').textContent,
      blocks: [...panel.querySelectorAll('pre')].map(({ textContent }) => textContent),
    })),
  );
  assert.deepEqual(
    panels.map(({ source }) => source),
    ['docs/peers.md', 'README.md', 'examples/gltf.mjs', 'README.md', 'examples/one_call.rs'],
  );
  const readme = text('README.md');
  for (const { source, blocks } of panels) {
    const code = blocks.at(-1);
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
  assert.equal(names.length, 5);
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
    ['End', 4],
    ['ArrowRight', 0],
    ['ArrowLeft', 4],
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
  const kilobytes = (...names) =>
    `${Math.round(names.reduce((sum, name) => sum + gzipSync(bytes.get(name)).length / 1024, 0))} KB`;
  assert.deepEqual(rows.slice(0, 2), [
    ['edgeflip', kilobytes('edgeflip', 'edgeflip_bg.wasm')],
    ['+ for three.js', kilobytes('edgeflip/three')],
  ]);
  const [first] = await page.locator('.package-below li').allTextContents();
  const oldest = first.replace(/, or newer\.$/, '');
  assert.match(oldest, /^Chrome .*Safari/);
  assert.ok(text('docs/package.md').includes(oldest), oldest);
  await edgeflip.close();
});
