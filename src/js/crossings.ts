/** Lines that cross: the result of `splitCrossings`, and what its new vertices have between those of the mesh. */

import { EdgeflipError } from './error.js';
import type { ReadMesh } from './mesh.js';
import { AXES, type Floats } from './plane.js';
import type { IndexArray, LeftOut, Plane, VertexArray } from './types.js';

/** The options of `splitCrossings`. */
export interface SplitOptions {
  /** Edges that must not change, as the options of a run of the same names. A constraint that crosses one is an error. */
  lockedEdges?: IndexArray | undefined;
  lockedTriangles?: IndexArray | undefined;
  groups?: IndexArray | undefined;
  /** Leaves out the constraints that cannot be brought in, and lists them as `leftOut`. Default: they are errors. */
  skipConstraints?: boolean | undefined;
  /** Arrays with the same count of numbers for each vertex, such as colours, that the new vertices get too. */
  attributes?: readonly VertexArray[] | undefined;
}

/** The result of `splitCrossings`: a mesh, and how the constraints go through it. */
export interface SplitCrossings {
  /** The positions of all vertices, without gaps: those of the mesh, and then the new ones. 3 numbers each with a plane. */
  positions: Float32Array | Float64Array;
  /** Vertex indices, 3 per triangle. */
  indices: Uint32Array;
  dimension: 2;
  /** As that of the mesh. */
  plane?: Plane | undefined;
  /**
   * For each constraint, the vertices of its path of edges from its first end to its second; none if it was left out. Of
   * lines that are nearly parallel, a chain may come to a vertex twice: only so it passes others on the right side.
   */
  chains: Uint32Array[];
  /** The edges of all chains, each once, two vertices per edge, for the option `lockedEdges`. Without the locks. */
  constraintEdges: Uint32Array;
  /** For each new vertex, the indices of the two constraints that cross there, the earlier one first. */
  crossings: Uint32Array;
  /**
   * The attributes, in arrays of the same types, with the numbers of the new vertices. They, and heights, are interpolated
   * along the first constraint that passes a new vertex: between the vertices of the mesh before and after it. Integers
   * are rounded.
   */
  attributes: VertexArray[];
  /**
   * The largest distance of a chain from the line between the ends of its constraint. It is about what one coordinate is
   * rounded by, unless vertices are so near to each other that the lines had to go around them.
   */
  deviation: number;
  /** The constraints that were left out. */
  leftOut: LeftOut[];
}

/** What the module returns. */
export interface Split {
  positions: Floats;
  indices: Uint32Array;
  /** The chains, one after the other, and the index of the end of each. */
  chains: Uint32Array;
  ends: Uint32Array;
  constraintEdges: Uint32Array;
  crossings: Uint32Array;
  /** Two vertices for each new one, and how far it is from the first of these to the second: 0 to 1. */
  between: Uint32Array;
  at: Float64Array;
  deviation: number;
  leftOut: LeftOut[];
}

/**
 * The attributes of a mesh with so many vertices.
 *
 * @throws {@link EdgeflipError} `invalid-input`.
 */
export function checkWidths(attributes: readonly VertexArray[], vertices: number): void {
  for (const [i, { length }] of attributes.entries()) {
    if (length % vertices === 0 || length === vertices) continue;
    throw new EdgeflipError('invalid-input', `attribute ${i} has ${length} numbers, not a multiple of ${vertices}`);
  }
}

/** The result for a mesh and its attributes. */
export function splitOf(
  { positions: plan, space }: ReadMesh,
  plane: Plane | undefined,
  attributes: readonly VertexArray[],
  split: Split,
): SplitCrossings {
  const { indices, ends, constraintEdges, crossings, deviation, leftOut } = split;
  const vertices = plan.length / 2;
  const chains = Array.from(ends, (end, i) => split.chains.subarray(ends[i - 1] ?? 0, end));
  let positions = plan;
  if (space && plane) {
    positions = interpolated(space, vertices, split) as Floats;
    const [u, v] = AXES[plane] as [number, number];
    for (let i = vertices; i < split.positions.length / 2; i++) {
      positions[3 * i + u] = split.positions[2 * i]!;
      positions[3 * i + v] = split.positions[2 * i + 1]!;
    }
  } else {
    // Of the type that was given: the module returns 32-bit floats wherever they hold all numbers.
    positions = new (plan.constructor as Float64ArrayConstructor)(split.positions);
  }
  return {
    positions,
    indices,
    dimension: 2,
    ...(plane && { plane }),
    chains,
    constraintEdges,
    crossings,
    attributes: attributes.map((array) => interpolated(array, vertices, split)),
    deviation,
    leftOut,
  };
}

/** The numbers of an array with those of the new vertices. */
function interpolated(array: VertexArray, vertices: number, { between, at }: Split): VertexArray {
  const width = array.length / Math.max(vertices, 1);
  const isFloat = array instanceof Float32Array || array instanceof Float64Array;
  const all = new (array.constructor as Float64ArrayConstructor)(array.length + width * at.length);
  all.set(array);
  for (const [i, part] of at.entries()) {
    const [from, to] = [width * between[2 * i]!, width * between[2 * i + 1]!];
    for (let k = 0; k < width; k++) {
      const number = array[from + k]! + part * (array[to + k]! - array[from + k]!);
      all[array.length + width * i + k] = isFloat ? number : Math.round(number);
    }
  }
  return all;
}
