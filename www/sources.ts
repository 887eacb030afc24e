/** Where meshes come from: samples, files that were chosen, files and folders that were dropped. */

import { proxy } from 'comlink';
import { FORMATS, type FileMesh, type IndexedMesh } from 'edgeflip/files';
import { fromEvent } from 'file-selector';
import type { Office } from './engines.ts';
import { folderOf, GLTF, plain, type Kept, type Located, type Report } from './files.ts';

/** A mesh that can be read. */
export interface Source {
  /** What it is called before it is known which file it is in. */
  readonly name: string;
  read(office: Office, report: Report): Promise<Read>;
}

/** A mesh that was read. */
export interface Read {
  name: string;
  mesh: IndexedMesh | FileMesh;
  /** The files that it was read from; `undefined` for a sample. */
  kept: Kept | undefined;
  /** How many other meshes were in the files. */
  others: number;
}

/** The stem of a file's name, and what its format is known by. */
const EXTENSION = new RegExp(`^(.*)((?:${FORMATS.map((known) => `\\${known}`).join('|')})(?:\\.gz)?)$`, 'i');

/** The name without its extension, and the extension: that of OFF where a mesh is from no file. */
export function splitName(name: string): [stem: string, extension: string] {
  const [, stem = name, extension = '.off'] = EXTENSION.exec(name) ?? [];
  return [stem, extension];
}

export function sample(spec: string): Source {
  const read = async (office: Office) => {
    const mesh = await office.ask((desk) => desk.generate(spec));
    return { name: spec, mesh, kept: undefined, others: 0 };
  };
  return { name: spec, read };
}

/** The first mesh among files; `undefined` where there is no file. */
export function chosen(files: readonly File[]): Source | undefined {
  const [first] = files;
  const located = files.map((file) => ({ path: file.name, file }));
  return first && { name: first.name, read: (office, report) => readFirst(located, office, report) };
}

/**
 * The first mesh among what is dropped; `undefined` where that is no file. Of a folder it is the one that is nearest to
 * the top. To be called while the event is handled: later its files are out of reach.
 */
export function dropped(event: DragEvent): Source | undefined {
  const entries = Array.from(event.dataTransfer?.items ?? [], (item) => item.webkitGetAsEntry());
  const folders = entries.flatMap((entry) => (entry?.isDirectory ? [entry.name] : []));
  const name = folders[0] ?? event.dataTransfer?.files[0]?.name;
  if (name === undefined) return undefined;
  const gathering = gather(event, folders);
  // Whoever reads it is told.
  gathering.catch(() => {});
  const read = async (office: Office, report: Report) => {
    const files = await gathering;
    if (folders.length > 0 && !files.some(isMesh)) {
      const names = new Intl.ListFormat('en').format(folders);
      const are = folders.length === 1 ? 'is a folder' : 'are folders';
      throw new Error(`${names} ${are} without a mesh file. Files that can be opened end in ${FORMATS.join(', ')}.`);
    }
    return readFirst(files, office, report);
  };
  return { name, read };
}

/** What is dropped, and what lies in the folders. */
async function gather(event: DragEvent, folders: readonly string[]): Promise<Located[]> {
  const gathered = fromEvent(event).catch((error: unknown) => {
    const where = folders.length > 0 ? `all of ${new Intl.ListFormat('en').format(folders)}` : 'what was dropped';
    const why = error instanceof Error ? error.message : String(error);
    throw new Error(`The browser could not read ${where} (${why}). Drop only the files of the mesh.`);
  });
  const files = (await gathered).flatMap((file) => ('path' in file ? [{ path: plain(file.path), file }] : []));
  if (folders.length === 0) return files;
  // In the order of the disk, another mesh might be the first each time.
  const depth = ({ path }: Located) => path.split('/').length;
  const { compare } = new Intl.Collator('en', { numeric: true });
  return files.sort((a, b) => depth(a) - depth(b) || compare(a.path, b.path));
}

async function readFirst(files: readonly Located[], office: Office, report: Report): Promise<Read> {
  const meshes = files.filter(isMesh);
  const main = meshes[0] ?? files[0];
  if (!main) throw new Error('No file was given.');
  const folder = folderOf(main.path);
  const beside = GLTF.test(main.file.name)
    ? files.filter(({ path }) => path !== main.path && path.startsWith(folder))
    : [];
  const { mesh, kept } = await office.ask((desk) => desk.read(main, beside, proxy(report)));
  const used = new Set(Array.from(kept.beside.keys(), (name) => plain(folder + name)));
  const others = meshes.filter((file) => file !== main && !used.has(file.path)).length;
  return { name: main.file.name, mesh, kept, others };
}

/** Hidden files are none: macOS puts `._bunny.ply` beside `bunny.ply` on some disks. */
function isMesh({ file: { name } }: Located): boolean {
  return EXTENSION.test(name) && !name.startsWith('.');
}
