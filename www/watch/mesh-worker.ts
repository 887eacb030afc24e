/** The worker: reads, generates and measures meshes, or runs an engine, so that the page never blocks. */

import { expose, transfer } from 'comlink';
import { EDGE_STATES, init, type FlipSession, type Iteration, type Options, type Plane } from 'edgeflip';
import {
  angles,
  change,
  constrain,
  generate,
  init as initFiles,
  measures,
  readMesh,
  writeMesh,
  type Angles,
  type FileMesh,
  type IndexedMesh,
  type Measures,
} from 'edgeflip/files';
import { naming } from './crash.ts';
import { changeOf, type Change } from './change.ts';
import type { FoundColours, Sizes } from './colour-format.ts';
import { scrambled } from '../models/scramble.js';
import { featuresOf } from './features.ts';
import { errorOf } from './kinds.ts';
import { countLocks } from './locks.ts';
import { contentOfKept, keep, type Kept, readWith, type Located, type Report } from './files.ts';
import type { Seams } from './seam.ts';
import { countStates, sessionOf, statesOf, summaryOf, type OpenMesh, type Step, type Summary } from './run.ts';

/**
 * The most triangles of a surface that is compared with its input: with many more, the comparison would take seconds.
 */
const COMPARED = 50_000;

/** The flips at random, for each triangle. */
const SCRAMBLED = 0.7;

/** The measures of a mesh. */
export interface Quality {
  angles: Angles;
  measures: Measures;
}

/** The states of the sides of each triangle, in the form of `Corners.sides`, and the number of edges in each state. */
export interface SideStates {
  /** The states of the half-edges. */
  states: Uint8Array;
  sides: Uint32Array<ArrayBuffer>;
  counts: number[];
}

/** The flips of an iteration, and the edges that could flip before it. */
export type Flips = Pick<Iteration, 'flips' | 'labelled'>;

class MeshWorker {
  #session: FlipSession | undefined;
  #before: Uint32Array = new Uint32Array();
  /** A run on the CPU whose states are looked at: its mesh, its options, and its session once there is one. */
  #beside: { mesh: OpenMesh; options: Options; session: FlipSession | undefined; at: number } | undefined;

  async generate(spec: string): Promise<IndexedMesh> {
    const mesh = await naming(generate(spec));
    return transfer(mesh, buffersOf(mesh));
  }

  /** `beside` has files that `main` may name; `plane` is that of a terrain. */
  async read(
    main: Located,
    beside: Located[],
    plane: Plane | undefined,
    report: Report,
  ): Promise<{ mesh: FileMesh; kept: Kept }> {
    const { name } = main.file;
    const reading = readWith(main, beside, report, (bytes, files) =>
      readMesh(bytes, name, { files, plane }).catch(async (error: unknown) => {
        throw await errorOf(error, name, bytes);
      }),
    );
    const { result: mesh, content } = await naming(reading);
    if (beside.length > 0) await (await import('./pictures.ts')).addPictures(content, main, beside);
    return transfer({ mesh, kept: keep(name, content) }, buffersOf(mesh));
  }

  /** `kept` has the files that the mesh was read from. */
  async write(mesh: IndexedMesh, name: string, kept: Kept | undefined): Promise<Uint8Array<ArrayBuffer>> {
    const content = kept && (await contentOfKept(kept));
    const original = content && { bytes: content.bytes, name: kept.name, files: Object.fromEntries(content.beside) };
    const bytes = await naming(writeMesh(mesh, name, { original }));
    return transfer(bytes, [bytes.buffer]);
  }

  /** The colours of the file of a mesh. */
  async colours(kept: Kept, sizes: Sizes): Promise<FoundColours> {
    const { coloursOf } = await import('./file-colours.ts');
    const found = await coloursOf(kept, sizes);
    const { vertices, layers } = found.colours ?? {};
    return transfer(
      found,
      [vertices, layers?.pixels].flatMap((array) => array?.buffer ?? []),
    );
  }

  /** The seams of a mesh as it was read. */
  async seams(mesh: FileMesh, kept: Kept): Promise<Seams> {
    const { seamsOf } = await import('./seams.ts');
    return naming(seamsOf(mesh, kept));
  }

  async measure(mesh: IndexedMesh, bins: number): Promise<Quality> {
    return { angles: await naming(angles(mesh, bins)), measures: await naming(measures(mesh)) };
  }

