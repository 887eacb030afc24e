/** The colours of the vertices of a PLY, OFF or OBJ file. */

import { readMesh } from 'edgeflip/files';
import { NUMBERS, packed, type FileColours, type Sizes } from './colour-format.ts';

const CHANNELS = ['red', 'green', 'blue'] as const;

/** The colours; `undefined` if not every vertex has one. */
export async function coloursOfVertices(
  name: string,
  bytes: Uint8Array<ArrayBuffer>,
  { vertices, dropped }: Sizes,
): Promise<FileColours | undefined> {
  // Without further content, there are no colours.
  if (dropped.length === 0) return undefined;
  const channels = /\.ply(\.gz)?$/i.test(name)
    ? await channelsOfPly(bytes)
    : /\.off(\.gz)?$/i.test(name)
      ? channelsOfOff(textOf(bytes))
      : /\.obj(\.gz)?$/i.test(name)
        ? channelsOfObj(textOf(bytes))
        : undefined;
  if (channels?.values.length !== 3 * vertices) return undefined;
  const { values, most } = channels;
  const numbers = new Float32Array(NUMBERS * vertices);
  for (let v = 0; v < vertices; v++) {
    const [red, green, blue] = [0, 1, 2].map((k) => values[3 * v + k]! / most);
    numbers[NUMBERS * v + 2] = packed(red!, green!, blue!);
  }
  return { vertices: numbers, layers: undefined };
}

/** Three channels for each vertex, and the number that is the full intensity. */
interface Channels {
  values: ArrayLike<number>;
  most: number;
}

/** In texts, integers up to 255, or numbers up to 1. */
function channelsOf(values: readonly number[]): Channels {
  return { values, most: values.some((x) => x > 1) ? 255 : 1 };
}

function textOf(bytes: Uint8Array): string {
  const [first, second] = bytes;
  const mark =
    first === 0xff && second === 0xfe ? 'utf-16le' : first === 0xfe && second === 0xff ? 'utf-16be' : 'utf-8';
  return new TextDecoder(mark).decode(bytes);
}

/** `readMesh` reads the colours, because the header calls them coordinates. */
async function channelsOfPly(bytes: Uint8Array<ArrayBuffer>): Promise<Channels | undefined> {
  const start = new TextDecoder('latin1').decode(bytes.subarray(0, 2 ** 16));
  const header = /^[^]*?end_header\r?\n/.exec(start)?.[0] ?? '';
  const vertex = /element\s+vertex\s[^]*?(?=element\s|end_header)/.exec(header)?.[0] ?? '';
  const named = (channel: string) => new RegExp(`property[ \\t]+(\\w+)[ \\t]+(?:diffuse_)?${channel}(?=\\s)`);
  const [type] = CHANNELS.map((channel) => named(channel).exec(vertex)?.[1]);
  if (!type || !CHANNELS.every((channel) => named(channel).test(vertex))) return undefined;
  let renamed = vertex.replace(/(property[ \t]+\w+[ \t]+)([xyz])(?=\s)/g, '$1place_$2');
  CHANNELS.forEach((channel, k) => (renamed = renamed.replace(named(channel), `property $1 ${'xyz'[k]}`)));
  // Without faces, none has to be cut into triangles. This element is skipped.
  const changed = header.replace(vertex, () => renamed).replace(/(element[ \t]+)(?=face[ \t])/, '$1former_');
  const head = Uint8Array.from(changed, (character) => character.charCodeAt(0));
  const whole = new Uint8Array(head.length + bytes.length - header.length);
  whole.set(head);
  whole.set(bytes.subarray(header.length), head.length);
  const { positions } = await readMesh(whole, 'colours.ply', { dimension: 3, coordinates: 32 });
  const most = /^u?(?:char|int8)$/.test(type) ? 255 : /^u?(?:short|int16)$/.test(type) ? 65535 : undefined;
  return { values: positions, most: most ?? (positions.some((x) => x > 1) ? 255 : 1) };
}

/** A line of a vertex has its position, then a normal, then a colour. */
function channelsOfOff(text: string): Channels | undefined {
  const lines = text.split('\n').map((line) => line.replace(/#.*/, '').trim());
  const rows = lines.filter((line) => line !== '');
  const [, letters = '', glued = ''] = /^(\w*?)OFF(.*)$/i.exec(rows.shift() ?? '') ?? [];
  if (/[n4]/.test(letters)) return undefined;
  const [count = 0] = (glued.trim() || (rows.shift() ?? '')).split(/\s+/).map(Number);
  const from = (letters.includes('2') ? 2 : 3) + (letters.includes('N') ? 3 : 0);
  const values: number[] = [];
  for (const row of rows.slice(0, count)) {
    const colour = row.split(/\s+/).slice(from).map(Number);
    if (!letters.includes('C') && (letters !== '' || colour.length > 4)) return undefined;
    if (colour.length < 3) return undefined;
    values.push(...colour.slice(0, 3));
  }
  return channelsOf(values);
}

/** A colour may follow the three coordinates of a vertex. */
function channelsOfObj(text: string): Channels | undefined {
  const values: number[] = [];
  // A backslash continues a line.
  const lines = text.replace(/\\\r?\n/g, ' ').matchAll(/^[ \t]*v[ \t]+([^#\r\n]*)/gm);
  for (const [, line = ''] of lines) {
    const numbers = line.trim().split(/\s+/).map(Number);
    if (numbers.length < 6) return undefined;
    values.push(...numbers.slice(3, 6));
  }
  return channelsOf(values);
}
