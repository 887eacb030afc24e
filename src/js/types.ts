/** The types of the input, the options and the results. */

import type { Attributes, GpuBuffer, GpuDevice, IndexArray, Indices, VertexArray } from './mesh-types.js';

export type { Edges } from './edges.js';
export type * from './mesh-types.js';

/** An engine. All engines give the same result, bit for bit. */
export type Engine = 'webgpu' | 'webgl2' | 'cpu';

/** The options of a session. A call copies arrays before it returns. */
export interface Options {
  /**
   * `'webgpu'`, `'webgl2'` and `'cpu'` take that engine or fail. `'auto'`, the default, takes the engine that is
   * estimated to finish first: the CPU for a small mesh, WebGPU for a large one. It takes WebGPU only on a hardware GPU
   * that has flipped a test mesh correctly. While the browser prepares that GPU, the run starts on the CPU, unless the
   * mesh is so large that waiting is faster. A session on one thread may move to the GPU later, in `run` or in
   * `setPositions`; a session on several threads stays on the CPU. If the device is lost, the CPU continues. `'auto'`
   * never takes WebGL2, which is slower than the CPU. {@link Result.fallback} says why the CPU ran.
   */
  backend?: 'auto' | Engine | undefined;
  /**
   * β: an edge flips only if the normals of its two triangles differ by at most this angle in degrees, before and after
   * the flip. For surfaces only. Default: 10.
   */
  maxNormalAngle?: number | undefined;
  /**
   * How far one flip may move the surface: the largest distance between the old and the new diagonal, in the units of
   * the positions, rounded down to a 32-bit float. The distance is the one between the lines through the two diagonals,
   * even where the diagonals end before they pass each other. For surfaces only. Default: `Infinity`.
   */
  maxDeviation?: number | undefined;
  /** Stops the run after this number of iterations. Default: no limit; every run ends by itself. */
  maxIterations?: number | undefined;
  /**
   * Edges that never flip, as pairs of vertices, one pair after the other, in any order. Every pair has to be an edge
   * of the mesh; pairs may repeat. Locked edges that are not Delaunay at the end are counted as `locked`.
   */
  lockedEdges?: IndexArray | undefined;
  /** The indices of triangles that never change. Their edges are locked. */
  lockedTriangles?: IndexArray | undefined;
  /**
   * A number for each triangle. Edges between triangles with different numbers are locked, so every group keeps its
   * border.
   */
  groups?: IndexArray | undefined;
  /**
   * Edges to bring in before the run, as pairs of vertices, one pair after the other, for a mesh in the plane. The edges
   * that they cross make way for others; then they are locked. A vertex on such an edge splits it. An edge that crosses
   * another one, a locked edge or the boundary is an error that names both. A terrain needs a `plane`. Loads
   * the module of `edgeflip/files`.
   */
  constraints?: IndexArray | undefined;
  /**
   * The largest distance of a vertex from a constraint that counts as on it, in the units of the positions: the
   * constraint then goes through the vertex, so that lines meet which miss their common vertex by rounding. The result
   * has the largest of these distances as `constraintDeviation`. Default: 0.
   */
  constraintTolerance?: number | undefined;
  /** Leaves out the constraints that cannot be brought in, and lists them as `leftOut`. Default: they are errors. */
  skipConstraints?: boolean | undefined;
  /**
   * Whether triangles of a mesh in the plane that have turned over, or have no area, become positive again, wherever the
   * positions have a triangulation. Flips cannot do that: vertices are lifted out and put back. Default: after vertices
   * have moved, in `setPositions` and the calls that act like it. `true`: also before the first run, and before
   * `constraints`; an error for a surface in space. `false`: never. Triangles then change places, so data of triangles
   * does not follow. Loads a module of its own, by default when a mesh needs it.
   */
  untangle?: boolean | undefined;
  /**
   * First reverses the minority of inconsistently oriented triangles in each orientable component. Without it, edges
   * between inconsistently oriented triangles never flip. Loads the module of `edgeflip/files`.
   */
  reorient?: boolean | undefined;
  /**
   * Joins vertices at exactly the same position for the run, so that edges flip between triangles that share no
   * vertices, and splits them again in the result. If vertices at the same position differ in these attributes, the
   * edges of that seam are locked, and every corner of the result has a vertex with its attributes. `true` ignores
   * attributes. When the positions of a session change, vertices that were joined have to stay together. `edges`,
   * `verify` and `gpu` describe the joined mesh, which has the first vertex at each position. Loads the module of
   * `edgeflip/files`.
   */
  weld?: boolean | Attributes | undefined;
  /**
   * `'reproducible'`, the default, runs the parallel iterations, which are the same on every engine. `'any'` runs
   * Lawson's algorithm on the CPU, which is faster; a run is then one iteration.
   */
  order?: 'reproducible' | 'any' | undefined;
  /**
   * Keeps the number of the update that changed each triangle last, for `changes` of a session: 4 bytes per triangle.
   * Not with the order `'any'`, and not on WebGL2. Default: false.
   */
  trackChanges?: boolean | undefined;
  /**
   * Keeps `twins` and `vertexHalfEdges` of `gpu` of a session, for kernels that walk around vertices: 12 bytes per
   * triangle and 4 per vertex. Only on WebGPU; the other engines have no buffers. Default: false.
   */
  adjacency?: boolean | undefined;
  /**
   * The largest number of threads of the CPU engine, 1 to 256. Default: one per core. A mesh of fewer than 65,536
   * triangles runs on one thread, a larger one on at most one thread per 4,096 triangles. Several threads need shared
   * memory: Node has it, and so does a cross-origin isolated page. The result is the same for any number.
   */
  threads?: number | undefined;
  /**
   * Your own `GPUDevice`, for `'webgpu'` and `'auto'` to run on; you can then use the buffers of the session with it.
   * Its default limits suffice. The session does not destroy it, changes no setting of it, and ignores errors that it
   * did not cause. `'auto'` takes no software device. The CPU ignores this option.
   */
  device?: GpuDevice | undefined;
}

