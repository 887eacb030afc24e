// The numbers of the paper, and which of them do not fit each other.

/** Table 2 as printed, and Table 3: seconds. */
export const MESHES = [
  { id: '1', vertices: 32, edges: 68, triangles: 102, iterations: 1, gpu: 0.0044, cpu: 0.0025, speedUp: 0.5619 },
  { id: '2', vertices: 1222, edges: 2448, triangles: 3672, iterations: 4, gpu: 0.022, cpu: 0.1833, speedUp: 8.3412 },
  {
    id: '3',
    vertices: 10002,
    edges: 30000,
    triangles: 20000,
    iterations: 5,
    gpu: 0.0584,
    cpu: 0.8993,
    speedUp: 15.3974,
  },
  {
    id: '4',
    vertices: 23490,
    edges: 70290,
    triangles: 40648,
    iterations: 1,
    gpu: 0.1405,
    cpu: 4.1937,
    speedUp: 29.8544,
  },
  {
    id: '5',
    vertices: 360002,
    edges: 1080000,
    triangles: 720000,
    iterations: 7,
    gpu: 1.3884,
    cpu: 55.678,
    speedUp: 40.1022,
  },
];

/** Half a unit of the last printed digit of the times. */
const ROUNDING = 0.00005;

/** V - E + T, and 2E - 3T: the boundary edges of a mesh in which no edge has more than two triangles. */
export function euler({ vertices, edges, triangles }) {
  return { characteristic: vertices - edges + triangles, boundary: 2 * edges - 3 * triangles };
}

/** The mesh with the columns of edges and triangles swapped. */
export const swapped = (mesh) => ({ ...mesh, edges: mesh.triangles, triangles: mesh.edges });

/**
 * What is wrong with the counts of a mesh of Table 2: `swapped` if only the swapped columns can be those of a mesh,
 * `open` if the mesh has a boundary, else `closed`. `fitting` has the counts in the order in which they fit.
 */
export function judged(mesh) {
  const { boundary } = euler(mesh);
  if (boundary < 0) return { kind: 'swapped', fitting: swapped(mesh) };
  return { kind: boundary > 0 ? 'open' : 'closed', fitting: mesh };
}

/** Whether the printed speed-up is the quotient of the printed times, which are rounded. */
export function speedUpFits({ cpu, gpu, speedUp }) {
  return (cpu - ROUNDING) / (gpu + ROUNDING) <= speedUp && speedUp <= (cpu + ROUNDING) / (gpu - ROUNDING);
}
