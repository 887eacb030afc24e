/** What a file seems to be by its first bytes, for the message about a file whose name says something else. */

import { EdgeflipError, FORMATS, POINT_FORMATS } from 'edgeflip/files';

/** So many bytes are looked at. */
const HEAD = 4096;

interface Kind {
  what: string;
  /** The extensions of a mesh. */
  extensions?: readonly string[];
  looksSo: (head: string, bytes: Uint8Array, extension: string) => boolean;
}

const begins = (pattern: RegExp) => (head: string) => pattern.test(head);
const startsWith = (mark: string) => (head: string) => head.startsWith(mark);

const KINDS: readonly Kind[] = [
  { what: 'a PLY file', extensions: ['.ply'], looksSo: begins(/^ply\s/) },
  { what: 'a glTF file', extensions: ['.glb', '.gltf'], looksSo: startsWith('glTF') },
  {
    what: 'a glTF file',
    extensions: ['.gltf', '.glb'],
    looksSo: begins(/^\s*\{[^]*"(?:asset|accessors|buffers|meshes)"/),
  },
  { what: 'an OFF file', extensions: ['.off'], looksSo: begins(/^(?:\s|#.*\n)*(?:ST)?C?N?4?n?OFF\b/) },
  { what: 'an STL file', extensions: ['.stl'], looksSo: begins(/^\s*solid\b[^]*\bfacet\b/) },
  { what: 'an STL file', extensions: ['.stl'], looksSo: (_, bytes) => isBinaryStl(bytes) },
  { what: 'a PNG image', looksSo: startsWith('\x89PNG') },
  { what: 'a JPEG image', looksSo: startsWith('\xff\xd8\xff') },
  { what: 'a PDF file', looksSo: startsWith('%PDF') },
  { what: 'an archive', looksSo: begins(/^(?:PK|Rar!|7z)/) },
  { what: 'an FBX file', looksSo: startsWith('Kaydara FBX') },
  { what: 'a Blender file', looksSo: startsWith('BLENDER') },
  { what: 'a web page', looksSo: begins(/^\s*<(?:!doctype html|html)/i) },
  { what: 'an XML file', looksSo: begins(/^\s*<\?xml/) },
  // STL files may have any bytes.
  { what: 'a binary file', looksSo: (head, _, extension) => extension !== '.stl' && isBinary(head) },
  { what: 'an OBJ file', extensions: ['.obj'], looksSo: begins(/^(?:v\s+[-+.\d]|f\s+-?\d)/m) },
];

const isBinary = (head: string) => [...head].some((character) => character < ' ' && !/\s/.test(character));

/** A header of 80 bytes, the number of triangles, and 50 bytes for each. */
function isBinaryStl(bytes: Uint8Array): boolean {
  if (bytes.length <= 84) return false;
  const count = new DataView(bytes.buffer, bytes.byteOffset).getUint32(80, true);
  return bytes.length === 84 + 50 * count;
}

/** The first bytes as text, unpacked if they are compressed: each byte is a character. */
async function headOf(bytes: Uint8Array<ArrayBuffer>): Promise<string> {
  if (bytes[0] !== 0x1f || bytes[1] !== 0x8b) return String.fromCharCode(...bytes.subarray(0, HEAD));
  const packed = new Blob([bytes.subarray(0, 16 * HEAD)]).stream();
  const reader = packed.pipeThrough(new DecompressionStream('gzip')).getReader();
  const { value } = await reader.read();
  reader.cancel().catch(() => {});
  return String.fromCharCode(...(value?.subarray(0, HEAD) ?? []));
}

/** The error of reading a file, with the name of the file. If it is of another kind than its name says, that is said. */
export async function errorOf(error: unknown, name: string, bytes: Uint8Array<ArrayBuffer>): Promise<unknown> {
  if (!(error instanceof EdgeflipError) || !/^(?:parse|unknown-format)$/.test(error.code)) return error;
  const head = await headOf(bytes).catch(() => '');
  const [, extension = ''] = /(\.[^.]*?)(?:\.gz)?$/i.exec(name.toLowerCase()) ?? [];
  const kind = KINDS.find(({ looksSo }) => looksSo(head, bytes, extension));
  if (!kind || kind.extensions?.includes(extension)) {
    return error.code === 'parse' ? new EdgeflipError('parse', `${name}: ${error.message}`) : error;
  }
  const { what, extensions } = kind;
  const better = extensions && name.replace(/(?:\.[^.]*)?(\.gz)?$/i, `${extensions[0]}$1`);
  const todo = better
    ? `Rename it to ${better}, and open it again.`
    : `Open a file that ends in ${[...FORMATS, ...POINT_FORMATS].join(', ')}.`;
  return new EdgeflipError('parse', `${name} seems to be ${what}${better ? '' : ', and no mesh'}. ${todo}`);
}
