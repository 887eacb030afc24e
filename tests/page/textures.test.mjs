// Tests in Chromium that the page draws the textures and the colours of the vertices of files, before and after edges
// flip, and that the inspector says what seams keep.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { startChromium } from '../browsers.mjs';
import { Content } from '../package/gltf.mjs';
import { file, keepDevices, loseDevice, openEdgeflip, pageForBeta, sharedPage } from './page.mjs';
import { coloursIn, GREEN, kite, kitesGlb, meshGlb, perVertex, png, primitiveOf, RED } from './textured.mjs';

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
    const page = await pageForBeta();
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

/** In each format, two kites, green and blue: the numbers of their vertices are followed by a colour. */
const COLOURED = {
  ply: (points, triangles) =>
    `ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n` +
    `property uchar green\nproperty uchar blue\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n` +
    `${points.map(([p, colour]) => [...p, ...colour].join(' ')).join('\n')}\n` +
    `${triangles.map((triangle) => `3 ${triangle.join(' ')}`).join('\n')}\n`,
  off: (points, triangles) =>
    `COFF\n8 4 0\n${points.map(([p, colour]) => [...p, ...colour, 255].join(' ')).join('\n')}\n` +
    `${triangles.map((triangle) => `3 ${triangle.join(' ')}`).join('\n')}\n`,
  obj: (points, triangles) =>
    // A backslash continues a line.
    `${points.map(([p, colour]) => `v ${p.join(' ')} \\\n ${colour.map((x) => x / 255).join(' ')}`).join('\n')}\n` +
    `${triangles.map((triangle) => `f ${triangle.map((v) => v + 1).join(' ')}`).join('\n')}\n`,
};

test('colours of vertices of PLY, OFF and OBJ files are drawn', async () => {
  const page = await sharedPage();
  await page.chooseEngine('cpu');
  const kites = [kite(-1), kite(1)].map(({ positions, indices }, k) => {
    const points = [0, 3, 6, 9].map((at) => [positions.slice(at, at + 3), k === 0 ? [0, 255, 0] : [0, 0, 255]]);
    return { points, triangles: [indices.slice(0, 3), indices.slice(3)].map((t) => t.map((v) => v + 4 * k)) };
  });
  const [points, triangles] = ['points', 'triangles'].map((part) => kites.flatMap((one) => one[part]));
  for (const [extension, textOf] of Object.entries(COLOURED)) {
    await openColoured(page, file(`from.ply.${extension}`, textOf(points, triangles)));
    const { red, green, blue } = coloursIn(await page.picture(1));
    const said = `${extension}: ${JSON.stringify({ red, green, blue })}`;
    assert.ok(red.share === 0 && green.share > 0.01 && blue.share > 0.01 && green.at < blue.at, said);
  }
  await page.close();
});

test('parts that share vertices have the colours of their own materials', async () => {
  const content = new Content();
  const [left, right] = [kite(-1), kite(1)];
  const whole = { positions: [...left.positions, ...right.positions] };
  // Both primitives use the same positions, each another half of them, and the last one is a copy of the first.
  const all = primitiveOf(content, whole, { COLOR_0: [Float32Array.from(perVertex([1, 1, 1], 8)), 3] });
  const part = (indices, material) => ({
    ...all,
    indices: content.accessor(Uint16Array.from(indices), 1, 34963),
    material,
  });
  const first = part(
    right.indices.map((v) => v + 4),
    0,
  );
  const primitives = [first, part(left.indices, 1), { ...first, material: 1 }];
  const materials = [
    [0, 0, 1, 1],
    [0, 1, 0, 1],
  ].map((baseColorFactor) => ({ pbrMetallicRoughness: { baseColorFactor } }));
  const page = await sharedPage();
  await page.chooseEngine('cpu');
  await openColoured(page, file('shared.glb', meshGlb(content, primitives, { materials })));
  const { red, green, blue } = coloursIn(await page.picture(1));
  const said = JSON.stringify({ red, green, blue });
  assert.ok(red.share === 0 && green.share > 0.01 && blue.share > 0.01 && green.at < blue.at, said);
  await page.close();
});

