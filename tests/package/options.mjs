// A test case for each option, for any engine. `options.test.mjs` runs them on the module of the engines and on that of
// the threads, `options.browser.test.mjs` on that of the WebGL2 engine. A case throws if a value other than the default
// has no effect, or if a wrong value gives no error.

/** @typedef {{ makeDelaunay: Function, FlipSession: any, mesh: object, base: object, plain: object }} Given */

function check(condition, what) {
  if (!condition) throw new Error(what);
}

/** Checks that the library refuses a value with an error that names the option. */
async function isRefused({ makeDelaunay, mesh, base }, name, value) {
  const { code, message } = await makeDelaunay(mesh, { ...base, [name]: value }).catch((error) => error);
  check(
    code === 'invalid-option' && message.startsWith(`option ${name}: `),
    `${name}: ${value} is not refused: ${code}: ${message}`,
  );
}

/** Checks that a threshold leaves other edges than the default, and that the audit uses it too. */
async function isThreshold({ FlipSession, mesh, base, plain }, name, value) {
  const session = await FlipSession.create(mesh, { ...base, [name]: value });
  const { flips, remaining } = await session.run();
  const audit = await session.verify();
  session.free();
  check(flips !== plain.flips, `${name} has no effect`);
  check(
    audit.clean && JSON.stringify(audit.remaining) === JSON.stringify(remaining),
    `${name}: the audit does not know it: ${audit.violations[0]}`,
  );
  return { flips, remaining };
}

/** Checks that all edges are locked. */
async function locksAll({ makeDelaunay, mesh, base }, options) {
  const { flips, remaining } = await makeDelaunay(mesh, { ...base, ...options });
  check(flips === 0 && remaining.locked > 0, `${Object.keys(options)} does not lock`);
  return { flips, remaining };
}

/** A square with the diagonal 0-2. */
const SQUARE = { positions: new Float32Array([0, 0, 1, 0, 1, 1, 0, 1]), indices: [0, 1, 2, 0, 2, 3], dimension: 2 };

const corners = ({ indices }) => Array.from({ length: indices.length / 3 }, (_, t) => t);

/**
 * The cases by option. A case returns the same on all engines.
 *
 * @type {Record<string, (given: Given) => Promise<unknown>>}
 */
