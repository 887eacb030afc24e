/** The type of a list of edges. */

/**
 * All edges, with one entry per edge in each array: the Edges array of Navarro, Hitschfeld-Kahler and Scheihing (2011).
 * `ta` and `tb` are half-edges, that is indices into the triangle indices: `indices[ta]` is `v1`, or a vertex at its
 * place with `weld`. The edge belongs to triangle `floor(ta / 3)`. Edges are in the order of `ta`, the smaller of both.
 */
export interface Edges {
  /** First vertex. */
  v1: Uint32Array;
  /** Second vertex. */
  v2: Uint32Array;
  /** The half-edge in the first triangle, from `v1` to `v2`. */
  ta: Uint32Array;
  /** The half-edge in the second triangle, from `v2` to `v1`; 0xffffffff on the boundary and on frozen edges. */
  tb: Uint32Array;
}