/**
 * How the package reads an option; `settings.ts` has a reader for each kind, and the modules check the values. A list of
 * texts names all values.
 */
type KindOf<T> = [T] extends [boolean]
  ? 'flag'
  : [T] extends [string]
    ? readonly T[]
    : [T] extends [number]
      ? 'number' | 'whole' | 'limit'
      : [T] extends [IndexArray]
        ? 'list'
        : 'attributes' | 'device';

/** The kind of each option. One without an entry does not compile. */
export const OPTION_KINDS = {
  backend: ['auto', 'webgpu', 'webgl2', 'cpu'],
  maxNormalAngle: 'number',
  maxDeviation: 'number',
  maxIterations: 'limit',
  lockedEdges: 'list',
  lockedTriangles: 'list',
  groups: 'list',
  constraints: 'list',
  constraintTolerance: 'number',
  skipConstraints: 'flag',
  untangle: 'flag',
  reorient: 'flag',
  weld: 'attributes',
  order: ['reproducible', 'any'],
  trackChanges: 'flag',
  adjacency: 'flag',
  threads: 'whole',
  device: 'device',
} as const satisfies { [Name in keyof Options]-?: KindOf<NonNullable<Options[Name]>> };

/** How far a run has come. */
export interface Progress {
  /** Iterations so far. */
  iterations: number;
  /** Flips so far. */
  flips: number;
}

/** The options of a run. */
export interface RunOptions {
  /** Stops the run after a complete iteration. The result then has the status `'stopped'`, and nothing is thrown. */
  signal?: AbortSignal | undefined;
  /**
   * Called after every batch: one iteration on one CPU thread, the iterations of 32 ms on several, many on a GPU.
   */
  onProgress?: ((progress: Progress) => void) | undefined;
}

