/** Where meshes come from: samples, and files that were chosen. */

import { proxy } from 'comlink';
import { FORMATS, type FileMesh, type IndexedMesh } from 'edgeflip/files';
import type { Office } from './engines.ts';
import { folderOf, GLTF, type Kept, type Located, type Report } from './files.ts';

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
    return { name: spec, mesh, kept: undefined };
  };
  return { name: spec, read };
}

/** The first mesh among files; `undefined` where there is no file. */
export function chosen(files: readonly File[]): Source | undefined {
  const [first] = files;
  const located = files.map((file) => ({ path: file.name, file }));
  return first && { name: first.name, read: (office, report) => readFirst(located, office, report) };
}

async function readFirst(files: readonly Located[], office: Office, report: Report): Promise<Read> {
  const main = files.find(isMesh) ?? files[0];
  if (!main) throw new Error('No file was given.');
  const folder = folderOf(main.path);
  const beside = GLTF.test(main.file.name) ? files.filter(({ path }) => path !== main.path && path.startsWith(folder)) : [];
  const { mesh, kept } = await office.ask((desk) => desk.read(main, beside, proxy(report)));
  return { name: main.file.name, mesh, kept };
}

function isMesh({ file: { name } }: Located): boolean {
  return EXTENSION.test(name);
}
