// Flips edges at random where the shape stays, so that the mesh keeps its points but has worse triangles.

const next = (h) => (h % 3 === 2 ? h - 2 : h + 1);
const prev = (h) => (h % 3 === 0 ? h + 2 : h - 1);
const subtract = (u, v) => u.map((x, k) => x - v[k]);
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
const dot = (u, v) => u.reduce((sum, x, k) => sum + x * v[k], 0);

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
  const point = (v) => [0, 1, 2].map((k) => (k < dimension ? positions[dimension * v + k] : 0));
  const key = (a, b) => `${a} ${b}`;
  // The half-edge from a to b.
  const halfEdges = new Map();
  triangles.forEach((a, h) => halfEdges.set(key(a, triangles[next(h)]), h));
  const normal = (a, b, c) => cross(subtract(point(b), point(a)), subtract(point(c), point(a)));
  const areClose = (u, v) => dot(u, v) > most * Math.sqrt(dot(u, u) * dot(v, v));
  const locked = new Set();
  for (let i = 0; i < lockedEdges.length; i += 2) locked.add(key(lockedEdges[i], lockedEdges[i + 1]));
  for (const t of Array.from(lockedTriangles)) {
    for (const h of [3 * t, 3 * t + 1, 3 * t + 2]) locked.add(key(triangles[h], triangles[next(h)]));
  }
  let state = seed;
  for (let left = flips, tries = 0; left > 0 && tries < 100 * flips; tries++) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    const h = Math.floor((state / 2 ** 32) * triangles.length);
    const [a, b, c] = [h, next(h), prev(h)].map((corner) => triangles[corner]);
    const g = halfEdges.get(key(b, a));
    if (g === undefined || locked.has(key(a, b)) || locked.has(key(b, a))) continue;
    if (groups && groups[(h - (h % 3)) / 3] !== groups[(g - (g % 3)) / 3]) continue;
    const d = triangles[prev(g)];
    if (halfEdges.has(key(c, d)) || halfEdges.has(key(d, c))) continue;
    const [old, first, second] = [normal(a, b, c), normal(a, d, c), normal(b, c, d)];
    if (!areClose(first, second) || !areClose(first, old) || !areClose(second, old)) continue;
    for (const pair of [key(a, b), key(b, a)]) halfEdges.delete(pair);
    [
      [h - (h % 3), [a, d, c]],
      [g - (g % 3), [b, c, d]],
    ].forEach(([t, corners]) => {
      triangles.set(corners, t);
      corners.forEach((from, k) => halfEdges.set(key(from, corners[(k + 1) % 3]), t + k));
    });
    left--;
  }
  return triangles;
}
