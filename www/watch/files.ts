/** The bytes of a mesh's files. They are read once and kept, so that later changes of the files have no effect. */

/** A file, and its path relative to the chosen or dropped files. */
export interface Located {
  path: string;
  file: File;
}

/** The bytes that a mesh was read from. They are in Blobs, which the browser may store on disk. */
export interface Kept {
  name: string;
  bytes: Blob;
  /** The files that it names, such as the buffers of a glTF file, by these names. */
  beside: Map<string, Blob>;
}

/** The bytes of a file, and of the files that it names. */
export interface Content {
  bytes: Uint8Array<ArrayBuffer>;
  beside: Map<string, Uint8Array<ArrayBuffer>>;
}

/** Called while a file is read, with the share of its bytes that has been read, from 0 to 1. */
export type Report = (path: string, share: number) => void;

/** The limit of `readMesh`. Larger files are not read at all. */
const MOST_BYTES = 2 ** 30;

/** The names of files that may have their buffers in other files. */
export const GLTF = /\.(gltf|glb)(\.gz)?$/i;

/** The folder of a path, with a slash at its end; empty for a path without folders. */
export function folderOf(path: string): string {
  return path.slice(0, path.lastIndexOf('/') + 1);
}

/** The path without empty parts and parts that are `.`: `a/b` for `/./a//b`. */
export function plain(path: string): string {
  return path
    .split('/')
    .filter((part) => part !== '' && part !== '.')
    .join('/');
}

/**
 * Reads a file, and the files in `beside` that it names.
 *
 * @throws if a file cannot be read, or if the files together are too large.
 */
export async function contentOf(main: Located, beside: readonly Located[], report: Report): Promise<Content> {
  checkSize(`${main.path} has`, main.file.size);
  const bytes = await bytesOf(main, report);
  const folder = folderOf(main.path);
  const named = new Map<string, Located>();
  for (const name of beside.length > 0 ? await buffersOf(bytes) : []) {
    const found = beside.find(({ path }) => path === plain(folder + name));
    if (found) named.set(name, found);
  }
  const size = [main, ...named.values()].reduce((sum, { file }) => sum + file.size, 0);
  checkSize(`${main.path} and its buffers have`, size);
  const others: Content['beside'] = new Map();
  for (const [name, file] of named) others.set(name, await bytesOf(file, report));
  return { bytes, beside: others };
}

/** Stores the bytes in Blobs, which the browser may move to the disk. */
export function keep(name: string, { bytes, beside }: Content): Kept {
  return {
    name,
    bytes: new Blob([bytes]),
    beside: new Map(Array.from(beside, ([other, its]) => [other, new Blob([its])])),
  };
}

/** Reads the stored bytes. */
export async function contentOfKept({ name, bytes, beside }: Kept): Promise<Content> {
  const read = async (blob: Blob) => new Uint8Array(await blob.arrayBuffer());
  try {
    const others: Content['beside'] = new Map();
    for (const [other, blob] of beside) others.set(other, await read(blob));
    return { bytes: await read(bytes), beside: others };
  } catch {
    throw new Error(
      `The browser had no room to keep ${name}. Use the command line, or close other pages and open it again.`,
    );
  }
}

async function bytesOf({ path, file }: Located, report: Report): Promise<Uint8Array<ArrayBuffer>> {
  const bytes = new Uint8Array(file.size);
  let [at, told] = [0, 0];
  try {
    const reader = file.stream().getReader();
    for (;;) {
      const { done, value } = await reader.read();
      if (done) break;
      bytes.set(value, at);
      at += value.length;
      if (at - told > bytes.length / 100) report(path, (told = at) / bytes.length);
    }
    if (at < bytes.length) throw new Error('the file has become shorter');
  } catch {
    // The message of the browser is only `network error`.
    const why = 'it was moved, changed or removed after it was chosen, or you may not read it';
    throw new Error(`${path} could not be read: ${why}. Choose it again.`);
  }
  return bytes;
}

function checkSize(what: string, bytes: number): void {
  if (bytes <= MOST_BYTES) return;
  throw new Error(`${what} ${bytes} bytes, more than the ${MOST_BYTES} that a page can take; use the command line`);
}

/**
 * The names of the files that hold the buffers of a glTF file, relative to it. Empty if the glTF file is invalid; the
 * parser reports that later.
 */
async function buffersOf(bytes: Uint8Array<ArrayBuffer>): Promise<string[]> {
  try {
    const json: unknown = JSON.parse(new TextDecoder().decode(jsonOf(await unpacked(bytes))));
    const { buffers } = json as { buffers: { uri?: unknown }[] };
    const uris = buffers.flatMap(({ uri }) => (typeof uri === 'string' && !/^data:/i.test(uri) ? [uri] : []));
    return uris.flatMap(decoded);
  } catch {
    return [];
  }
}

/** The name in a URI; empty if the URI is malformed. */
function decoded(uri: string): string[] {
  try {
    return [decodeURIComponent(uri)];
  } catch {
    return [];
  }
}

/** The JSON of a glTF file: in a binary one it is the first chunk (glTF 2.0, section 4.4). */
function jsonOf(bytes: Uint8Array): Uint8Array {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const isBinary = view.getUint32(0, true) === 0x46546c67;
  return isBinary ? bytes.subarray(20, 20 + view.getUint32(12, true)) : bytes;
}

/** The bytes, unpacked if they are compressed with gzip. */
async function unpacked(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  if (bytes[0] !== 0x1f || bytes[1] !== 0x8b) return bytes;
  const parts: Uint8Array<ArrayBuffer>[] = [];
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip')).getReader();
  for (let size = 0; size <= MOST_BYTES; ) {
    const { done, value } = await reader.read();
    if (done) return new Uint8Array(await new Blob(parts).arrayBuffer());
    parts.push(value);
    size += value.length;
  }
  await reader.cancel();
  throw new Error('it is too large');
}
