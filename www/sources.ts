/** Where meshes come from: samples, and files that were chosen. */

import { proxy } from 'comlink';
import { FORMATS, type FileMesh, type IndexedMesh } from 'edgeflip/files';
import type { Report } from './desk.ts';
import type { Office } from './engines.ts';

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
  /** The file that it was read from, and those beside it; none of a sample. */
  files: File[];
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
    return { name: spec, mesh, files: [] };
  };
  return { name: spec, read };
}

/** The first mesh among files, which may have its buffers in the others; `undefined` where there is no file. */
export function chosen(files: readonly File[]): Source | undefined {
  const file = files.find(({ name }) => EXTENSION.test(name)) ?? files[0];
  if (!file) return undefined;
  const { name } = file;
  const others = files.filter((other) => other !== file);
  const read = async (office: Office, report: Report) => {
    const mesh = await office.ask((desk) => desk.read(file, others, proxy(report)));
    return { name, mesh, files: [file, ...others] };
  };
  return { name, read };
}
