// Makes a GLB file with everything that a triangle mesh may have: two primitives with a skin, morph targets and a
// texture. Also runs the validator of the Khronos Group on a file.

import validator from 'gltf-validator';

/** The messages of the validator. */
export async function faults(bytes, files = {}) {
  const externalResourceFunction = async (uri) => files[decodeURIComponent(uri)];
  const { issues } = await validator.validateBytes(bytes, { maxIssues: 20, externalResourceFunction });
  return issues.messages;
}

const FLOAT = 5126;
const VERTEX = 34962;
const INDEX = 34963;

/** A red pixel. */
const PNG = Buffer.from(
  'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC',
  'base64',
);

const TYPES = { 1: 'SCALAR', 2: 'VEC2', 3: 'VEC3', 4: 'VEC4', 16: 'MAT4' };
const COMPONENTS = new Map([
  [Float32Array, FLOAT],
  [Uint32Array, 5125],
  [Uint16Array, 5123],
  [Uint8Array, 5121],
]);

/** A growing buffer, and the buffer views and accessors that refer to it. */
export class Content {
  bytes = Buffer.alloc(0);
  bufferViews = [];
  accessors = [];

  view(data, more = {}) {
    const bytes = Buffer.from(data.buffer, data.byteOffset, data.byteLength);
    this.bufferViews.push({ buffer: 0, byteOffset: this.bytes.length, byteLength: bytes.length, ...more });
    this.bytes = Buffer.concat([this.bytes, bytes, Buffer.alloc(-bytes.length & 3)]);
    return this.bufferViews.length - 1;
  }

  accessor(array, width, target, hasBounds = false) {
    const columns = Array.from({ length: width }, (_, axis) => [...array].filter((_, i) => i % width === axis));
    const bounds = hasBounds
      ? { min: columns.map((c) => Math.min(...c)), max: columns.map((c) => Math.max(...c)) }
      : {};
    this.accessors.push({
      bufferView: this.view(array, target ? { target } : {}),
      componentType: COMPONENTS.get(array.constructor),
      count: array.length / width,
      type: TYPES[width],
      ...bounds,
    });
    return this.accessors.length - 1;
  }
}

/** The bytes of a GLB file with this JSON and this content, and where its buffer starts. */
export function glbOf(parts, { accessors, bufferViews, bytes: buffer }) {
  const json = { ...parts, accessors, bufferViews, buffers: [{ byteLength: buffer.length }] };
  const text = Buffer.from(JSON.stringify(json));
  const padded = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')]);
  const word = (number) => Buffer.from(Uint32Array.of(number).buffer);
  const start = 12 + 8 + padded.length + 8;
  const chunks = [word(padded.length), Buffer.from('JSON'), padded, word(buffer.length), Buffer.from('BIN\0'), buffer];
  const bytes = Buffer.concat([Buffer.from('glTF'), word(2), word(start + buffer.length), ...chunks]);
  return { bytes: new Uint8Array(bytes), start };
}

/** A strip of thin cells along the x axis, each split along its long diagonal and slightly bent out of the plane. */
function ribbon(cells, z) {
  const positions = new Float32Array(6 * (cells + 1));
  const indices = [];
  for (let i = 0; i <= cells; i++) {
    positions.set([i + 0.8 * (i % 2), 0, z, i, 0.4, z + 0.001 * (i % 3)], 6 * i);
    if (i < cells) {
      const [a, b, c, d] = [2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1];
      indices.push(...(i % 2 ? [a, b, c, a, c, d] : [a, b, d, b, c, d]));
    }
  }
  return { positions, indices };
}

/**
 * The file, and the ranges of bytes of its indices: pairs of start and end. Without indices, every triangle has its own
 * vertices, and the texture coordinates change in the middle of the second primitive.
 */
export function riggedGlb({ isIndexed = true } = {}) {
  const content = new Content();
  const primitives = [Uint16Array, Uint32Array].map((Indices, number) => {
    const { positions: shared, indices } = ribbon(24, number);
    const positions = isIndexed
      ? shared
      : Float32Array.from(indices.flatMap((i) => [...shared.slice(3 * i, 3 * i + 3)]));
    const count = positions.length / 3;
    const perVertex = (values) => Array.from({ length: count }, () => values).flat();
    const texture = perVertex([0.5, 0.25]);
    if (!isIndexed && number === 1) texture.fill(0.75, count);
    return {
      attributes: {
        POSITION: content.accessor(positions, 3, VERTEX, true),
        NORMAL: content.accessor(Float32Array.from(perVertex([0, 0, 1])), 3, VERTEX),
        TEXCOORD_0: content.accessor(Float32Array.from(texture), 2, VERTEX),
        JOINTS_0: content.accessor(Uint8Array.from(perVertex([0, 1, 0, 0])), 4, VERTEX),
        WEIGHTS_0: content.accessor(Float32Array.from(perVertex([0.5, 0.5, 0, 0])), 4, VERTEX),
      },
      targets: [{ POSITION: content.accessor(Float32Array.from(perVertex([0, 0.5, 0])), 3, VERTEX, true) }],
      ...(isIndexed ? { indices: content.accessor(Indices.from(indices), 1, INDEX) } : {}),
      material: 0,
      extras: { part: number },
    };
  });
  const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  const bind = content.accessor(Float32Array.from([...identity, ...identity]), 16);
  const times = content.accessor(Float32Array.of(0, 1), 1, undefined, true);
  const moves = content.accessor(Float32Array.of(0, 0, 0, 0, 1, 0), 3);
  const image = content.view(PNG);
  const json = {
    asset: { version: '2.0', extras: { 'made by': 'a test', numbers: [1, 2.5, -1e-7] } },
    scene: 0,
    scenes: [{ nodes: [0, 1] }],
    nodes: [{ mesh: 0, skin: 0, name: 'ribbons' }, { children: [2], name: 'root' }, { translation: [0, 0.1, 0] }],
    meshes: [{ primitives, weights: [0.25] }],
    skins: [{ joints: [1, 2], inverseBindMatrices: bind }],
    animations: [
      {
        channels: [{ sampler: 0, target: { node: 2, path: 'translation' } }],
        samplers: [{ input: times, output: moves }],
      },
    ],
    materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }],
    textures: [{ source: 0 }],
    images: [{ bufferView: image, mimeType: 'image/png' }],
  };
  const { bytes, start } = glbOf(json, content);
  const ranges = primitives
    .filter(() => isIndexed)
    .map(({ indices }) => {
      const { byteOffset, byteLength } = content.bufferViews[content.accessors[indices].bufferView];
      return [start + byteOffset, start + byteOffset + byteLength];
    });
  return { bytes, ranges };
}
