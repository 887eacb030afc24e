/** A glTF file as the page draws it: its JSON, its accessors, and the vertices of the mesh that each primitive has. */

import { GLB_BUFFER, WebIO, type Accessor, type GLTF } from '@gltf-transform/core';
import type { Content } from './files.ts';

/** `glTF` and `BIN` at the start of a file and of a chunk, and the start of the JSON in a file. */
const [MAGIC, BINARY, JSON_AT] = [0x46546c67, 0x004e4942, 20];
/** The modes of triangles, strips and fans. */
const [TRIANGLES, FAN] = [4, 6];
const DRACO = 'KHR_draco_mesh_compression';
const PACKED = ['EXT_meshopt_compression', 'KHR_meshopt_compression'];

/** A primitive, and the vertices of the mesh that are its own. */
export interface Part {
  first: number;
  count: number;
  triangles: number;
  /** The elements of its accessors that the vertices are; `undefined` if these are all. */
  elements: Uint32Array | undefined;
  primitive: GLTF.IMeshPrimitive;
}

export class GltfFile {
  readonly json: GLTF.IGLTF;
  readonly #accessors: readonly Accessor[];
  readonly #images: readonly (Uint8Array | null)[];

  private constructor(json: GLTF.IGLTF, accessors: readonly Accessor[], images: readonly (Uint8Array | null)[]) {
    this.json = json;
    this.#accessors = accessors;
    this.#images = images;
  }

  /** @throws if the file is not valid, or a buffer is missing. */
  static async of({ bytes, beside }: Content): Promise<GltfFile> {
    const { json, binary } = chunksOf(bytes);
    const resources: Record<string, Uint8Array<ArrayBuffer>> = binary ? { [GLB_BUFFER]: binary } : {};
    const { asset, accessors, buffers, bufferViews, images } = json;
    for (const { uri } of [...(buffers ?? []), ...(images ?? [])]) {
      if (uri === undefined || isData(uri)) continue;
      // An image may be missing.
      resources[uri] = beside.get(nameOf(uri)) ?? new Uint8Array();
    }
    const parts = { accessors, buffers, bufferViews, images };
    const known = Object.fromEntries(Object.entries(parts).filter(([, value]) => value));
    const root = (await new WebIO().readJSON({ json: { asset, ...known }, resources })).getRoot();
    return new GltfFile(
      json,
      root.listAccessors(),
      root.listTextures().map((texture) => texture.getImage()),
    );
  }

  /** An attribute of a primitive, if it has one and each vertex has an element of it. */
  attribute({ attributes }: GLTF.IMeshPrimitive, name: string): Accessor | undefined {
    const [index, position] = [attributes[name], attributes['POSITION']];
    const accessor = index === undefined ? undefined : this.#accessors[index];
    const least = this.json.accessors?.[position ?? -1]?.count ?? Infinity;
    return accessor && accessor.getCount() >= least ? accessor : undefined;
  }

  /** The bytes of an image; `undefined` if they are in a file that was not opened. */
  image(index: number): Uint8Array<ArrayBuffer> | undefined {
    const bytes = this.#images[index];
    return bytes?.length ? (bytes as Uint8Array<ArrayBuffer>) : undefined;
  }

  /**
   * The parts of the mesh, which `readMesh` has read in this order. A primitive with the positions and the indices of an
   * earlier one is the same part, unless a node stretches its mesh. `undefined` if the file stretches some of these.
   */
  parts(vertices: number, triangles: number): Part[] | undefined {
    const sum = (parts: Part[], key: 'count' | 'triangles') => parts.reduce((total, part) => total + part[key], 0);
    return [false, true]
      .map((isApart) => this.#parts(isApart))
      .find((parts) => sum(parts, 'count') === vertices && sum(parts, 'triangles') === triangles);
  }

  /** `isApart`: whether equal primitives of two meshes are two parts. */
  #parts(isApart: boolean): Part[] {
    const { meshes = [], accessors = [] } = this.json;
    const all = meshes.flatMap(({ primitives }, mesh) => primitives.map((primitive) => ({ primitive, mesh })));
    const uses = new Map<number | undefined, number>();
    for (const { primitive } of all) {
      const position = primitive.attributes['POSITION'];
      uses.set(position, (uses.get(position) ?? 0) + 1);
    }
    const [parts, found] = [[] as Part[], new Set<string>()];
    let first = 0;
    for (const { primitive, mesh } of all) {
      const { indices, mode = TRIANGLES } = primitive;
      const position = primitive.attributes['POSITION'];
      const accessor = accessors[position ?? -1];
      if (position === undefined || !accessor || mode < TRIANGLES || mode > FAN) continue;
      if (primitive.extensions?.[DRACO] || this.#isPacked(position) || this.#isPacked(indices)) continue;
      const key = [position, indices, mode, isApart && mesh].join();
      if (found.has(key)) continue;
      found.add(key);
      const corners =
        indices === undefined ? accessor.count : (this.#accessors[indices]?.getArray() ?? new Uint32Array());
      const isShared = uses.get(position)! > 1 && !accessor.sparse;
      const elements = isShared && typeof corners !== 'number' ? ascending(corners) : undefined;
      const length = typeof corners === 'number' ? corners : corners.length;
      const count = elements?.length ?? accessor.count;
      const own = mode === TRIANGLES ? Math.floor(length / 3) : Math.max(0, length - 2);
      parts.push({ first, count, triangles: own, elements, primitive });
      first += count;
    }
    return parts;
  }

  #isPacked(accessor: number | undefined): boolean {
    const view = this.json.accessors?.[accessor ?? -1]?.bufferView;
    const extensions = this.json.bufferViews?.[view ?? -1]?.extensions ?? {};
    return PACKED.some((name) => name in extensions);
  }
}

/** The JSON of a file and its binary chunk. */
export function chunksOf(bytes: Uint8Array<ArrayBuffer>): {
  json: GLTF.IGLTF;
  binary: Uint8Array<ArrayBuffer> | undefined;
} {
  const words = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const parsed = (text: Uint8Array) => JSON.parse(new TextDecoder().decode(text)) as GLTF.IGLTF;
  if (words.getUint32(0, true) !== MAGIC) return { json: parsed(bytes), binary: undefined };
  const end = JSON_AT + words.getUint32(12, true);
  const json = parsed(bytes.subarray(JSON_AT, end));
  const isBinary = end + 8 <= bytes.length && words.getUint32(end + 4, true) === BINARY;
  const binary = isBinary ? bytes.subarray(end + 8, end + 8 + words.getUint32(end, true)) : undefined;
  return { json, binary };
}

export const isData = (uri: string) => /^data:/i.test(uri);

/** The name of a file that a glTF file names. */
export function nameOf(uri: string): string {
  try {
    return decodeURIComponent(uri);
  } catch {
    return uri;
  }
}

/** The different numbers, in ascending order. */
function ascending(numbers: ArrayLike<number>): Uint32Array {
  const sorted = Uint32Array.from(numbers).sort();
  return sorted.filter((x, i) => i === 0 || x !== sorted[i - 1]);
}