  /** How many triangles changed, and how far the surface moved; `undefined` for a large surface. */
  async compare(mesh: IndexedMesh, after: Uint32Array): Promise<{ moved: number; distance: number } | undefined> {
    if (mesh.dimension === 3 && after.length > 3 * COMPARED) return undefined;
    const { moved, distance } = await naming(change(mesh, after));
    return { moved: moved.length, distance };
  }

  /**
   * The flips of all iterations of a run; `undefined` if it takes more than `longest` milliseconds. Every engine has the
   * same, so they hold for the run on any engine.
   */
  async lookAhead(mesh: OpenMesh, options: Options, longest: number): Promise<Flips[] | undefined> {
    const end = performance.now() + longest;
    const session = await naming(sessionOf(mesh, { ...options, backend: 'cpu' }));
    try {
      const all: Flips[] = [];
      for await (const { flips, labelled } of session) {
        if (performance.now() > end) return undefined;
        all.push({ flips, labelled });
      }
      return all;
    } finally {
      session.free();
    }
  }

  /** Takes the mesh and the options of the run whose states are looked at from now on. */
  async beginStates(mesh: OpenMesh, options: Options): Promise<void> {
    this.#beside?.session?.free();
    this.#beside = { mesh, options, session: undefined, at: 0 };
  }

  /** The states after `at` iterations. Calls must not overlap. */
  async statesAt(at: number): Promise<SideStates> {
    const beside = this.#beside;
    if (!beside) throw new Error('no run was given');
    if (beside.session && beside.at > at) {
      beside.session.free();
      beside.session = undefined;
    }
    if (!beside.session) {
      beside.session = await naming(sessionOf(beside.mesh, { ...beside.options, backend: 'cpu' }));
      beside.at = 0;
    }
    const { session } = beside;
    while (beside.at < at && (await naming(session.step()))) beside.at++;
    const states = await naming(session.edgeStates());
    const isCrowded = states.includes(EDGE_STATES.indexOf('non-manifold'));
    const counts = countStates(states, isCrowded ? (await naming(session.result())).nonManifoldEdges : 0);
    const sides = new Uint32Array(states.length / 3);
    for (let t = 0; t < sides.length; t++) {
      sides[t] = states[3 * t]! | (states[3 * t + 1]! << 4) | (states[3 * t + 2]! << 8);
    }
    return transfer({ states, sides, counts }, [states.buffer, sides.buffer]);
  }

  /** The edges at which the surface bends by more than an angle in degrees: two vertices each. */
  features(mesh: IndexedMesh, degrees: number): Promise<Uint32Array> {
    return naming(featuresOf(mesh, degrees));
  }

  /** The number of edges that are locked. */
  async countLocks(...given: Parameters<typeof countLocks>): Promise<number> {
    return countLocks(...given);
  }

  /** The triangles after flips at random that bend the surface little. Edges that are locked stay. */
  async scramble(mesh: OpenMesh, degrees: number, seed: number): Promise<Uint32Array> {
    return scrambled(mesh, Math.round(SCRAMBLED * (mesh.indices.length / 3)), degrees, seed);
  }

  /**
   * Brings an edge in. Returns the triangles, and all locked edges.
   *
   * @throws if the edge cannot come in.
   */
  async drawEdge(mesh: OpenMesh, ends: readonly number[]): Promise<Pick<OpenMesh, 'indices' | 'lockedEdges'>> {
    const { lockedEdges: edges, lockedTriangles, groups } = mesh;
    const locks = { lockedEdges: edges, lockedTriangles, groups };
    const { indices, lockedEdges, leftOut } = await naming(constrain(mesh, ends, locks, true));
    const reason = leftOut[0]?.reason.replace('constraint 0', 'The edge');
    if (reason) throw new Error(`${reason}.`);
    return { indices, lockedEdges };
  }

  /** Loads what reads files, so that the first mesh is read sooner. */
  async loadFiles(): Promise<void> {
    await initFiles();
  }

  /** Loads the engine, so that a run starts sooner. */
  async load(): Promise<void> {
    await init();
  }

  /** Starts a run. Returns the states of the edges, if the mesh is small enough to draw them. */
  async open(mesh: OpenMesh, options: Options): Promise<Uint8Array | undefined> {
    const session = await sessionOf(mesh, options);
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

function buffersOf(mesh: IndexedMesh & { placed?: Float32Array | undefined }): Transferable[] {
  return [mesh.positions.buffer, mesh.indices.buffer, ...(mesh.placed ? [mesh.placed.buffer] : [])];
}

export type { MeshWorker };
expose(new MeshWorker());
