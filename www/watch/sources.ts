/** The sources of meshes: samples, chosen files, and dropped files and folders. */

import { proxy } from 'comlink';
import type { Plane } from 'edgeflip';
import { FORMATS, POINT_FORMATS, type FileMesh, type IndexedMesh } from 'edgeflip/files';
import { fromEvent } from 'file-selector';
import type { WorkerClient } from './worker-client.ts';
import type { Drop } from '../shell/early-drop.ts';
import { BROUGHT, sampleOf } from '../models/samples.js';
import { FileExtras } from './file-extras.ts';
import { hasPointsOnly, triangulated } from './file-points.ts';
import { folderOf, GLTF, plain, type Kept, type Located, type Report } from './files.ts';

/** The β of most meshes. */
const BETA = 10;

/** A mesh that can be read. */
export interface Source {
  /** The name to show while the mesh is read. */
  readonly name: string;
  /** The β that suits it. */
  readonly beta: number;
  /** What people call it, and what it is, for a sample. */
  readonly title?: string;
  readonly what?: string;
  /** The sample. */
  readonly spec?: string;
  /** The sample that it was before the page changed its triangles, and whether the page has scrambled them. */
  readonly origin?: string;
  readonly isScrambled?: boolean;
  /** The ends of the edges that the user has drawn. */
  readonly drawn?: readonly number[];
  read(client: WorkerClient, report: Report): Promise<Read>;
}

/** A mesh that was read. */
export interface Read {
  name: string;
  mesh: IndexedMesh | FileMesh;
  /** The files that it was read from; `undefined` for a sample. */
  kept: Kept | undefined;
  /** What the file has besides the mesh, if that is known from an earlier run. */
  extras?: FileExtras | undefined;
  /** The number of other mesh files. */
  others: number;
}

/** The extensions of files that can be opened. */
export const OPENED = [...FORMATS, ...POINT_FORMATS];

const named = (formats: readonly string[]) =>
  new RegExp(`^(.*)((?:${formats.map((known) => `\\${known}`).join('|')})(?:\\.gz)?)$`, 'i');
/** Splits a file's name into the stem and the extension of its format. */
const EXTENSION = named(OPENED);
const POINTS = named(POINT_FORMATS);

/** The name without its extension, and the extension that the mesh is saved with. */
export function splitName(name: string): [stem: string, extension: string] {
  const [, stem = name, extension = '.off'] = EXTENSION.exec(name) ?? [];
  return [stem, POINTS.test(name) ? '.off' : extension];
}

/** A mesh of the page: of a family, or a file that the page brings. */
export function sample(spec: string): Source {
  const { name: title, what, beta = BETA, plane } = sampleOf(spec);
  const generate = async (client: WorkerClient) => {
    const mesh = await client.call((worker) => worker.generate(spec));
    return { name: spec, mesh, kept: undefined, others: 0 };
  };
  const fetched = async (client: WorkerClient, report: Report) => {
    const name = spec.slice(BROUGHT.length);
    const answer = await fetch(new URL(spec, document.baseURI));
    if (!answer.ok)
      throw new Error(`${name} could not be loaded (${answer.status}). Check the connection, and try again.`);
    return readFirst([{ path: name, file: new File([await answer.blob()], name) }], client, report, plane);
  };
  return {
    name: spec,
    spec,
    title,
    ...(what ? { what } : {}),
    beta,
    read: spec.startsWith(BROUGHT) ? fetched : generate,
  };
}

/** The first mesh of the files; `undefined` if there are no files. */
export function chosen(files: readonly File[]): Source | undefined {
  const [first] = files;
  const located = files.map((file) => ({ path: file.name, file }));
  return first && { name: first.name, beta: BETA, read: (client, report) => readFirst(located, client, report) };
}

/**
 * The first mesh of the dropped files; `undefined` if no file was dropped. In a folder, the mesh nearest to the top
 * comes first. Call this in the handler of a `drop` event: the browser releases the files afterwards.
 */
export function dropped(event: Drop): Source | undefined {
  const entries = Array.from(event.dataTransfer?.items ?? [], (item) => item.webkitGetAsEntry());
  const folders = entries.flatMap((entry) => (entry?.isDirectory ? [entry.name] : []));
  const name = folders[0] ?? event.dataTransfer?.files[0]?.name;
  if (name === undefined) return undefined;
  const gathering = gather(event, folders);
  // `read` reports the error.
  gathering.catch(() => {});
  const read = async (client: WorkerClient, report: Report) => {
    const files = await gathering;
    if (folders.length > 0 && !files.some(isMesh)) {
      const names = new Intl.ListFormat('en').format(folders);
      const are = folders.length === 1 ? 'is a folder' : 'are folders';
      throw new Error(`${names} ${are} without a mesh file. Files that can be opened end in ${OPENED.join(', ')}.`);
    }
    return readFirst(files, client, report);
  };
  return { name, beta: BETA, read };
}

/** The dropped files, and the files in the dropped folders. */
async function gather(event: Drop, folders: readonly string[]): Promise<Located[]> {
  const gathered = fromEvent(event).catch((error: unknown) => {
    const where = folders.length > 0 ? `all of ${new Intl.ListFormat('en').format(folders)}` : 'the dropped files';
    const why = error instanceof Error ? error.message : String(error);
    throw new Error(`The browser could not read ${where} (${why}). Drop only the files of the mesh.`);
  });
  const files = (await gathered).flatMap((file) => ('path' in file ? [{ path: plain(file.path), file }] : []));
  if (folders.length === 0) return files;
  // Sorted, because the order in which the browser lists the files may vary.
  const depth = ({ path }: Located) => path.split('/').length;
  const { compare } = new Intl.Collator('en', { numeric: true });
  return files.sort((a, b) => depth(a) - depth(b) || compare(a.path, b.path));
}

/** `plane` is that of a terrain. */
async function readFirst(
  files: readonly Located[],
  client: WorkerClient,
  report: Report,
  plane?: Plane,
): Promise<Read> {
  const known = files.filter(isMesh);
  // In a folder with a mesh, a table may be anything.
  const triangles = known.filter(({ file: { name } }) => !POINTS.test(name));
  const meshes = triangles.length > 0 ? triangles : known;
  const main = meshes[0] ?? files[0];
  if (!main) throw new Error('No file was given.');
  const folder = folderOf(main.path);
  const beside = GLTF.test(main.file.name)
    ? files.filter(({ path }) => path !== main.path && path.startsWith(folder))
    : [];
  const { mesh, kept } = await client.call((worker) => worker.read(main, beside, plane, proxy(report)));
  const used = new Set(Array.from(kept.beside.keys(), (name) => plain(folder + name)));
  const others = meshes.filter((file) => file !== main && !used.has(file.path)).length;
  const { name } = main.file;
  if (!hasPointsOnly(mesh, name)) return { name, mesh, kept, others };
  // The file cannot be written again with triangles, but its colours can be drawn.
  const made = await triangulated(mesh, name);
  return { name, mesh: made, kept: undefined, extras: new FileExtras(made, kept), others };
}

/** Whether it is a file of a mesh or of points. Hidden files are not: on some disks, macOS stores `._bunny.ply` next to `bunny.ply`. */
function isMesh({ file: { name } }: Located): boolean {
  return EXTENSION.test(name) && !name.startsWith('.');
}
