// A small picture of a mesh: the edges of the triangles that face the viewer, as an SVG that serves as a mask.

const [WIDTH, HEIGHT, MARGIN] = [128, 108, 4];

/**
 * The picture as the text of an SVG file.
 *
 * @param {{ positions: ArrayLike<number>, indices: ArrayLike<number>, dimension: number }} mesh
 * @param {number} [pitch] - From how far above a surface is seen, in radians.
 */
export function wireframe({ positions, indices, dimension }, pitch = 0.28) {
  const points = Array.from({ length: positions.length / dimension }, (_, v) =>
    turned(
      [0, 1, 2].map((k) => (k < dimension ? positions[dimension * v + k] : 0)),
      dimension === 3 ? pitch : undefined,
    ),
  );
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
  const [left, right, top, bottom] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const scale = Math.min((WIDTH - 2 * MARGIN) / (right - left), (HEIGHT - 2 * MARGIN) / (bottom - top));
  const spot = (v) => [
    Math.round(WIDTH / 2 + scale * (points[v][0] - (left + right) / 2)),
    Math.round(HEIGHT / 2 + scale * (points[v][1] - (top + bottom) / 2)),
  ];
  const drawn = new Set();
  const parts = [];
  for (let t = 0; t < indices.length; t += 3) {
    const corners = [indices[t], indices[t + 1], indices[t + 2]];
    const [a, b, c] = corners.map((v) => points[v]);
    const facing = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    // The picture's y points down, so a triangle that faces the viewer is clockwise.
    if (dimension === 3 && facing >= 0) continue;
    corners.forEach((v, k) => {
      const [p, q] = [spot(v), spot(corners[(k + 1) % 3])];
      const key = [`${p}`, `${q}`].sort().join(' ');
      if (p.join() === q.join() || drawn.has(key)) return;
      drawn.add(key);
      parts.push(`M${p}l${q[0] - p[0]},${q[1] - p[1]}`);
    });
  }
  const path = `<path d="${parts.join('')}" fill="none" stroke="#000" stroke-width="1.2"/>`;
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${HEIGHT}">${path}</svg>`;
}

/** Seen from the right and from above, with y down as in a picture; without a pitch, a mesh in the plane. */
function turned([x, y, z], pitch) {
  if (pitch === undefined) return [x, -y];
  const yaw = -0.42;
  const [u, w] = [x * Math.cos(yaw) + z * Math.sin(yaw), z * Math.cos(yaw) - x * Math.sin(yaw)];
  return [u, -(y * Math.cos(pitch) - w * Math.sin(pitch))];
}
