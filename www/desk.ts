/** The worker: reads, generates and measures meshes, or runs an engine, so that the page never waits. */

import { expose, transfer } from 'comlink';
import type { FlipSession } from 'edgeflip';
import {
  angles,
  change,
  EdgeflipError,
  generate,
  measures,
  readMesh,
  writeMesh,
  type Angles,
  type FileMesh,
  type Files,
  type IndexedMesh,
  type Measures,
} from 'edgeflip/files';
import { naming } from './crash.ts';
import { changeOf, type Change } from './change.ts';
import type { Backend } from './engines.ts';
import { sessionOf, statesOf, summaryOf, type OpenMesh, type Step, type Summary } from './run.ts';

/** What `readMesh` takes; what is larger is not read at all. */
const MOST_BYTES = 2 ** 30;
/** Surfaces of up to so many triangles are compared: many more would take seconds. */
const COMPARED = 50_000;

/** Told how much of the files has been read, from 0 to 1, while they are. */
export type Report = (share: number) => void;

/** What can be said of a result as a surface. */
export interface Quality {
  angles: Angles;
  measures: Measures;
}

class Desk {
  #session: FlipSession | undefined;
  #before: Uint32Array = new Uint32Array();

  async generate(spec: string): Promise<IndexedMesh> {
    return send(await naming(generate(spec)));
  }

  async read(file: File, others: File[], report: Report): Promise<FileMesh> {
    const [bytes, ...rest] = await contentOf([file, ...others], report);
    const reading = readMesh(bytes!, file.name, { files: named(others, rest) }).catch((error: unknown) => {
      const isOfFile = error instanceof EdgeflipError && error.code === 'parse';
      throw isOfFile ? new EdgeflipError('parse', `${file.name}: ${error.message}`) : error;
    });
    return send(await naming(reading));
  }

  /** `files` are those that the mesh was read from. */
  async write(mesh: IndexedMesh, name: string, [file, ...others]: File[]): Promise<Uint8Array<ArrayBuffer>> {
    const [bytesOfFile, ...rest] = await contentOf(file ? [file, ...others] : [], () => {});
    const original = file && bytesOfFile && { bytes: bytesOfFile, name: file.name, files: named(others, rest) };
    const bytes = await naming(writeMesh(mesh, name, { original }));
    return transfer(bytes, [bytes.buffer]);
  }

  async measure(mesh: IndexedMesh, bins: number): Promise<Quality> {
    return { angles: await naming(angles(mesh, bins)), measures: await naming(measures(mesh)) };
  }

  /** How many triangles are others now and how far the surface has moved; `undefined` for a large one. */
  async compare(mesh: IndexedMesh, after: Uint32Array): Promise<{ moved: number; distance: number } | undefined> {
    if (mesh.dimension === 3 && after.length > 3 * COMPARED) return undefined;
    const { moved, distance } = await naming(change(mesh, after));
    return { moved: moved.length, distance };
  }

  /** Begins a run. Returns what its edges are, if they are to be drawn. */
  async open(mesh: OpenMesh, maxNormalAngle: number, backend: Backend): Promise<Uint8Array | undefined> {
    const session = await sessionOf(mesh, { backend, maxNormalAngle });
    this.#session = session;
    this.#before = mesh.indices;
    return statesOf(session, mesh.indices.length);
  }

  step(): Promise<(Step & { change: Change }) | undefined> {
    return naming(this.#step());
  }

  result(): Promise<Summary> {
    return naming(summaryOf(this.#running()));
  }

  async #step(): Promise<(Step & { change: Change }) | undefined> {
    const session = this.#running();
    const iteration = await session.step();
    if (!iteration) return undefined;
    const now = await session.triangles();
    const change = changeOf(this.#before, now);
    this.#before = now;
    const states = await statesOf(session, now.length);
    return transfer({ iteration, change, states }, [change.at.buffer, change.xor.buffer]);
  }

  #running(): FlipSession {
    if (!this.#session) throw new Error('no run has begun');
    return this.#session;
  }
}

function send<T extends IndexedMesh & { placed?: Float32Array | undefined }>(mesh: T): T {
  return transfer(mesh, [mesh.positions.buffer, mesh.indices.buffer, ...(mesh.placed ? [mesh.placed.buffer] : [])]);
}

/** The bytes of files, one after the other. */
async function contentOf(files: File[], report: Report): Promise<Uint8Array[]> {
  const most = files.reduce((sum, { size }) => sum + size, 0);
  if (most > MOST_BYTES) {
    throw new Error(`${files[0]?.name} has ${most} bytes, more than the ${MOST_BYTES} that a page can take; use the command line`);
  }
  let [read, told] = [0, 0];
  const bytesOf = async (file: File) => {
    const bytes = new Uint8Array(file.size);
    const reader = file.stream().getReader();
    for (let at = 0; ; ) {
      const { done, value } = await reader.read();
      if (done) return bytes;
      bytes.set(value, at);
      at += value.length;
      read += value.length;
      if (read - told > most / 100) report((told = read) / most);
    }
  };
  const content = [];
  for (const file of files) content.push(await bytesOf(file));
  report(1);
  return content;
}

function named(files: File[], content: Uint8Array[]): Files {
  return Object.fromEntries(files.map(({ name }, i) => [name, content[i]!]));
}

export type { Desk };
expose(new Desk());
