/** The bytes of the files that a mesh is in: read once, kept in memory, there when the files have changed or gone. */

/** A file, and the path by which those beside it name it. */
export interface Located {
  path: string;
  file: File;
}

/** The files that a mesh was read from, as they were then. The browser holds their bytes, the page only handles. */
export interface Kept {
  name: string;
  bytes: Blob;
  /** Those that it names, such as the buffers of a glTF file, by these names. */
  beside: Map<string, Blob>;
}

/** What has been read of a file, and of those that it names. */
export interface Content {
  bytes: Uint8Array<ArrayBuffer>;
  beside: Map<string, Uint8Array<ArrayBuffer>>;
}

/** Told how much of a file has been read, from 0 to 1, while it is. */
export type Report = (path: string, share: number) => void;

/** What `readMesh` takes; what is larger is not read at all. */
const MOST_BYTES = 2 ** 30;

/** Files that may have their buffers in others. */
export const GLTF = /\.(gltf|glb)(\.gz)?$/i;

/** The folder of a path, with a slash at its end where it is not the top. */
export function folderOf(path: string): string {
  return path.slice(0, path.lastIndexOf('/') + 1);
}

/** The path without parts that say nothing, as in `/./a//b`. */
export function plain(path: string): string {
  return path
    .split('/')
    .filter((part) => part !== '' && part !== '.')
    .join('/');
}

/**
 * The bytes of a file, and of those files beside it that it names, by these names.
 *
 * @throws where a file cannot be read, or all are too large.
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

/** Leaves the bytes to the browser, which may put them on the disk. */
export function keep(name: string, { bytes, beside }: Content): Kept {
  return {
    name,
    bytes: new Blob([bytes]),
    beside: new Map(Array.from(beside, ([other, its]) => [other, new Blob([its])])),
  };
}

/** The bytes that were kept. */
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
    // Browsers say no more than `network error`.
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
 * The files that a glTF file has its buffers in, by their names relative to it. None where it cannot be read: what is
 * wrong with it is for the parser to say.
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

/** The name in a URI; none where it is no right one. */
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

/** The bytes, unpacked where they are gzip'd. */
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
