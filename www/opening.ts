/** A mesh on its way to the page: read once, in workers of its own. Its run may have to be begun more than once. */

import type { FileMesh, IndexedMesh } from 'edgeflip/files';
import type { Quality } from './desk.ts';
import { Office } from './engines.ts';
import type { Kept } from './files.ts';
import { number } from './panel.ts';
import type { Read, Source } from './sources.ts';

/** Bins of the histogram of angles: 5° each. */
export const BINS = 36;

/** A mesh that a run can be begun with. */
export interface Opened {
  mesh: IndexedMesh;
  name: string;
  /** The worker that measures it. */
  office: Office;
  /** The files that it was read from. */
  kept: Kept | undefined;
  /** What reading the files did to it, and what it left. */
  remark: string;
  /** Its quality, measured when it is first asked for: a picture of it needs none. */
  before: () => Promise<Quality>;
}

/** Told what goes on, and how much of it is done, from 0 to 1, where that is known. */
export type Progress = (text: string, share?: number) => void;

export class Opening {
  /** Whether it is known what is in the files: from then on the settings of the page matter. */
  opened: Opened | undefined;
  readonly read: Promise<Opened>;
  #office = new Office();
  readonly #progress: Progress;
  #isClosed = false;

  constructor(source: Source, progress: Progress) {
    this.#progress = progress;
    this.read = this.#read(source);
    // It is the page's affair while it waits for the mesh.
    this.read.catch(() => {});
  }

  /** Gives it up, with the worker that is at it. */
  close(): void {
    this.#isClosed = true;
    this.#office.close();
  }

  async #read(source: Source): Promise<Opened> {
    const read = await source.read(this.#office, (path, share) => {
      if (!this.#isClosed) this.#progress(share < 1 ? `Reading ${path}…` : `Parsing ${path}…`, share);
    });
    const { mesh, name, kept } = read;
    if (mesh.indices.length === 0) throw new Error(`There are no triangles in ${name}.`);
    // The memory of a WebAssembly module never shrinks: what reading has taken goes with the worker.
    this.#office.close();
    const office = new Office();
    this.#office = office;
    let measured: Promise<Quality> | undefined;
    const before = () => (measured ??= office.ask((desk) => desk.measure(mesh, BINS)));
    return (this.opened = { mesh, name, office, kept, remark: remarkOn(read), before });
  }
}

function remarkOn({ mesh, others }: Read): string {
  const left =
    others > 0 ? `${number.format(others)} other mesh ${others === 1 ? 'file was' : 'files were'} not opened.` : '';
  return [left, 'polygons' in mesh ? remarkOnFile(mesh) : ''].filter(Boolean).join(' ');
}

function remarkOnFile(mesh: FileMesh): string {
  const cut = mesh.polygons > 0 ? `${number.format(mesh.polygons)} faces were cut into triangles.` : '';
  const dropped = mesh.dropped.length > 0 && !mesh.keeps ? `Not kept: ${mesh.dropped.join(', ')}.` : '';
  const isDivided = mesh.groups ?? mesh.lockedEdges ?? mesh.lockedTriangles;
  const locked = isDivided ? 'Edges between groups of faces or along seams stay.' : '';
  return [cut, dropped, locked, ...mesh.notes.map((note) => `${note}.`)].filter(Boolean).join(' ');
}