export const cases = {
  backend: async ({ makeDelaunay, mesh, base }) => {
    const { backend, fallback } = await makeDelaunay(mesh, base);
    check(backend === base.backend && fallback === undefined, `it ran on ${backend}: ${fallback}`);
  },
  maxNormalAngle: async (given) => {
    await isRefused(given, 'maxNormalAngle', 181);
    return isThreshold(given, 'maxNormalAngle', 1);
  },
  maxDeviation: async (given) => {
    await isRefused(given, 'maxDeviation', -1);
    return isThreshold(given, 'maxDeviation', 0);
  },
  maxIterations: async ({ makeDelaunay, mesh, base }) => {
    const { iterations, status, flips } = await makeDelaunay(mesh, { ...base, maxIterations: 1 });
    check(iterations === 1 && status === 'stopped', `${iterations} iterations, ${status}`);
    return flips;
  },
  lockedEdges: (given) => {
    const { indices } = given.mesh;
    const edges = corners(given.mesh).flatMap((t) => [0, 1, 1, 2, 2, 0].map((i) => indices[3 * t + i]));
    return locksAll(given, { lockedEdges: Uint32Array.from(edges) });
  },
  lockedTriangles: (given) => locksAll(given, { lockedTriangles: corners(given.mesh) }),
  groups: (given) => locksAll(given, { groups: corners(given.mesh) }),
  constraints: async (given) => {
    await isRefused(given, 'constraints', [0, 1]);
    const { crossedEdges, leftOut } = await given.makeDelaunay(SQUARE, { ...given.base, constraints: [1, 3] });
    check(crossedEdges === 1 && leftOut.length === 0, `${crossedEdges} edges crossed, ${leftOut.length} left out`);
  },
  constraintTolerance: async (given) => {
    const options = { ...given.base, constraints: [0, 2] };
    await isRefused({ ...given, mesh: SQUARE, base: options }, 'constraintTolerance', -1);
    const { constraintEdges, constraintDeviation } = await given.makeDelaunay(SQUARE, {
      ...options,
      constraintTolerance: 0.8,
    });
    // From right to left through the two vertices beside its middle.
    const isNear = Math.abs(constraintDeviation - Math.SQRT1_2) < 1e-15;
    check(constraintEdges.join() === '0,1,1,3,3,2' && isNear, `${constraintEdges.join()}, ${constraintDeviation}`);
  },
  skipConstraints: async (given) => {
    const options = { ...given.base, constraints: [1, 3, 2, 0] };
    await isRefused({ ...given, mesh: SQUARE }, 'constraints', options.constraints);
    const { leftOut } = await given.makeDelaunay(SQUARE, { ...options, skipConstraints: true });
    const found = leftOut.map(({ index, reason }) => `${index}: ${reason}`);
    check(
      found.join() === '1: constraint 1 between 2 and 0 crosses constraint 0 between 1 and 3',
      `left out: ${found}`,
    );
  },
  untangle: async (given) => {
    // The vertex at (3, 2) is on the other side of the edge from the vertex at (1, 1) to the corner at (0, 0).
    const folded = {
      positions: new Float32Array([0, 0, 4, 0, 4, 4, 0, 4, 1, 1, 3, 2]),
      indices: [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 5, 0, 4, 5, 4, 3, 5],
      dimension: 2,
    };
    const { inverted } = await given.makeDelaunay(folded, given.base);
    check(inverted > 0, 'nothing is turned over');
    const made = await given.makeDelaunay(folded, { ...given.base, untangle: true });
    check(made.inverted === 0 && made.lostEdges.length === 0, `${made.inverted} triangles are turned over`);
    await isRefused(given, 'untangle', true);
    return [...made.indices];
  },
  reorient: async ({ makeDelaunay, mesh, base }) => {
    const indices = mesh.indices.slice();
    [indices[0], indices[1]] = [indices[1], indices[0]];
    const { turnedTriangles } = await makeDelaunay({ ...mesh, indices }, { ...base, reorient: true });
    check(turnedTriangles === 1, `${turnedTriangles} triangles were turned`);
  },
  weld: async ({ makeDelaunay, mesh, base, plain }) => {
    const positions = Float32Array.from(
      [...mesh.indices].flatMap((vertex) => [...mesh.positions.subarray(3 * vertex, 3 * vertex + 3)]),
    );
    const indices = mesh.indices.map((_, i) => i);
    const { joinedVertices, flips } = await makeDelaunay({ positions, indices, dimension: 3 }, { ...base, weld: true });
    check(joinedVertices === indices.length - mesh.positions.length / 3, `${joinedVertices} vertices were joined`);
    check(flips > 0 && plain.flips > 0, 'nothing flips');
  },
  trackChanges: async ({ FlipSession, mesh, base }) => {
    const session = await FlipSession.create(mesh, { ...base, trackChanges: true });
    session.update({ iterations: 1 });
    const changes = await session.changes();
    session.free();
    check(changes.includes(0) && changes.includes(1), `trackChanges has no effect: ${changes.slice(0, 9)}`);
  },
  // Only WebGPU has the buffers: `adjacency.browser.test.mjs` tests them.
  adjacency: (given) => isRefused(given, 'adjacency', 1),
  order: async ({ makeDelaunay, mesh, base }) => {
    if (base.backend !== 'cpu') return isRefused({ makeDelaunay, mesh, base }, 'order', 'any');
    const { iterations, flips } = await makeDelaunay(mesh, { ...base, order: 'any' });
    check(iterations === 1 && flips > 0, `${iterations} iterations`);
  },
  // `options.test.mjs` counts the workers.
  threads: (given) => isRefused(given, 'threads', 257),
  // Only a browser has a GPUDevice, and only WebGPU uses it: `loss.browser.test.mjs` tests it.
  device: (given) => isRefused(given, 'device', {}),
};