test('a mesh opens although its textures cannot be drawn, and the note names them', async () => {
  const page = await sharedPage();
  await page.chooseEngine('cpu');
  const images = (one) => ({ images: [{ name: 'wood', ...one }] });
  const data = (bytes) => `data:image/png;base64,${Buffer.from(bytes).toString('base64')}`;
  for (const [what, image, more, why] of [
    ['broken', data('no picture'), images({ uri: data('no picture') }), 'the browser cannot read it'],
    ['missing', 'far%20away.png', {}, 'its file was not opened together with the mesh'],
    [
      'basis',
      data('KTX 20'),
      {
        ...images({ uri: data('KTX 20'), mimeType: 'image/ktx2' }),
        textures: [{ extensions: { KHR_texture_basisu: { source: 0 } } }],
        extensionsUsed: ['KHR_texture_basisu'],
        extensionsRequired: ['KHR_texture_basisu'],
      },
      'the page does not read KTX2',
    ],
  ]) {
    await page.open(file(`${what}.glb`, kitesGlb(image, more)));
    const name = what === 'missing' ? 'far away.png' : 'wood';
    const { note, error } = await page.until('the note', (seen) => seen.note.includes(why));
    assert.ok(note.includes(`The texture “${name}” is not drawn: ${why}.`), note);
    assert.equal(error, '');
    // The blue vertices are drawn nevertheless.
    await surfaceIs(page, 'file');
    assert.equal(flipsOf(await page.playToEnd()), '2', what);
  }
  await page.close();
});

test('a texture in a file beside the mesh is drawn', async () => {
  const page = await sharedPage();
  await page.chooseEngine('cpu');
  const picture = file('red green.png', png([RED, GREEN]));
  await openColoured(page, [file('beside.glb', kitesGlb('red%20green.png')), picture]);
  await assertDrawn(page, 'beside');
  // The saved file names the same picture.
  const { bytes } = await page.download();
  assert.ok(Buffer.from(bytes).includes('red%20green.png'));
  await page.close();
});

test('the colours of a texture are drawn where it is transparent', async () => {
  const page = await sharedPage();
  await page.chooseEngine('cpu');
  await openColoured(
    page,
    file(
      'transparent.glb',
      kitesGlb(
        png([
          [...RED, 0],
          [...GREEN, 0],
        ]),
      ),
    ),
  );
  await assertDrawn(page, 'transparent');
  await page.close();
});

test('a file opens although the page cannot unpack it for its colours, and the note says so', async () => {
  const page = await sharedPage();
  await page.chooseEngine('cpu');
  // `readMesh` reads two packed pieces in a row, browsers do not.
  const bytes = kitesGlb('beside.png');
  const pieces = [bytes.subarray(0, 100), bytes.subarray(100)].map((piece) => gzipSync(piece));
  await page.open([file('pieces.glb.gz', Buffer.concat(pieces)), file('beside.png', png([RED, GREEN]))]);
  const { error } = await page.until('the note', ({ note }) =>
    /The colours of the file are not drawn \(.+\)\./.test(note),
  );
  assert.equal(error, '');
  assert.equal(flipsOf(await page.playToEnd()), '2');
  await page.close();
});

test('another mesh ends the search for colours', async () => {
  const page = await openEdgeflip(await startChromium(), () => {
    const { postMessage, terminate } = Worker.prototype;
    window.searching = new Set();
    Worker.prototype.postMessage = function (message, ...more) {
      // The worker gets no request, and so never answers.
      if (message.path?.at(-1) === 'colours') window.searching.add(this);
      else postMessage.call(this, message, ...more);
    };
    Worker.prototype.terminate = function () {
      window.searching.delete(this);
      terminate.call(this);
    };
  });
  await page.open(file('kites.glb', kitesGlb()));
  await page.page.waitForFunction(() => window.searching.size === 1);
  await page.choose('sample', 'random 24');
  await page.page.waitForFunction(() => window.searching.size === 0);
  await page.rest();
  await page.close();
});

test('nothing is said about the surface of a file without colours', async () => {
  const page = await sharedPage();
  await page.chooseEngine('cpu');
  const content = new Content();
  const normals = { NORMAL: [Float32Array.from(perVertex([0, 0, 1], 4)), 3] };
  const { note } = await page.open(file('bare.glb', meshGlb(content, [primitiveOf(content, kite(0), normals)])));
  assert.ok(!note.includes('drawn'), note);
  assert.equal(await page.page.isVisible('#surface-label'), false);
  await page.close();
});

const inspected = ({ page }) =>
  page.evaluate(() => {
    const box = document.getElementById('inspect');
    return box.hidden
      ? {}
      : { title: box.querySelector('header').textContent, says: box.querySelector('p').textContent };
  });

