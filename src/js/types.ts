/** What goes into the package and what comes out of it. */

/// <reference types="@webgpu/types" preserve="true" />

/** A triangle mesh. Its arrays are copied before a call returns, and stay the caller's. */
export interface Mesh {
  /**
   * 2 or 3 numbers a vertex. Decisions are exact for the numbers given. WebGPU and WebGL2 take those that span at most
   * 84 bits and a sign as seen from the middle of the bounding box, the CPU takes all.
   */
  positions: Float32Array | Float64Array;
  /** Vertex indices, 3 a triangle. */
  indices: Uint32Array | Uint16Array;
  /** 2 for a mesh in the plane, 3 for a surface in space. */
  dimension: 2 | 3;
}

/** Bytes of files by their names, such as `{ 'scene.bin': bytes }`. */
export type Files = Readonly<Record<string, Uint8Array>>;

/** A file that a mesh was read from, with what it was read with. */
export interface Original {
  bytes: Uint8Array;
  name: string;
  files?: Files | undefined;
  maxBytes?: number | undefined;
}

/** Numbers for the vertices of a mesh, the same count for each, such as 2 texture coordinates. */
export type VertexArray =
  | Int8Array
  | Uint8Array
  | Uint8ClampedArray
  | Int16Array
  | Uint16Array
  | Int32Array
  | Uint32Array
  | Float32Array
  | Float64Array;

/**
 * What vertices at one place have: those with the same bits in all arrays are the same. Or the file that the mesh was
 * read from: of glTF the vertices of each primitive are joined for themselves, and those are the same that have the
 * same bytes in all accessors. Files of other formats say nothing here: write what comes of them without `original`.
 */
export type Attributes = readonly VertexArray[] | Original;

/** An engine. All give the same result, bit for bit. */
export type Engine = 'webgpu' | 'webgl2' | 'cpu';

/** What can be chosen for a session. Arrays are copied before a call returns. */
export interface Options {
  /**
   * `'webgpu'`, `'webgl2'` and `'cpu'` take that engine or fail. `'auto'` (default) takes the one that is done first: the
   * CPU for a small mesh, and WebGPU for a large one, on a hardware GPU that gets a test mesh right. Where the browser still
   * has to make that GPU ready, the run begins on the CPU and the GPU is made ready behind it, unless the mesh is so large
   * that waiting is faster. A session on one thread may go over to the GPU later, in `run` or in `setPositions`; one on
   * several threads stays on the CPU. Where the device is lost, the CPU goes on. It never takes WebGL2, which takes longer
   * than the CPU. {@link Result.fallback} says why it is the CPU.
   */
  backend?: 'auto' | Engine | undefined;
  /**
   * The largest angle in degrees between the normals of two triangles whose edge may flip, before and after; sharper
   * edges stay. For surfaces only. Default 10.
   */
  maxNormalAngle?: number | undefined;
  /**
   * The largest distance between the old and the new diagonal of a flip, in the units of the positions, rounded down to
   * a 32-bit float: what one flip may move the surface by. Of the lines that they lie on, where the diagonals themselves
   * do not pass each other. For surfaces only. Default: `Infinity`.
   */
  maxDeviation?: number | undefined;
  /** Stop after so many iterations. Default: run to the end, which is always reached. */
  maxIterations?: number | undefined;
  /**
   * Edges that never flip: two vertices each, one pair after the other, in any order; repeated pairs are one. Each has
   * to be an edge of the mesh. Those that are not Delaunay in the end are counted as `locked`.
   */
  lockedEdges?: Uint32Array | readonly number[] | undefined;
  /** Triangles that stay as they are, by their numbers: their edges are locked. */
  lockedTriangles?: Uint32Array | readonly number[] | undefined;
  /**
   * A number for each triangle: edges between triangles of different numbers are locked, so that every group keeps its
   * border. Flips leave each triangle in its group.
   */
  groups?: Uint32Array | readonly number[] | undefined;
  /**
   * Turns triangles first, so that neighbours agree about the side that is outside: in each component where that is
   * possible, the fewer. Else edges between triangles turned against each other stay. Loads the module of
   * `edgeflip/files`.
   */
  reorient?: boolean | undefined;
  /**
   * Joins vertices at exactly the same position for the run, so that edges flip where triangles have no vertices in
   * common; the indices of the result are split again. Where vertices of one place differ in these attributes, the edges
   * of the seam are locked, and every corner of the result has a vertex with its attributes; with `true` all of one place
   * are the same. The vertices of a place have to stay at one place when the positions of a session change. What
   * `edges`, `verify` and `gpu` give is of the joined mesh, which has the first vertex of each place. Loads the module of
   * `edgeflip/files`.
   */
  weld?: boolean | Attributes | undefined;
  /**
   * `'reproducible'` (default): the parallel iterations, the same on every engine. `'any'`: Lawson's sequential
   * algorithm, on the CPU only: faster, and a run is one iteration.
   */
  order?: 'reproducible' | 'any' | undefined;
  /**
   * How many threads the CPU engine runs on at most, 1 to 256. Default: one for each core. More than one needs a mesh of
   * 65,536 triangles, with 4,096 for each: fewer are done before others have woken up. It needs shared memory too: Node has it, a page where it is cross-origin isolated.
   * Else it is one. The result is the same for any number.
   */
  threads?: number | undefined;
  /**
   * The page's own GPUDevice, for `'webgpu'` and `'auto'` to run on: buffers of the session can then be used with it.
   * Default limits are enough. The session neither destroys it nor sets anything of it, and leaves errors alone that it
   * did not make. `'auto'` leaves a software device. Without effect on the CPU.
   */
  device?: GPUDevice | undefined;
}

