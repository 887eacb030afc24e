/** The worker: reads, generates and measures meshes, or runs an engine, so that the page never waits. */

import { expose, transfer } from 'comlink';
import { FlipSession } from 'edgeflip';
import { angles, generate, readMesh, writeMesh, type Angles, type FileMesh, type Files, type IndexedMesh } from 'edgeflip/files';
import { naming } from './crash.ts';
import { changeOf, type Change } from './change.ts';
import type { Backend } from './engines.ts';
import { statesOf, summaryOf, type Step, type Summary } from './run.ts';

class Desk {
  #session: FlipSession | undefined;
  #before: Uint32Array = new Uint32Array();

  async generate(spec: string): Promise<IndexedMesh> {
    return send(await naming(generate(spec)));
  }

  async read(file: File, others: File[]): Promise<FileMesh> {
    return send(await naming(readMesh(await bytesOf(file), file.name, { files: await named(others) })));
  }

  /** `files` are those that the mesh was read from. */
  async write(mesh: IndexedMesh, name: string, [file, ...others]: File[]): Promise<Uint8Array<ArrayBuffer>> {
    const original = file && { bytes: await bytesOf(file), name: file.name, files: await named(others) };
    const bytes = await naming(writeMesh(mesh, name, { original }));
    return transfer(bytes, [bytes.buffer]);
  }

  angles(mesh: IndexedMesh, bins: number): Promise<Angles> {
    return naming(angles(mesh, bins));
  }

  /** Begins a run. Returns what its edges are, if they are to be drawn. */
  async open(mesh: IndexedMesh, maxNormalAngle: number, backend: Backend): Promise<Uint8Array | undefined> {
    const session = await FlipSession.create(mesh, { backend, maxNormalAngle });
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

async function bytesOf(file: File): Promise<Uint8Array> {
  return new Uint8Array(await file.arrayBuffer());
}

async function named(files: File[]): Promise<Files> {
  return Object.fromEntries(await Promise.all(files.map(async (file) => [file.name, await bytesOf(file)] as const)));
}

export type { Desk };
expose(new Desk());
