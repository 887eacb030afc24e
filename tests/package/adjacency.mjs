// The adjacency in the buffers of a session, counted independently. `adjacency.browser.test.mjs` runs it in browsers.

const NONE = 0xffffffff;
const next = (h) => (h % 3 === 2 ? h - 2 : h + 1);
const prev = (h) => (h % 3 === 0 ? h + 2 : h - 1);

/** The twins of triangles, by a list of the half-edges of each edge. */
function twinsOf(indices) {
  const edges = new Map();
  indices.forEach((start, h) => {
    const edge = [start, indices[next(h)]].sort((a, b) => a - b).join();
    edges.set(edge, [...(edges.get(edge) ?? []), h]);
  });
  const twins = indices.map(() => NONE);
  for (const [h, g, ...others] of edges.values()) {
    if (g === undefined || others.length > 0 || indices[h] === indices[g]) continue;
    if (Math.floor(h / 3) === Math.floor(g / 3)) continue;
    [twins[h], twins[g]] = [g, h];
  }
  return twins;
}

/** Throws unless both lists are those of the triangles. Returns how many vertices have one fan, how many several. */
function check(indices, twins, starts) {
  const differs = twinsOf(indices).findIndex((twin, h) => twin !== twins[h]);
  if (differs >= 0) throw new Error(`half-edge ${differs} has the twin ${twins[differs]}`);
  const corners = Array.from(starts, () => []);
  indices.forEach((vertex, h) => void corners[vertex].push(h));
  const kinds = [0, 0];
  starts.forEach((start, vertex) => {
    const border = corners[vertex].find((h) => twins[h] === NONE);
    const expected = border ?? corners[vertex][0] ?? NONE;
    if (start !== expected) throw new Error(`vertex ${vertex} has half-edge ${start} instead of ${expected}`);
    if (start === NONE) return;
    const walked = [];
    for (let h = start; h !== NONE && !walked.includes(h); h = twins[prev(h)]) walked.push(h);
    if (walked.some((h) => indices[h] !== vertex)) throw new Error(`the walk leaves vertex ${vertex}`);
    // Each open fan begins at a border, so a vertex with one fan has at most one.
    const borders = corners[vertex].filter((h) => twins[h] === NONE).length;
    const isWhole = walked.length === corners[vertex].length;
    if (isWhole && borders > 1) throw new Error(`the walk around vertex ${vertex} passes a border`);
    kinds[isWhole ? 0 : 1]++;
  });
  return kinds;
}

/** The words of a buffer. */
async function read(device, buffer, count) {
  const { size } = buffer;
  const staging = device.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  const encoder = device.createCommandEncoder();
  encoder.copyBufferToBuffer(buffer, 0, staging, 0, size);
  device.queue.submit([encoder.finish()]);
  await staging.mapAsync(GPUMapMode.READ);
  const words = new Uint32Array(staging.getMappedRange()).slice(0, count);
  staging.destroy();
  return words;
}

/** Meshes of each kind: with holes, isolated vertices, several components and fans, edges of three triangles. */
async function meshes(generate) {
  const sheet = await generate('shuffled random 9');
  const holes = sheet.indices.filter((_, i) => Math.floor(i / 3) % 25 !== 7);
  const count = sheet.positions.length / 2;
  // The second sheet has the other orientation, and a vertex of the first one.
  const turned = [...sheet.indices].map((_, i, all) => all[i - (i % 3) + [0, 2, 1][i % 3]]);
  const joined = turned.map((vertex) => (vertex === 0 ? 5 : vertex + count));
  const beside = sheet.positions.map((x, i) => (i % 2 ? x : x + 2));
  const ball = await generate('uvsphere 8');
  const [a, b] = ball.indices.subarray(30);
  return {
    holes: { positions: Float32Array.of(...sheet.positions, 4, 4, -1, 2), indices: holes, dimension: 2 },
    components: {
      positions: Float32Array.of(...sheet.positions, ...beside),
      indices: Uint32Array.of(...sheet.indices, ...joined),
      dimension: 2,
    },
    fin: {
      positions: Float32Array.of(...ball.positions, 2, 2, 0),
      indices: Uint32Array.of(...ball.indices, a, b, ball.positions.length / 3),
      dimension: 3,
    },
  };
}

/** Moves the meshes, and checks the buffers after each call. Returns the flips and the kinds of vertices. */
export async function walks({ FlipSession, generate, frames }) {
  const answer = {};
  for (const [name, mesh] of Object.entries(await meshes(generate))) {
    const { positions, dimension } = mesh;
    const lockedEdges = mesh.indices.slice(0, 2);
    const options = { backend: 'webgpu', adjacency: true, maxNormalAngle: 60, lockedEdges };
    const session = await FlipSession.create(mesh, options);
    const vertices = positions.length / dimension;
    const checked = async () => {
      const indices = await session.triangles();
      const { device, twins, vertexHalfEdges } = await session.gpu();
      return check(indices, await read(device, twins, indices.length), await read(device, vertexHalfEdges, vertices));
    };
    await checked();
    await session.run();
    const kinds = await checked();
    for (let frame = 0; frame < frames; frame++) {
      const moved = positions.map((x, i) => {
        const axis = i % dimension;
        return axis === 2 ? x : x + 0.3 * Math.sin(7 * positions[i + 1 - 2 * axis] + 0.5 * frame + axis);
      });
      session.update({ positions: moved, iterations: frame % 4 });
      if (`${await checked()}` !== `${kinds}`) throw new Error(`${name}: other kinds of vertices`);
    }
    const { flips } = await session.counters();
    // The positions have folds: other triangles replace them.
    await session.setPositions(positions);
    await checked();
    answer[name] = { flips, kinds };
    session.free();
  }
  return answer;
}