/** The options of an update. */
export interface UpdateOptions {
  /** New positions of all vertices, with the stride and the offset of the mesh. The array is copied at once. */
  positions?: VertexArray | readonly number[] | undefined;
  /**
   * New positions in a buffer of 32-bit floats on the device of the session, which copies them there. Its usage has to
   * include STORAGE, or COPY_SRC if there are no gaps. Without `positions` and `buffer`, the update takes the positions
   * in the buffer of `gpu()`: those that the page has written there, or the present ones.
   */
  buffer?: GpuBuffer | undefined;
  /** The count of numbers in `buffer` before the first vertex. Default: 0. `positions` have the offset of the mesh. */
  offset?: number | undefined;
  /**
   * The count of numbers in `buffer` from a vertex to the next. Default: the dimension of the mesh. `positions` have the
   * stride of the mesh.
   */
  stride?: number | undefined;
  /**
   * The most iterations, 0 to 64. Default: 4. It is a budget: what is left goes on in the next update. With the order
   * `'any'`, every number but 0 flips to the end.
   */
  iterations?: number | undefined;
}

/** What the updates of a session have done, and what is left. */
export interface Counters {
  /** The number of updates that the counts are of: all before the call. */
  updates: number;
  /** Flips of these updates. */
  flips: number;
  /**
   * Edges that are not Delaunay after the last of them. `stopped` counts those that the next update may flip. Frozen
   * edges (`non-manifold`, `inconsistent`) are not counted.
   */
  remaining: Reasons;
  /**
   * Triangles that are turned over, as {@link Result.inverted} counts them, compared with the orientation of their
   * component at the start of the session.
   */
  inverted: number;
  /** Triangles of no area. */
  flat: number;
  /**
   * Triangles that are not decided: a coordinate is not finite, or the coordinates span more bits than WebGPU and WebGL2
   * decide exactly, or reach 2^126.
   */
  undecided: number;
  /** Edges left alone, because a coordinate of their triangles is not finite. */
  nonFinite: number;
  /**
   * Edges left alone, because the coordinates of their triangles span more bits than WebGPU and WebGL2 decide exactly,
   * or reach 2^126. The CPU decides them all.
   */
  tooWide: number;
}

/** The options of {@link makeDelaunay}. */
export interface MakeDelaunayOptions extends Options, RunOptions {
  /** Called after every iteration. Watching costs time, because each iteration is then counted and awaited. */
  onIteration?: ((iteration: Iteration) => void) | undefined;
}

/** The options of {@link makeDelaunaySync}: those that need no GPU, no worker and no other module. */
export type SyncOptions = Omit<
  Options,
  | 'backend'
  | 'device'
  | 'threads'
  | 'trackChanges'
  | 'adjacency'
  | 'weld'
  | 'reorient'
  | 'constraints'
  | 'constraintTolerance'
  | 'skipConstraints'
  | 'untangle'
>;

/**
 * Why an edge is still not Delaunay.
 *
 * | reason | meaning |
 * |---|---|
 * | `angle` | the normals differ by more than `maxNormalAngle`, or did so in the input |
 * | `fold` | a new triangle would turn over |
 * | `duplicate` | the new edge exists already |
 * | `locked` | the options lock the edge; this takes precedence over all other reasons |
 * | `deviation` | the diagonals are further apart than `maxDeviation` |
 * | `non-manifold` | the edge has three or more triangles, or one triangle twice |
 * | `inconsistent` | its two triangles are oriented inconsistently |
 * | `stopped` | the run stopped before it flipped the edge |
 */
export type Reason =
  | 'angle'
  | 'fold'
  | 'duplicate'
  | 'locked'
  | 'deviation'
  | 'non-manifold'
  | 'inconsistent'
  | 'stopped';

/** The number of edges that are not Delaunay, by reason. A reason without edges is absent. */
export type Reasons = Partial<Record<Reason, number>>;

/** A watched iteration. */
export interface Iteration {
  /** Its index, from 0. */
  index: number;
  /** The edges of the whole mesh that were not Delaunay and could flip, before the iteration. */
  labelled: number;
  /** The edges that it flipped. */
  flips: number;
  /** The edges that were not Delaunay and could not flip, before the iteration. Only the result counts frozen edges. */
  blocked: Reasons;
  /** Its time in milliseconds. */
  ms: number;
}

