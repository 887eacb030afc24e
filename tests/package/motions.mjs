// Six motions of a mesh in the plane, in whole units so that every engine has the same places: two sheets of opposite
// winding, some of whose edges are locked. Every engine has to give the same triangles after every update.

import { sheet, UNITS } from './folds.mjs';

/** A whole number that goes from 0 to `end` and back. */
const wave = (n, end) => (n % (2 * end) < end ? n % (2 * end) : 2 * end - (n % (2 * end)));

/** Where a vertex of a sheet at rest is in a frame, in units. The others of the motions are jumps of each vertex. */
const PATHS = {
  // The vertex in the middle is dragged about, and out of the sheet.
  drag: ([x, y], frame, last, isMiddle) =>
    isMiddle ? [wave(53 * frame, last + 200) - 100, wave(31 * frame, last + 200) - 100] : [x, y],
  // Boundary and all.
  wave: ([x, y], frame) => [x + wave(3 * y + 40 * frame, 160) - 80, y + wave(5 * x + 56 * frame, 128) - 64],
  // A block moves through the others.
  stir: ([x, y], frame, last) =>
    [x, y].every((x) => 3 * x > last && 3 * x < 2 * last)
      ? [x + wave(40 * frame, last) - Math.floor(last / 2), y + wave(24 * frame, last) - Math.floor(last / 2)]
      : [x, y],
};

/** The most units of the jumps. */
const JUMPS = { tremble: 24, jump: 200, scatter: 1000 };

export const MOTIONS = [...Object.keys(JUMPS), ...Object.keys(PATHS)];

/** @returns The mesh of a motion, and a function that gives the positions of the next frame. */
export function motion(name, size) {
  const { mesh, jump } = sheet(size);
  const last = UNITS * (size - 1);
  // The second sheet is the mirror image of the first.
  const both = (one) => Float32Array.from([...one, ...one.map((x, i) => (i % 2 ? x : -x - 1))]);
  let frame = 0;
  const next = () => {
    frame++;
    if (name in JUMPS) return both(jump(JUMPS[name]));
    const one = mesh.positions.slice();
    for (let v = 0; v < size * size; v++) {
      const rest = [UNITS * (v % size), UNITS * Math.floor(v / size)];
      const to = PATHS[name](rest, frame, last, v === (size * size) >> 1);
      one.set(
        to.map((x) => x / UNITS),
        2 * v,
      );
    }
    return both(one);
  };
  const indices = Uint32Array.from([...mesh.indices, ...mesh.indices.map((v) => v + size * size)]);
  return { mesh: { positions: both(mesh.positions), indices, dimension: 2 }, next };
}

/** Iterations of an update. */
const iterationsOf = (frame) => [3, 0, 64, 1][frame % 4];

/**
 * Runs in a page or in Node: digests of triangles and changes, and the counts, after each update of each motion. The
 * motions run side by side, because in Firefox each wait for the GPU takes 100 ms.
 */
export async function frames({ entry, options, names = MOTIONS, size, count }) {
  const { FlipSession } = await import(entry);
  const { Digest } = await import(new URL('../parity/digest.js', import.meta.url).href);
  const run = async (name) => {
    const { mesh, next } = motion(name, size);
    const lockedEdges = mesh.indices.filter((_, i) => i % 93 < 2);
    const session = await FlipSession.create(mesh, { ...options, lockedEdges, trackChanges: true });
    const found = [];
    for (let frame = 0; frame < count; frame++) {
      session.update({ positions: next(), iterations: iterationsOf(frame) });
      const [counters, triangles, changes] = await Promise.all([
        session.counters(),
        session.triangles(),
        session.changes(),
      ]);
      found.push(`${new Digest(triangles)} ${new Digest(changes)} ${JSON.stringify(counters)}`);
    }
    session.free();
    return found;
  };
  const found = await Promise.all(names.map(run));
  return Object.fromEntries(names.map((name, i) => [name, found[i]]));
}

/** What the CPU gives in Node, on one thread, by the number of frames. */
const expected = new Map();

/** Checks an engine of a page against it. */
export async function moves(page, { title, backend }, count) {
  const motion = { size: 8, count };
  const onCpu = { entry: 'edgeflip', options: { backend: 'cpu', threads: 1 }, ...motion };
  if (!expected.has(count)) expected.set(count, frames(onCpu));
  const found = await page.evaluate(async (motion) => (await import('/tests/package/motions.mjs')).frames(motion), {
    entry: '/dist/index.js',
    options: { backend },
    ...motion,
  });
  await same(found, await expected.get(count), title);
}

/** Names the first frame that differs. */
export async function same(found, expected, title) {
  const { default: assert } = await import('node:assert/strict');
  for (const [name, frames] of Object.entries(expected)) {
    const frame = frames.findIndex((what, i) => what !== found[name][i]);
    assert.equal(found[name][frame], frames[frame], `${title}, ${name}, frame ${frame}`);
    assert.equal(found[name].length, frames.length);
  }
}