/** Waits until the inspector says something. */
async function untilSaid(page, pattern) {
  await page.page.waitForFunction(
    (source) => new RegExp(source).test(document.querySelector('#inspect:not([hidden]) p')?.textContent ?? ''),
    pattern.source,
  );
  return inspected(page);
}

test('the inspector names the seams of an OBJ file, and counts their edges', async () => {
  const page = await sharedPage();
  await page.chooseEngine('cpu');
  const vertices = [kite(-1), kite(1), kite(3)].flatMap(({ positions }) =>
    [0, 3, 6, 9].map((at) => `v ${positions.slice(at, at + 3).join(' ')}`),
  );
  const faces = [
    'f 1/1 2/1 3/1',
    'f 1/2 3/2 4/2',
    'usemtl a',
    'f 5 6 7',
    'usemtl b',
    'f 5 7 8',
    'f 9 10 11',
    'f 9 11 12',
  ];
  await page.open(file('seams.obj', [...vertices, 'vt 0 0', 'vt 1 1', ...faces].join('\n')));
  await page.page.evaluate(() => document.activeElement.blur());
  await page.page.keyboard.press('n');
  const seen = new Set();
  // Each edge is found twice, once in each of its triangles.
  for (let i = 0; i < 6; i++) {
    seen.add((await untilSaid(page, /it is locked\. It is|flips in the next/)).says);
    await page.page.keyboard.press('n');
  }
  const stays = 'Not Delaunay, but it stays: it is locked.';
  assert.deepEqual([...seen].sort(), [
    '205° is more than 180°, so this edge flips in the next iteration.',
    `${stays} It is a border of the attribute “usemtl” (materials): 1 edge stays to keep it.`,
    `${stays} It is a seam of the attribute “vt” (texture coordinates): 1 edge stays to keep it.`,
  ]);
  await page.close();
});

test('the inspector names the seams of a GLB file, where the two sides have vertices of their own', async () => {
  const page = await sharedPage();
  await page.chooseEngine('cpu');
  const content = new Content();
  // Two columns of five squares each, which meet in the middle.
  const [positions, indices, colours] = [[], [], []];
  for (const [side, colour] of [
    [-1, 0],
    [0, 1],
  ]) {
    const first = positions.length / 3;
    for (let y = 0; y <= 5; y++) {
      positions.push(side, y, 0, side + 1, y, 0);
      colours.push(...perVertex([colour, colour, 1], 2));
      if (y < 5) indices.push(...[0, 1, 3, 0, 3, 2].map((v) => first + 2 * y + v));
    }
  }
  const primitive = primitiveOf(content, { positions, indices }, { COLOR_0: [Float32Array.from(colours), 3] });
  await page.open(file('halves.glb', meshGlb(content, [primitive])));
  const { x, y, width, height } = await (await page.page.$('#view canvas')).boundingBox();
  let seen = {};
  // Across the middle of the mesh.
  for (let at = 0.33; at < 0.5 && !/COLOR/.test(seen.says); at += 0.004) {
    await page.page.mouse.move(x + at * width, y + height / 2);
    if (!(await inspected(page)).title) continue;
    seen = await untilSaid(page, /is not more than|is a seam|on the boundary/);
  }
  assert.match(seen.title, /^Seam/);
  assert.equal(
    seen.says,
    'This is a seam, not the end of the surface: each side has vertices of its own, so the edge stays. ' +
      'They differ in the attribute “COLOR_0” (colours): 5 edges stay to keep it.',
  );
  await page.page.mouse.move(x + 2, y + height / 2);
  await page.close();
});

test('the colours of a file are drawn again after the GPU was lost', async () => {
  const page = await openEdgeflip(await startChromium(), keepDevices);
  await page.chooseEngine('cpu');
  await openColoured(page, file('lost.glb', kitesGlb()));
  await loseDevice(page);
  await page.until('a message', ({ error, state }) => /GPU was lost/.test(error) && state !== 'busy');
  await page.rest();
  await surfaceIs(page, 'file');
  await assertDrawn(page, 'on the next GPU');
  await page.close();
});

test('the colours of a file are drawn with WebGL2', async () => {
  const page = await openEdgeflip(await startChromium(), () =>
    Object.defineProperty(navigator, 'gpu', { value: undefined }),
  );
  await page.chooseEngine('cpu');
  await openColoured(page, file('webgl.glb', kitesGlb()));
  await assertDrawn(page, 'the input');
  await page.playToEnd();
  await assertDrawn(page, 'the result');
  await page.close();
});