/** A constraint that was left out. */
export interface LeftOut {
  /** Which pair of `constraints` it is, from 0. */
  index: number;
  /** A sentence that says why, with the vertices and what it crosses. */
  reason: string;
}

/** The result of a run. */
export interface Result<I extends IndexArray = Uint32Array> {
  /** Vertex indices, 3 per triangle, in an array of the type of the mesh. The vertices are those of the input. */
  indices: Indices<I>;
  /** `'done'` if no edge is left that can flip; `'stopped'` by the signal or by `maxIterations`. */
  status: 'done' | 'stopped';
  /** The engine that ran. */
  backend: Engine;
  /** The name of the GPU. */
  adapter: string | undefined;
  /** Why `'auto'` ran on the CPU, or started there. */
  fallback: string | undefined;
  /** The threads of the CPU engine; 0 if a GPU ran. */
  threads: number;
  /** Advice, if the mesh or the page seems to be set up in a way that you do not want: sentences for a developer. */
  hint: string | undefined;
  /** Iterations with at least one flip. */
  iterations: number;
  /** All flips. */
  flips: number;
  /** Flips of each iteration. */
  flipsPerIteration: Uint32Array;
  /** Compute dispatches on WebGPU, passes on WebGL2. */
  dispatches: number;
  /** The largest size of the buffers of WebGPU, in bytes; 0 on other engines. */
  deviceBytes: number;
  /** Edges of the mesh. */
  edges: number;
  /** Edges with one triangle. */
  boundaryEdges: number;
  /** Edges with three or more triangles, or with one triangle twice. They never flip. */
  nonManifoldEdges: number;
  /** Edges whose two triangles are oriented inconsistently. They never flip. */
  inconsistentEdges: number;
  /** Triangles that `reorient` reversed. */
  turnedTriangles: number;
  /** Vertices that `weld` joined to another vertex. */
  joinedVertices: number;
  /** Edges that `weld` locked, because attributes differ across them. */
  seamEdges: number;
  /** How many edges the `constraints` crossed: each made way for another one, without a flip. */
  crossedEdges: number;
  /**
   * The edges that `constraints` have become, two vertices per edge of these `indices`, for `regions` of
   * `edgeflip/files`. They are in the order of the constraints; a constraint through vertices is several edges.
   */
  constraintEdges: Uint32Array;
  /** The largest distance of a vertex from the constraint that goes through it; 0 without `constraintTolerance`. */
  constraintDeviation: number;
  /** The constraints that `skipConstraints` left out. */
  leftOut: LeftOut[];
  /**
   * Locked edges and edges of constraints that `untangle` could not keep, because they cross others or pass through a
   * vertex: pairs of vertices, the smaller one first, in ascending order. They come back when the positions allow it.
   * Where triangles stay turned over or flat, flips may have made one again, which is not locked then.
   */
  lostEdges: Uint32Array;
  /** Edges that are still not Delaunay. */
  remaining: Reasons;
  /**
   * Triangles that are turned over, in the plane: they have not the orientation of their component. A component is
   * connected over edges between two triangles of one orientation, and has the orientation of its total area; without
   * an area it counts as counter-clockwise. 0 for a surface in space.
   */
  inverted: number;
  /** Triangles of no area: their corners are on one line, exactly. */
  flat: number;
  /**
   * Times in milliseconds: `constraints` is what brought the constraints in, with the loading of its module, `upload` the
   * preparation of a GPU and the copies to it, `adjacency` the construction of the twins, `flip` the iterations, `total`
   * all of it, but not `weld`, `reorient` and `untangle`. WebGPU in a browser is awaited once, after the first
   * iterations; `flip` then includes the copies and the adjacency.
   */
  timings: { constraints: number; upload: number; adjacency: number; flip: number; total: number };
}
