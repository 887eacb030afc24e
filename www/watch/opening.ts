/** Opens a mesh: reads it once, in a worker. The page may start its run several times. */

import type { FileMesh, IndexedMesh } from 'edgeflip/files';
import type { Quality } from './mesh-worker.ts';
import { takeReader } from './ahead.ts';
import { attributeOf } from './attributes.ts';
import { FileExtras } from './file-extras.ts';
import { Cancelled, WorkerClient } from './worker-client.ts';
import type { Kept } from './files.ts';
import { planOf } from './plan.ts';
import { counted, number, staying } from '../shell/numbers.ts';
import type { Read, Source } from './sources.ts';

/** Bins of the histogram of angles: 5° each. */
export const BINS = 36;

/** A mesh for a run. */
export interface Opened {
  mesh: IndexedMesh;
  /** The mesh as the flips see it: a terrain without its heights. */
  plan: IndexedMesh;
  name: string;
  /** Its name for people, and what it is, if it is a sample. */
  title: string;
  what: string | undefined;
  /** The sample that it is, as it was given. */
  spec: string | undefined;
  /** The sample that it was before the page changed its triangles, and whether the page has scrambled them. */
  origin: string | undefined;
  isScrambled: boolean;
  /**
   * The worker that measures it. It starts when it is first asked for, so that it holds up no picture.
   *
   * @throws `Cancelled` after {@link close}.
   */
  readonly client: WorkerClient;
  /** Ends the worker. */
  close(): void;
  /** The ends of the edges that the user has drawn. */
  drawn: readonly number[];
  /** The files that it was read from. */
  kept: Kept | undefined;
  /** What its file has besides the mesh; `undefined` for a generated mesh. */
  extras: FileExtras | undefined;
  /** Notes about reading: changes to the mesh, and contents that were not read. */
  remark: string;
  /** The measures of the mesh, computed at the first call, because drawing does not need them. */
  before: () => Promise<Quality>;
  /** The sharp edges by angle, as far as they were needed. */
  features: Map<number, Promise<Uint32Array>>;
}

/** Called with the present step, and its completed share from 0 to 1, if it is known. */
export type Progress = (text: string, share?: number) => void;

export class Opening {
  /** The mesh, after it has been read. Changes of the settings then start its run again. */
  opened: Opened | undefined;
  readonly read: Promise<Opened>;
  readonly #reader = takeReader();
  readonly #progress: Progress;
  #isClosed = false;

  constructor(source: Source, progress: Progress) {
    this.#progress = progress;
    this.read = this.#read(source);
    // The page handles this error when it awaits the mesh.
    this.read.catch(() => {});
  }

  /** Stops reading, and ends the worker. */
  close(): void {
    this.#isClosed = true;
    (this.opened ?? this.#reader).close();
  }

  async #read(source: Source): Promise<Opened> {
    const read = await source.read(this.#reader, (path, share) => {
      if (!this.#isClosed) this.#progress(share < 1 ? `Reading ${path}…` : `Parsing ${path}…`, share);
    });
    if (read.mesh.indices.length === 0) throw new Error(`There are no triangles in ${read.name}.`);
    // The memory of a WebAssembly module never shrinks, so closing the worker frees the memory that reading used.
    this.#reader.close();
    return (this.opened = openedOf(read, source));
  }
}

/** The mesh, once it was read. It keeps nothing of its opening, whose worker holds memory. */
function openedOf(read: Read, source: Source): Opened {
  const { mesh, name, kept } = read;
  let client: WorkerClient | undefined;
  let isClosed = false;
  let measured: Promise<Quality> | undefined;
  const opened: Opened = {
    mesh,
    plan: planOf(mesh),
    name,
    title: source.title ?? name,
    what: source.what,
    spec: source.spec,
    origin: source.origin ?? source.spec,
    isScrambled: source.isScrambled ?? false,
    get client() {
      if (isClosed) throw new Cancelled();
      return (client ??= new WorkerClient());
    },
    close() {
      isClosed = true;
      client?.close();
    },
    drawn: source.drawn ?? [],
    kept,
    extras: read.extras ?? (kept && 'dropped' in mesh ? new FileExtras(mesh, kept) : undefined),
    remark: remarkOn(read),
    before: async () => (measured ??= opened.client.call((worker) => worker.measure(mesh, BINS))),
    features: new Map(),
  };
  return opened;
}

/** The mesh with other triangles: with an edge that the user has drawn, or scrambled. */
export function again(opened: Opened, beta: number, mesh: IndexedMesh, ends: readonly number[] = []): Source {
  const { name, title, kept, extras, drawn, origin } = opened;
  const read = async () => ({ name, mesh, kept, extras, others: 0 });
  const isScrambled = opened.isScrambled || ends.length === 0;
  const what = isScrambled ? 'Edges scrambled' : 'With edges that you drew';
  return { name, title, what, ...(origin ? { origin } : {}), isScrambled, beta, drawn: [...drawn, ...ends], read };
}

function remarkOn({ mesh, others }: Read): string {
  const left =
    others > 0 ? `${number.format(others)} other mesh ${others === 1 ? 'file was' : 'files were'} not opened.` : '';
  return [left, 'polygons' in mesh ? remarkOnFile(mesh) : ''].filter(Boolean).join(' ');
}

function remarkOnFile(mesh: FileMesh): string {
  const cut =
    mesh.polygons > 0
      ? `${counted(mesh.polygons, 'face')} ${mesh.polygons === 1 ? 'was' : 'were'} cut into triangles.`
      : '';
  const crossing = mesh.crossing
    ? `${number.format(mesh.crossing.length)} of them ${mesh.crossing.length === 1 ? 'has' : 'have'} an outline that crosses or touches itself; the first is face ${mesh.crossing[0]}.`
    : '';
  const dropped = mesh.dropped.length > 0 && !mesh.keeps ? `Not kept: ${mesh.dropped.join(', ')}.` : '';
  const [most, ...others] = mesh.attributeEdges;
  const keeps = most
    ? `${staying(most.edges)} to keep ${attributeOf(most.name)}${others.length > 0 ? ', more to keep others' : ''}.`
    : '';
  return [cut, crossing, dropped, keeps, ...mesh.notes.map((note) => `${note}.`)].filter(Boolean).join(' ');
}