/** How far a run has come. */
export interface Progress {
  /** Iterations so far. */
  iterations: number;
  /** Flips so far. */
  flips: number;
}

/** What can be chosen for a run. */
export interface RunOptions {
  /** Stops the run after a complete iteration. The result then has the status `'stopped'`; nothing is thrown. */
  signal?: AbortSignal | undefined;
  /** Called after every batch of iterations: on one thread of the CPU one, on several those of 32 ms, on the GPU many. */
  onProgress?: ((progress: Progress) => void) | undefined;
}

/** What can be chosen for {@link makeDelaunay}. */
export interface MakeDelaunayOptions extends Options, RunOptions {
  /** Called after every iteration. Watching costs time: each iteration is then counted and waited for. */
  onIteration?: ((iteration: Iteration) => void) | undefined;
}

/**
 * Why an edge is still not Delaunay. `angle`: the normals differ by more than `maxNormalAngle`. `fold`: a new
 * triangle would turn over. `duplicate`: the edge that the flip would make exists already. `locked`: the
 * options lock it, whatever else it is. `deviation`: the diagonals are further apart than `maxDeviation`. `non-manifold`: three or more triangles, or one twice, meet there.
 * `inconsistent`: its two triangles are oriented against each other. `stopped`: the run was stopped before.
 */
export type Reason = 'angle' | 'fold' | 'duplicate' | 'locked' | 'deviation' | 'non-manifold' | 'inconsistent' | 'stopped';

/** Numbers of edges that are not Delaunay, by reason. A reason without an edge is absent. */
export type Reasons = Partial<Record<Reason, number>>;

/** What one watched iteration did. */
export interface Iteration {
  /** Its number, from 0. */
  index: number;
  /** Edges of the whole mesh that were not Delaunay and might flip, before it. */
  labelled: number;
  /** Edges flipped. */
  flips: number;
  /** Edges that were not Delaunay and might not flip, before it. Frozen edges are counted in the result only. */
  blocked: Reasons;
  /** Milliseconds. */
  ms: number;
}

/** The result of a run. */
export interface Result {
  /** Vertex indices, 3 a triangle; the vertices are those of the input. */
  indices: Uint32Array;
  /** `'done'`: no edge is left that may flip. `'stopped'`: by the signal or by `maxIterations`. */
  status: 'done' | 'stopped';
  /** The engine that ran. */
  backend: Engine;
  /** The name of the GPU. */
  adapter: string | undefined;
  /** Why `'auto'` is on the CPU, or began there. */
  fallback: string | undefined;
  /** Iterations with at least one flip. */
  iterations: number;
  /** Flips in all. */
  flips: number;
  /** Flips of each iteration. */
  flipsPerIteration: Uint32Array;
  /** Compute dispatches on WebGPU, passes on WebGL2. */
  dispatches: number;
  /** The most bytes that the buffers of WebGPU took at a time; 0 on other engines. */
  deviceBytes: number;
  /** Edges of the mesh. */
  edges: number;
  /** Edges with one triangle. */
  boundaryEdges: number;
  /** Edges with three or more triangles, or one twice. They stay. */
  nonManifoldEdges: number;
  /** Edges whose two triangles are oriented against each other. They stay. */
  inconsistentEdges: number;
  /** Triangles that `reorient` has turned. */
  turnedTriangles: number;
  /** Vertices that `weld` has joined to another one. */
  joinedVertices: number;
  /** Edges that `weld` has locked, since attributes differ on their two sides. */
  seamEdges: number;
  /** Edges that are still not Delaunay. */
  remaining: Reasons;
  /**
   * Milliseconds: on a GPU making the engine ready and the copies to it, the adjacency, the iterations, and all of it.
   * WebGPU is waited for once, behind the first iterations: `flip` has the copies and the adjacency then, and what is read
   * back with them.
   */
  timings: { upload: number; adjacency: number; flip: number; total: number };
}

/**
 * Every edge, one entry in each array: the Edges array of Navarro, Hitschfeld-Kahler and Scheihing (2011). `ta` and
 * `tb` are positions in the triangle indices: `indices[ta]` is `v1`, and the edge is one of triangle `ta / 3`. Edges
 * come in the order of `ta`, the smaller of the two.
 */
export interface Edges {
  /** First vertex. */
  v1: Uint32Array;
  /** Second vertex. */
  v2: Uint32Array;
  /** Where the edge starts in its first triangle. */
  ta: Uint32Array;
  /** Where it starts, from `v2`, in its second one; 0xffffffff on the boundary and on edges that are frozen. */
  tb: Uint32Array;
}

/** What an independent check of the triangles found, against the input. */
export interface Audit {
  /** Whether nothing is wrong. Edges that remain are not wrong. */
  clean: boolean;
  /** What is wrong: at most 100 sentences. */
  violations: string[];
  /** How many more there are. */
  unlisted: number;
  /** Numbers of edges that are not Delaunay, by the reason for which they cannot flip; `stopped` if they could. */
  remaining: Reasons;
  /**
   * Which edges these are: the two vertices of each, one edge after the other, by reason. So an array has two numbers
   * an edge, as an index buffer of line segments does. The smaller vertex comes first, and the edges are in ascending
   * order. A reason without an edge is absent.
   */
  remainingEdges: Partial<Record<Reason, Uint32Array>>;
}
