// Makes GLB files with textures and colours of vertices, for tests of the page, and finds the colours in its pictures.

import { crc32, deflateSync } from 'node:zlib';
import { Content, glbOf } from '../package/gltf.mjs';

export const [RED, GREEN] = [
  [255, 0, 0],
  [0, 255, 0],
];
export const NEAREST = { magFilter: 9728, minFilter: 9728, wrapS: 33071, wrapT: 33071 };

/** A PNG with these rows of pixels: red, green and blue, and perhaps their opacity. */
export function png(...rows) {
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]);
    const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
    length.writeUInt32BE(data.length);
    sum.writeUInt32BE(crc32(body));
    return Buffer.concat([length, body, sum]);
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(rows[0].length);
  head.writeUInt32BE(rows.length, 4);
  // 8 bits for each channel, and the type of colour.
  head.set([8, rows[0][0].length === 4 ? 6 : 2], 8);
  const pixels = deflateSync(Buffer.from(rows.flatMap((row) => [0, ...row.flat()])));
  const signature = Buffer.from('89504e470d0a1a0a', 'hex');
  return Buffer.concat([signature, chunk('IHDR', head), chunk('IDAT', pixels), chunk('IEND', Buffer.alloc(0))]);
}

/** A kite around x, as high as `height`, with its long diagonal as the edge; it flips to the short one. */
export const kite = (x, height = 0.8) => ({
  positions: [x - 1, 0, 0, x, -height, 0, x + 1, 0, 0, x, height, 0],
  indices: [0, 1, 2, 0, 2, 3],
});

/** The primitive of a mesh, with more attributes: the numbers of each with their width. */
export function primitiveOf(content, { positions, indices }, attributes, more = {}) {
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

export const perVertex = (values, count) => Array.from({ length: count }, () => values).flat();

/** A file of one mesh, and more. */
export function meshGlb(content, primitives, more = {}) {
  const json = { asset: { version: '2.0' }, nodes: [{ mesh: 0 }], scenes: [{ nodes: [0] }], meshes: [{ primitives }] };
  return glbOf({ ...json, ...more }, content).bytes;
}

/**
 * Two kites: the left one has a texture whose left half is red and whose right half is green, the right one has vertices
 * that are blue. `image` replaces the image, and `more` adds to the file.
 */
export function kitesGlb(image = png([RED, GREEN]), more = {}) {
  const content = new Content();
  const [left, right] = [kite(-1), kite(1)];
  const coordinates = [0, 0.5, 0.5, 0, 1, 0.5, 0.5, 1];
  const primitives = [
    primitiveOf(content, left, { TEXCOORD_0: [Float32Array.from(coordinates), 2] }, { material: 0 }),
    primitiveOf(content, right, { COLOR_0: [Float32Array.from(perVertex([0, 0, 1], 4)), 3] }),
  ];
  return meshGlb(content, primitives, {
    materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }],
    textures: [{ source: 0, sampler: 0 }],
    samplers: [NEAREST],
    images: [typeof image === 'string' ? { uri: image } : { bufferView: content.view(image), mimeType: 'image/png' }],
    ...more,
  });
}

/** For each of three colours, the share of the pixels that have it, and how far right they are in the mean, from 0 to 1. */
export function coloursIn({ pixels, width }) {
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
