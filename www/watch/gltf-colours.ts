/** The colours of a glTF file: the textures and colours of its materials, and the colours of its vertices. */

import type { Accessor, GLTF } from '@gltf-transform/core';
import { BITS, NUMBERS, packed, REPEAT, SHARP, WRAPS, type FoundColours, type Sizes } from './colour-format.ts';
import { nameOf, isData, type GltfFile, type Part } from './gltf-file.ts';
import { layersOf, type Image } from './layers.ts';

/** Textures in these formats are drawn if the browser reads them. */
const FORMATS = ['EXT_texture_webp', 'EXT_texture_avif'];
const [BASIS, TRANSFORM] = ['KHR_texture_basisu', 'KHR_texture_transform'];
const NEAREST = 9728;
/** What happens beyond the border, by the number in the file. */
const WRAP = new Map<number | undefined, number>([
  [33071, REPEAT.clamp],
  [33648, REPEAT.mirror],
]);

interface Transform {
  offset?: [number, number];
  scale?: [number, number];
  rotation?: number;
  texCoord?: number;
}

/** What a part of the mesh has: a factor of its colour, colours of its vertices, and a texture. */
interface Look {
  part: Part;
  factor: readonly number[];
  colours: Accessor | undefined;
  coordinates: Accessor | undefined;
  transform: Transform;
  image: Image | undefined;
  /** Those of its texture besides the layer. */
  bits: number;
}

export async function gltfColours(file: GltfFile, { vertices, triangles }: Sizes): Promise<FoundColours> {
  const parts = file.parts(vertices, triangles);
  if (!parts) {
    const why = 'it stretches some meshes that share vertices, and others not';
    return { colours: undefined, notes: [`The colours of the file are not drawn: ${why}.`] };
  }
  const images = new Map<string, Image>();
  const looks = parts.map((part) => lookOf(file, part, images));
  const { layers, places, notes } = await layersOf([...images.values()]);
  const isColoured = looks.some(({ colours, image }) => colours || (image && places.has(image)));
  const isVaried = looks.some(({ factor }) => factor.some((x, i) => x !== looks[0]?.factor[i]));
  if (!isColoured && !isVaried) return { colours: undefined, notes };
  const numbers = new Float32Array(NUMBERS * vertices);
  for (const look of looks) write(numbers, look, look.image ? (places.get(look.image) ?? 0) : 0);
  return { colours: { vertices: numbers, layers }, notes };
}

function lookOf(file: GltfFile, part: Part, images: Map<string, Image>): Look {
  const { materials = [], textures = [], samplers = [] } = file.json;
  const { baseColorFactor, baseColorTexture } = materials[part.primitive.material ?? -1]?.pbrMetallicRoughness ?? {};
  const factor = (baseColorFactor ?? [1, 1, 1]).slice(0, 3);
  const colours = file.attribute(part.primitive, 'COLOR_0');
  const transform = (baseColorTexture?.extensions?.[TRANSFORM] ?? {}) as Transform;
  const texture = textures[baseColorTexture?.index ?? -1];
  const set = transform.texCoord ?? baseColorTexture?.texCoord ?? 0;
  const coordinates = texture && file.attribute(part.primitive, `TEXCOORD_${set}`);
  const sampler = samplers[texture?.sampler ?? -1];
  const isSharp = sampler?.magFilter === NEAREST;
  const wraps = (WRAP.get(sampler?.wrapS) ?? 0) | ((WRAP.get(sampler?.wrapT) ?? 0) << BITS);
  const image = coordinates && imageOf(file, texture, isSharp, images);
  return { part, factor, colours, coordinates, transform, image, bits: (wraps << WRAPS) | (Number(isSharp) << SHARP) };
}

/** The image of a texture, the same for all textures that have it. */
function imageOf(
  file: GltfFile,
  { source, extensions = {} }: GLTF.ITexture,
  isSharp: boolean,
  images: Map<string, Image>,
): Image | undefined {
  const sourceOf = (name: string) => (extensions[name] as { source?: number } | undefined)?.source;
  const basis = sourceOf(BASIS);
  const index = FORMATS.map(sourceOf).find((found) => found !== undefined) ?? source ?? basis;
  if (index === undefined) return undefined;
  const key = `${index} ${isSharp}`;
  const known = images.get(key);
  if (known) return known;
  const { name, uri, mimeType = '' } = file.json.images?.[index] ?? {};
  const title = name ?? (uri && !isData(uri) ? nameOf(uri) : `${index}`);
  const image = { name: title, type: mimeType, isBasis: index === basis, isSharp, bytes: file.image(index) };
  images.set(key, image);
  return image;
}

/** Writes the numbers of the vertices of a part; `layer` counts from 1, and 0 is none. */
function write(numbers: Float32Array, look: Look, layer: number): void {
  const { part, factor, colours, coordinates, transform, bits } = look;
  const { offset = [0, 0], scale = [1, 1], rotation = 0 } = transform;
  const [sin, cos] = [Math.sin(rotation), Math.cos(rotation)];
  const [point, colour]: number[][] = [[], []];
  for (let i = 0; i < part.count; i++) {
    const element = part.elements ? part.elements[i]! : i;
    const at = NUMBERS * (part.first + i);
    if (layer > 0 && coordinates) {
      coordinates.getElement(element, point!);
      const [u, v] = [scale[0] * point![0]!, scale[1] * point![1]!];
      numbers[at] = offset[0] + cos * u + sin * v;
      numbers[at + 1] = offset[1] - sin * u + cos * v;
    }
    colours?.getElement(element, colour!);
    const [red, green, blue] = factor.map((x, k) => encoded(x * (colours ? colour![k]! : 1)));
    numbers[at + 2] = packed(red!, green!, blue!);
    numbers[at + 3] = layer > 0 ? layer | bits : 0;
  }
}

/** A linear intensity in sRGB (IEC 61966-2-1). */
const encoded = (x: number) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
