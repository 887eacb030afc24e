// Compares a surface before and after flips, independently of the package. A surface has `positions` (3 numbers per
// vertex), `records` (a text per vertex: all its attributes), `uvs` (2 numbers per vertex, or none), `indices`, and
// `groups` (a number per triangle, or none).

import assert from 'node:assert/strict';

const point = ({ positions }, vertex) => [0, 1, 2].map((axis) => positions[3 * vertex + axis]);
const corners = ({ indices }, t) => [0, 1, 2].map((k) => indices[3 * t + k]);
const minus = (a, b) => a.map((x, i) => x - b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
const length = (a) => Math.sqrt(dot(a, a));

/** A text for a vertex: its position and attributes. */
const placeOf = (surface, vertex) =>
  point(surface, vertex)
    .map((x) => x + 0)
    .join();
const recordOf = (surface, vertex) => `${placeOf(surface, vertex)}|${surface.records[vertex]}`;

/**
 * How often each edge occurs in one direction more than in the other, in each group. Vertices with the same position
 * and attributes are the same. Flips change nothing here unless they move a border, a seam or a triangle's group.
 */
export function border(surface) {
  const net = new Map();
  for (let t = 0; t < surface.indices.length / 3; t++) {
    const names = corners(surface, t).map((vertex) => recordOf(surface, vertex));
    for (const [u, v] of [0, 1, 2].map((k) => [names[k], names[(k + 1) % 3]])) {
      const key = `${surface.groups?.[t] ?? 0}: ${[u, v].sort().join(' - ')}`;
      net.set(key, (net.get(key) ?? 0) + Math.sign(u.localeCompare(v)));
    }
  }
  return [...net].filter(([, count]) => count !== 0).sort(([a], [b]) => (a < b ? -1 : 1));
}

/** The edges between two triangles with the same attributes and group whose opposite angles exceed 180° together. */
export function badEdges(surface) {
  const edges = new Map();
  for (let t = 0; t < surface.indices.length / 3; t++) {
    const vertices = corners(surface, t);
    for (let k = 0; k < 3; k++) {
      const [u, v, w] = [0, 1, 2].map((i) => vertices[(k + i) % 3]);
      const key = `${surface.groups?.[t] ?? 0}: ${[recordOf(surface, u), recordOf(surface, v)].sort().join(' - ')}`;
      const [a, b] = [u, v].map((vertex) => minus(point(surface, vertex), point(surface, w)));
      const angle = Math.atan2(length(cross(a, b)), dot(a, b));
      edges.set(key, [...(edges.get(key) ?? []), angle]);
    }
  }
  return [...edges.values()].filter((angles) => angles.length === 2 && angles[0] + angles[1] > Math.PI + 1e-5).length;
}

/** Fails if anything but the triangles inside the borders has changed. */
export function same(before, after) {
  assert.deepEqual(after.positions, before.positions);
  assert.deepEqual(after.records, before.records);
  assert.equal(after.indices.length, before.indices.length);
  assert.deepEqual(border(after), border(before));
}

const normalOf = (surface, t) => {
  const [a, b, c] = corners(surface, t).map((vertex) => point(surface, vertex));
  return cross(minus(b, a), minus(c, a));
};

/** The weights of the corners at a point; `undefined` if it is not in the triangle, or the triangle faces another way. */
function weightsAt(surface, t, at, direction) {
  const normal = normalOf(surface, t);
  const size = length(normal);
  if (size === 0 || dot(normal, direction) < 0.999 * size * length(direction)) return undefined;
  const points = corners(surface, t).map((vertex) => point(surface, vertex));
  if (Math.abs(dot(minus(at, points[0]), normal)) > 1e-5 * size ** 1.5) return undefined;
  const weights = [0, 1, 2].map((k) => {
    const [p, q] = [points[(k + 1) % 3], points[(k + 2) % 3]];
    return dot(cross(minus(p, at), minus(q, at)), normal) / size ** 2;
  });
  return weights.every((weight) => weight > -1e-6) ? weights : undefined;
}

const uvAt = (surface, t, weights) =>
  [0, 1].map((axis) =>
    dot(
      weights,
      corners(surface, t).map((vertex) => surface.uvs[2 * vertex + axis]),
    ),
  );

/** Compares texture coordinates at points of flat parts, where the texture is not bent: one point per triangle. */
export function sameTexture(before, after, tolerance = 1e-4) {
  const count = before.indices.length / 3;
  for (let t = 0; t < count; t++) {
    const direction = normalOf(before, t);
    if (length(direction) === 0) continue;
    const weights = [0.5, 0.3, 0.2];
    const points = corners(before, t).map((vertex) => point(before, vertex));
    const at = [0, 1, 2].map((axis) =>
      dot(
        weights,
        points.map((p) => p[axis]),
      ),
    );
    const wanted = uvAt(before, t, weights);
    const found = [];
    for (let other = 0; other < count; other++) {
      if (before.groups && before.groups[t] !== after.groups[other]) continue;
      const there = weightsAt(after, other, at, direction);
      if (there) found.push(uvAt(after, other, there));
    }
    const isThere = found.some((uv) => uv.every((x, axis) => Math.abs(x - wanted[axis]) < tolerance));
    assert.ok(isThere, `triangle ${t}: texture ${wanted} became ${JSON.stringify(found)}`);
  }
}
