// A sheet whose vertices jump across edges, in whole units so that tests/native/folds.rs has the same, and an exact test
// of what must come out.

/** Units from a vertex of the sheet at rest to the next. */
export const UNITS = 64;

/**
 * A square of `size` times `size` vertices, each cell with two triangles. Its boundary stays.
 *
 * @returns {{ mesh: { positions: Float32Array, indices: Uint32Array, dimension: 2 }, jump: (most: number) => Float32Array }}
 * `jump` moves each vertex inside by up to `most` units in both directions, unless another one is there.
 */
export function sheet(size) {
  const at = Array.from({ length: size * size }, (_, v) => [UNITS * (v % size), UNITS * Math.floor(v / size)]);
  const indices = [];
  for (let v = 0; v < size * (size - 1); v++) {
    if (v % size < size - 1) indices.push(v, v + 1, v + size + 1, v, v + size + 1, v + size);
  }
  const last = UNITS * (size - 1);
  const keyOf = ([x, y]) => x * (last + 1) + y;
  const taken = new Set(at.map(keyOf));
  let seed = 1;
  /** A whole number below `end`, from a linear congruential generator. */
  const below = (end) => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return (seed >>> 8) % end;
  };
  const positions = () => Float32Array.from(at.flat(), (x) => x / UNITS);
  const jump = (most) => {
    for (const [v, [x, y]] of at.entries()) {
      if (x % last === 0 || y % last === 0) continue;
      const place = [x, y].map((x) => Math.min(Math.max(x + below(2 * most + 1) - most, 1), last - 1));
      if (taken.has(keyOf(place))) continue;
      taken.delete(keyOf([x, y]));
      taken.add(keyOf(place));
      at[v] = place;
    }
    return positions();
  };
  return { mesh: { positions: positions(), indices: Uint32Array.from(indices), dimension: 2 }, jump };
}

/** Twice the area of a triangle, exactly. */
function area(positions, corners) {
  const [[ax, ay], [bx, by], [cx, cy]] = corners.map((v) => [0, 1].map((k) => UNITS * positions[2 * v + k]));
  return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
}

/** Whether `d` is in the circle of a counter-clockwise triangle, exactly. */
function isInCircle(positions, [a, b, c], d) {
  const point = (v) => [0, 1].map((k) => BigInt(UNITS * (positions[2 * v + k] - positions[2 * d + k])));
  const [p, q, r] = [a, b, c].map(point);
  const size = ([x, y]) => x * x + y * y;
  const cross = ([ax, ay], [bx, by]) => ax * by - ay * bx;
  return size(p) * cross(q, r) + size(q) * cross(r, p) + size(r) * cross(p, q) > 0n;
}

/** What is wrong with the triangles of a sheet: they have to be positive, and each edge Delaunay or locked. */
export function faultOf(positions, indices, locked = []) {
  const apexes = new Map();
  for (let t = 0; t < indices.length; t += 3) {
    const corners = [...indices.subarray(t, t + 3)];
    if (area(positions, corners) <= 0) return `triangle ${corners} is not positive`;
    for (let k = 0; k < 3; k++) apexes.set(`${corners[k]} ${corners[(k + 1) % 3]}`, corners[(k + 2) % 3]);
  }
  if (apexes.size !== indices.length) return 'two triangles have the same half-edge';
  for (const [edge, c] of apexes) {
    const [a, b] = edge.split(' ').map(Number);
    const d = apexes.get(`${b} ${a}`);
    const isLocked = locked.some(([u, v]) => (u === a && v === b) || (u === b && v === a));
    if (d !== undefined && !isLocked && isInCircle(positions, [a, b, c], d)) return `edge ${edge} is not Delaunay`;
  }
  return undefined;
}

/** Runs in a page: the triangles of a session on an engine after each motion of a sheet, with the locked edges lost. */
export async function triangulations({ backend, size, jumps }) {
  const { FlipSession } = await import('/dist/index.js');
  const { sheet } = await import('/tests/package/folds.mjs');
  const { mesh, jump } = sheet(size);
  const session = await FlipSession.create(mesh, { backend, lockedEdges: mesh.indices.filter((_, i) => i % 33 < 2) });
  const found = [];
  for (const [i, most] of jumps.entries()) {
    const positions = jump(most);
    if (i % 2) session.update({ positions, iterations: 3 });
    else await session.setPositions(positions);
    const { indices, inverted, flat, lostEdges } = await session.run();
    const { clean, violations } = await session.verify();
    found.push({ indices: [...indices], lostEdges: [...lostEdges], inverted, flat, clean, violations });
  }
  session.free();
  return found;
}

/** Checks that an engine untangles as the CPU does. */
export async function untangles(page, { title, backend }) {
  const { default: assert } = await import('node:assert/strict');
  const motion = { size: 9, jumps: [20, 90, 300] };
  const expected = await page.evaluate(triangulations, { backend: 'cpu', ...motion });
  assert.ok(expected.every(({ inverted, flat, clean }) => inverted + flat === 0 && clean));
  assert.ok(expected.some(({ lostEdges }) => lostEdges.length > 0));
  assert.deepEqual(await page.evaluate(triangulations, { backend, ...motion }), expected, title);
}
