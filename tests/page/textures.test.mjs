// Tests in Chromium that the page draws the textures and the colours of the vertices of files, before and after edges
// flip, and that the inspector says what seams keep.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { crc32, deflateSync } from 'node:zlib';
import { startChromium } from '../browsers.mjs';
import { Content, glbOf } from '../package/gltf.mjs';
import { file, keepDevices, loseDevice, openEdgeflip, sharedPage } from './page.mjs';

const [RED, GREEN, BLUE] = [
  [255, 0, 0],
  [0, 255, 0],
  [0, 0, 255],
];
const NEAREST = { magFilter: 9728, minFilter: 9728, wrapS: 33071, wrapT: 33071 };

/** A PNG with one row of pixels. */
function png(row) {
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]);
    const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
    length.writeUInt32BE(data.length);
    sum.writeUInt32BE(crc32(body));
    return Buffer.concat([length, body, sum]);
  };
  const head = Buffer.from([0, 0, 0, row.length, 0, 0, 0, 1, 8, 2, 0, 0, 0]);
  const pixels = deflateSync(Buffer.from([0, ...row.flat()]));
  const signature = Buffer.from('89504e470d0a1a0a', 'hex');
  return Buffer.concat([signature, chunk('IHDR', head), chunk('IDAT', pixels), chunk('IEND', Buffer.alloc(0))]);
}

/** A kite around x, as high as `height`, with its long diagonal as the edge; it flips to the short one. */
const kite = (x, height = 0.8) => ({
  positions: [x - 1, 0, 0, x, -height, 0, x + 1, 0, 0, x, height, 0],
  indices: [0, 1, 2, 0, 2, 3],
});

/** The primitive of a mesh, with more attributes: the numbers of each with their width. */
function primitiveOf(content, { positions, indices }, attributes, more = {}) {
  const others = Object.entries(attributes).map(([name, [numbers, width]]) => [
    name,
    content.accessor(numbers, width, 34962),
  ]);
  const place = content.accessor(Float32Array.from(positions), 3, 34962, true);
  return {
    attributes: { POSITION: place, ...Object.fromEntries(others) },
    ...(indices ? { indices: content.accessor(Uint16Array.from(indices), 1, 34963) } : {}),
    ...more,
  };
}

const perVertex = (values, count) => Array.from({ length: count }, () => values).flat();

/**
 * Two kites: the left one has a texture whose left half is red and whose right half is green, the right one has vertices
 * that are blue. `image` replaces the image, and `more` adds to the file.
 */
function kitesGlb(image = png([RED, GREEN]), more = {}) {
  const content = new Content();
  const [left, right] = [kite(-1), kite(1)];
  const coordinates = [0, 0.5, 0.5, 0, 1, 0.5, 0.5, 1];
  const primitives = [
    primitiveOf(content, left, { TEXCOORD_0: [Float32Array.from(coordinates), 2] }, { material: 0 }),
    primitiveOf(content, right, { COLOR_0: [Float32Array.from(perVertex([0, 0, 1], 4)), 3] }),
  ];
  const json = {
    asset: { version: '2.0' },
    nodes: [{ mesh: 0 }],
    scenes: [{ nodes: [0] }],
    meshes: [{ primitives }],
    materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }],
    textures: [{ source: 0, sampler: 0 }],
    samplers: [NEAREST],
    images: [typeof image === 'string' ? { uri: image } : { bufferView: content.view(image), mimeType: 'image/png' }],
    ...more,
  };
  return glbOf(json, content).bytes;
}

/** For each of three colours, the share of the pixels that have it, and how far right they are in the mean, from 0 to 1. */
function coloursIn({ pixels, width }) {
  return Object.fromEntries(
    ['red', 'green', 'blue'].map((name, channel) => {
      const found = [];
      pixels.forEach((pixel, i) => {
        const parts = [pixel >> 16, (pixel >> 8) & 255, pixel & 255];
        const [own] = parts.splice(channel, 1);
        if (own > 60 && own > 3 * Math.max(...parts)) found.push((i % width) / width);
      });
      return [name, { share: found.length / pixels.length, at: found.reduce((sum, x) => sum + x, 0) / found.length }];
    }),
  );
}

/** Waits until the surface is as in the file, or plain. */
const surfaceIs = ({ page }, look) => page.waitForFunction((is) => document.body.dataset.surface === is, look);

/** Hides all edges. */
async function hideEdges({ page }) {
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('e');
  await page.keyboard.press('e');
}

/** Opens a file, and waits until its colours are drawn. */
async function openColoured(page, path) {
  await page.open(path);
  await surfaceIs(page, 'file');
  await hideEdges(page);
}

/** Asserts that red, green and blue follow each other from left to right. */
async function assertDrawn(page, what) {
  const picture = await page.stillPicture(1);
  const { red, green, blue } = coloursIn(picture);
  const said = `${what}: ${JSON.stringify({ red, green, blue })}`;
  for (const { share } of [red, green, blue]) assert.ok(share > 0.005, said);
  assert.ok(red.at < green.at && green.at < blue.at, said);
  assert.ok(Math.abs(red.share - green.share) < 0.2 * red.share, said);
  return picture;
}

const flipsOf = ({ facts }) => facts.Flips;

for (const engine of ['cpu', 'webgpu']) {
  test(`textures and colours of vertices are drawn before and after flips on ${engine}`, async () => {
    const page = await sharedPage();
    await page.chooseEngine(engine);
    await openColoured(page, file('kites.glb', kitesGlb()));
    const before = await assertDrawn(page, 'the input');
    assert.equal(flipsOf(await page.playToEnd()), '2');
    const after = await assertDrawn(page, 'the result');
    assert.ok(after.differsFrom(before) < 0.01, 'the colours stay at their places');
    await page.page.selectOption('#surface', 'plain');
    const plain = await page.stillPicture(1);
    assert.deepEqual(
      Object.values(coloursIn(plain)).map(({ share }) => share),
      [0, 0, 0],
    );
    await page.page.evaluate(() => document.activeElement.blur());
    await page.page.keyboard.press('v');
    assert.equal(await page.page.inputValue('#surface'), 'file');
    await assertDrawn(page, 'again');
    await page.page.keyboard.press('c');
    await page.page.waitForSelector('#halves:not([hidden])');
    await assertDrawn(page, 'before and now');
    await page.page.keyboard.press('c');
    // Another limit begins another run.
    await page.setBeta('20');
    await page.rest();
    await surfaceIs(page, 'file');
    await assertDrawn(page, 'another run');
    await page.choose('sample', 'random 24');
    await page.rest();
    assert.equal(await page.page.isVisible('#surface-label'), false);
    await page.close();
  });
}
