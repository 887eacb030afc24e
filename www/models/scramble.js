// Flips edges at random where the shape stays, so that the mesh keeps its points but has worse triangles.

const next = (h) => (h % 3 === 2 ? h - 2 : h + 1);
const prev = (h) => (h % 3 === 0 ? h + 2 : h - 1);

/**
 * The triangles after `flips` flips. Locked edges stay, and so do edges between groups.
 *
 * @param {{ dimension?: number, positions: ArrayLike<number>, indices: ArrayLike<number>,
 *   groups?: ArrayLike<number> | undefined, lockedEdges?: ArrayLike<number> | undefined,
 *   lockedTriangles?: ArrayLike<number> | undefined }} mesh
 * @param {number} flips
 * @param {number} degrees - How much the normals of two neighbours may differ after a flip.
 * @param {number} seed
 * @returns {Uint32Array<ArrayBuffer>}
 */
export function scrambled(mesh, flips, degrees, seed) {
  const { dimension = 3, positions, indices, groups, lockedEdges = [], lockedTriangles = [] } = mesh;
  const triangles = Uint32Array.from(indices);
  const most = Math.cos((degrees * Math.PI) / 180);
  const vertices = positions.length / dimension;
  const key = (a, b) => a * vertices + b;
  // The half-edge from a to b.
  const halfEdges = new Map();
  triangles.forEach((a, h) => halfEdges.set(key(a, triangles[next(h)]), h));
  const at = (v, k) => (k < dimension ? positions[dimension * v + k] : 0);
  const normal = (a, b, c) => {
    const [ux, uy, uz] = [at(b, 0) - at(a, 0), at(b, 1) - at(a, 1), at(b, 2) - at(a, 2)];
    const [vx, vy, vz] = [at(c, 0) - at(a, 0), at(c, 1) - at(a, 1), at(c, 2) - at(a, 2)];
    return [uy * vz - vy * uz, vx * uz - ux * vz, ux * vy - vx * uy];
  };
  const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const areClose = (u, v) => dot(u, v) > most * Math.sqrt(dot(u, u) * dot(v, v));
  const locked = new Set();
  for (let i = 0; i < lockedEdges.length; i += 2) locked.add(key(lockedEdges[i], lockedEdges[i + 1]));
  for (const t of Array.from(lockedTriangles)) {
    for (const h of [3 * t, 3 * t + 1, 3 * t + 2]) locked.add(key(triangles[h], triangles[next(h)]));
  }
  const setTriangle = (t, a, b, c) => {
    triangles.set([a, b, c], t);
    halfEdges
      .set(key(a, b), t)
      .set(key(b, c), t + 1)
      .set(key(c, a), t + 2);
  };
  let state = seed;
  for (let left = flips, tries = 0; left > 0 && tries < 100 * flips; tries++) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    const h = Math.floor((state / 2 ** 32) * triangles.length);
    const [a, b, c] = [triangles[h], triangles[next(h)], triangles[prev(h)]];
    const g = halfEdges.get(key(b, a));
    if (g === undefined || locked.has(key(a, b)) || locked.has(key(b, a))) continue;
    if (groups && groups[(h - (h % 3)) / 3] !== groups[(g - (g % 3)) / 3]) continue;
    const d = triangles[prev(g)];
    if (halfEdges.has(key(c, d)) || halfEdges.has(key(d, c))) continue;
    const [old, first, second] = [normal(a, b, c), normal(a, d, c), normal(b, c, d)];
    if (!areClose(first, second) || !areClose(first, old) || !areClose(second, old)) continue;
    halfEdges.delete(key(a, b));
    halfEdges.delete(key(b, a));
    setTriangle(h - (h % 3), a, d, c);
    setTriangle(g - (g % 3), b, c, d);
    left--;
  }
  return triangles;
}
