/** The bytes of a mesh's files. They are read once and kept, so that later changes of the files have no effect. */

/** Of workers only, so the types of the page do not have it. */
declare const FileReaderSync: new () => { readAsArrayBuffer(file: Blob): ArrayBuffer };

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
 * Calls `read` with the bytes of a file, and with a function that reads a file in `beside` when `read` asks for it.
 *
 * @throws if a file cannot be read, or if the files together are too large.
 */
export async function readWith<T>(
  main: Located,
  beside: readonly Located[],
  report: Report,
  read: (bytes: Content['bytes'], files: (name: string) => Uint8Array | undefined) => Promise<T>,
): Promise<{ result: T; content: Content }> {
  checkSize(`${main.path} has`, main.file.size);
  const content: Content = { bytes: await bytesOf(main, report), beside: new Map() };
  report(main.path, 1);
  const folder = folderOf(main.path);
  let size = main.file.size;
  const result = await read(content.bytes, (name) => {
    const found = beside.find(({ path }) => path === plain(folder + name));
    if (!found || content.beside.has(name)) return content.beside.get(name);
    checkSize(`${main.path} and its buffers have`, (size += found.file.size));
    const bytes = bytesNow(found);
    content.beside.set(name, bytes);
    return bytes;
  });
  return { result, content };
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

/** The content, with the first file unpacked if it is compressed with gzip. */
export async function unpacked({ bytes, beside }: Content): Promise<Content> {
  if (bytes[0] !== 0x1f || bytes[1] !== 0x8b) return { bytes, beside };
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return { bytes: new Uint8Array(await new Response(stream).arrayBuffer()), beside };
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
    throw unreadable(path);
  }
  return bytes;
}

/** Reads a file while `readMesh` waits, which a worker may do. */
export function bytesNow({ path, file }: Located): Uint8Array<ArrayBuffer> {
  try {
    return new Uint8Array(new FileReaderSync().readAsArrayBuffer(file));
  } catch {
    throw unreadable(path);
  }
}

/** The message of the browser is only `network error`. */
function unreadable(path: string): Error {
  const why = 'it was moved, changed or removed after it was chosen, or you may not read it';
  return new Error(`${path} could not be read: ${why}. Choose it again.`);
}

function checkSize(what: string, bytes: number): void {
  if (bytes <= MOST_BYTES) return;
  throw new Error(`${what} ${bytes} bytes, more than the ${MOST_BYTES} that a page can take; use the command line`);
}
