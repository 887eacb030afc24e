// Compiled, never run: uses the types of the package in strict TypeScript.

import {
  EDGE_STATES,
  EdgeflipError,
  type EdgeState,
  type ErrorCode,
  FlipSession,
  type GpuBuffer,
  type GpuDevice,
  type Iteration,
  init,
  makeDelaunay,
  makeDelaunaySync,
  type Mesh,
  type Sources,
  type SyncOptions,
} from 'edgeflip';
import {
  type Angles,
  angles,
  type FileMesh,
  FORMATS,
  generate,
  init as initFiles,
  type Original,
  readMesh,
  type Welded,
  weld,
  writeMesh,
} from 'edgeflip/files';
import {
  init as initPoints,
  type PointsSources,
  type Spacing,
  type Threading,
  type Triangulation,
  triangulate,
  triangulateSync,
  type Voronoi,
  voronoi,
  voronoiSync,
} from 'edgeflip/points';
import { FlipSession as AwaySession, makeDelaunay as makeAway, type WorkerOptions } from 'edgeflip/worker';

export async function use(mesh: Mesh<Uint32Array>, signal: AbortSignal, device?: GpuDevice): Promise<Uint32Array> {
  await init({ base: new URL('https://example.org/wasm') });
  const sources: Sources = {
    core: new URL('https://example.org/edgeflip.wasm'),
    webgl2: new Uint8Array(8),
    files: undefined,
  };
  await init(sources);
  const iterations: Iteration[] = [];
  const result = await makeDelaunay(mesh, {
    backend: 'auto',
    maxNormalAngle: 10,
    signal,
    onIteration: (iteration) => iterations.push(iteration),
  });
  const left: number = result.remaining.angle ?? 0;
  const status: 'done' | 'stopped' = result.status;
  const session = await FlipSession.create({ ...mesh, positions: new Float64Array(9) }, { order: 'any', device });
  for await (const { flips, blocked } of session) console.log(flips, blocked.fold, left, status);
  const lockedEdges: readonly number[] = [0, 1];
  console.log((await makeDelaunay(mesh, { lockedEdges })).remaining.locked);
  const lostEdges: Uint32Array = (await makeDelaunay(mesh, { untangle: true })).lostEdges;
  console.log(lostEdges.length);
  const gpu = await session.gpu();
  const buffer: GpuBuffer | undefined = gpu?.indices;
  const around: GpuBuffer | undefined = gpu?.vertexHalfEdges;
  console.log(buffer, around);
  const states: EdgeState[] = Array.from(await session.edgeStates(), (number) => EDGE_STATES[number] ?? 'boundary');
  console.log(states);
  const { remainingEdges } = await session.verify();
  const lines: Uint32Array = remainingEdges.angle ?? new Uint32Array();
  console.log(lines);
  await session.setPositions(new Float64Array(9));
  session.free();
  return result.indices;
}

export async function copy(file: File): Promise<Blob> {
  await initFiles({ files: new URL('https://example.org/edgeflip_files.wasm') });
  const format: '.off' | '.obj' | '.ply' | '.stl' | '.gltf' | '.glb' | undefined = FORMATS.find((format) =>
    file.name.endsWith(format),
  );
  const mesh: FileMesh = await readMesh(new Uint8Array(await file.arrayBuffer()), file.name, { dimension: 3 });
  const positions: Float32Array = (await generate('uvsphere 20')).positions;
  const { min, counts }: Angles = await angles({ ...mesh, positions }, 18);
  console.log(mesh.polygons, mesh.dropped.join(), min, counts.length, (await makeDelaunay(mesh)).status);
  const { groups, lockedEdges, lockedTriangles } = mesh;
  const { indices } = await makeDelaunay(mesh, { groups, lockedEdges, lockedTriangles });
  const original = { bytes: new Uint8Array(await file.arrayBuffer()), name: file.name };
  if (mesh.keeps) return new Blob([await writeMesh({ ...mesh, indices }, file.name, { original })]);
  return new Blob([await writeMesh(mesh, `copy${format ?? '.off'}`)]);
}

/** Indices have the type that came in. */
export async function types(mesh: Mesh): Promise<number[]> {
  const short: Uint16Array = (await makeDelaunay({ ...mesh, indices: new Uint16Array(3) })).indices;
  const frozen: readonly number[] = [0, 0.5, 1];
  const list: number[] = (await makeDelaunay({ ...mesh, positions: frozen, indices: [0, 1, 2] })).indices;
  const session: FlipSession<Uint8Array> = await FlipSession.create({ ...mesh, indices: new Uint8Array(3) });
  const bytes: Uint8Array = await session.triangles();
  const quantized: Mesh = { positions: new Int16Array(24), stride: 4, offset: 1, indices: short, dimension: 3 };
  const { hint, threads } = await makeDelaunay(quantized, {
    lockedEdges: new Uint16Array(2),
    groups: new Uint8Array(1),
  });
  console.log(hint?.length, threads + 1);
  return [...list, ...bytes];
}

/** In a worker, and without waiting. */
export async function elsewhere(mesh: Mesh<Uint16Array>, signal: AbortSignal): Promise<Uint16Array> {
  const options: SyncOptions = { maxIterations: 3, lockedTriangles: [0] };
  const now: Uint16Array = makeDelaunaySync(mesh, options).indices;
  const { threads } = await makeAway(mesh, { ...options, signal, onProgress: ({ flips }) => console.log(flips, now) });
  const away: WorkerOptions = { backend: 'webgpu', weld: true };
  const session: AwaySession<Uint16Array> = await AwaySession.create(mesh, away);
  for await (const { index } of session) console.log(index, threads, (await session.verify()).clean);
  return session.triangles();
}

export async function joined(mesh: Mesh<Uint32Array>, original: Original): Promise<Uint32Array> {
  const { seamEdges } = await makeDelaunay(mesh, { weld: [new Float32Array(8), new Uint8Array(4)] });
  const { joinedVertices } = await makeDelaunay(mesh, { weld: original, reorient: true });
  const welded: Welded = await weld(mesh);
  console.log(seamEdges + joinedVertices, (await makeDelaunay(mesh, { weld: true })).flips);
  return welded.split(welded.indices);
}

/** Points in every form. */
export async function triangulated(places: readonly { lon: number; lat: number }[]): Promise<Uint32Array> {
  const sources: PointsSources = {
    base: '/wasm',
    points: new URL('https://example.org/edgeflip_points.wasm'),
    threads: 'https://example.org/edgeflip_points_threads.wasm',
  };
  await initPoints(sources);
  const byPlace = { x: (place: { lon: number }) => place.lon, y: (place: { lat: number }) => place.lat };
  const all: Triangulation[] = [
    await triangulate(places, { x: ({ lon }) => lon, y: ({ lat }, index) => lat + index }),
    await triangulate(places, byPlace),
    triangulateSync(places, byPlace),
    await triangulate(new Float32Array(6)),
    triangulateSync(new Int16Array(9), { stride: 3 }),
    triangulateSync([0, 0, 1, 0, 0, 1], { stride: undefined }),
    await triangulate([
      [0, 0],
      [1, 0],
    ]),
    await triangulate([[0, 0]], { threads: 2 }),
    await triangulate(places, { ...byPlace, threads: undefined }),
    triangulateSync([new Float32Array(2), [1, 0, 7]] as const),
    triangulateSync(new Uint32Array(3), { x: (id) => 2 * id, y: (id) => id * id }),
  ];
  const spacing: Spacing = { stride: 4, offset: 1 };
  const threading: Threading = { threads: 4 };
  const { triangles, twins, hull, duplicates, threads, hint } = await triangulate(new Float64Array(8), {
    ...spacing,
    ...threading,
  });
  const why: string | undefined = hint && `${hint} ${threads.toFixed()}`;
  const { flips } = await makeDelaunay({ positions: new Float64Array(8), indices: triangles, dimension: 2 });
  console.log(all.length, why, flips, twins.length + hull.length + duplicates.length);
  return triangles;
}

/** Cells of points in every form. */
export async function celled(places: readonly { lon: number; lat: number }[]): Promise<Float64Array> {
  const byPlace = { x: ({ lon }: { lon: number }) => lon, y: ({ lat }: { lat: number }) => lat };
  const triangulation = await triangulate(places, byPlace);
  const arrays = { triangles: [0, 1, 2], twins: new Int32Array(3), hull: new Uint8Array(3), duplicates: [] };
  const all: Voronoi[] = [
    await voronoi(places, triangulation, { ...byPlace, bounds: [-180, -90, 180, 90] }),
    voronoiSync(places, triangulation, byPlace),
    await voronoi(new Float32Array(6), arrays),
    voronoiSync(new Int16Array(9), arrays, { stride: 3, bounds: new Float64Array(4) }),
    voronoiSync([0, 0, 1, 0, 0, 1], arrays, { bounds: undefined }),
    await voronoi([[0, 0], new Float32Array(2)] as const, arrays, { bounds: [0, 0, 1, 1] as const }),
  ];
  const { circumcentres, starts, corners } = all[0]!;
  const [start, end]: (number | undefined)[] = [...starts];
  console.log(circumcentres.length, all.length);
  return corners.subarray(start, end);
}

export function codeOf(error: unknown): ErrorCode | undefined {
  return error instanceof EdgeflipError ? error.code : undefined;
}

// @ts-expect-error: there is no such backend
void makeDelaunay({ positions: new Float32Array(), indices: new Uint16Array(), dimension: 2 }, { backend: 'gpu' });
// @ts-expect-error: nothing waits for another module
void makeDelaunaySync({ positions: new Float32Array(), indices: new Uint16Array(), dimension: 2 }, { weld: true });
// @ts-expect-error: a device cannot be sent to a worker
void makeAway({ positions: new Float32Array(), indices: new Uint16Array(), dimension: 2 }, { device: undefined });
// @ts-expect-error: a source has the name of its module
void init('https://example.org/edgeflip.wasm');
// @ts-expect-error: this entry has one module
void initFiles({ core: 'https://example.org/edgeflip.wasm' });
// @ts-expect-error: there is no such option
void makeDelaunay({ positions: new Float32Array(), indices: new Uint16Array(), dimension: 2 }, { maxNormalAngel: 10 });
// @ts-expect-error: a string is not bytes
void readMesh('OFF', 'a.off');
// @ts-expect-error: texts are not numbers
void makeDelaunay({ positions: ['0', '0'], indices: new Uint16Array(), dimension: 2 });
// @ts-expect-error: attributes are typed arrays, whose bits are compared
void makeDelaunay({ positions: new Float32Array(), indices: new Uint16Array(), dimension: 2 }, { weld: [[0.5, 1]] });
// @ts-expect-error: points that are not pairs need both functions
void triangulate([{ lon: 0, lat: 0 }], { x: ({ lon }: { lon: number }) => lon });
// @ts-expect-error: points that are not pairs need functions
void triangulate([{ x: 0, y: 0 }]);
// @ts-expect-error: the functions return numbers
void triangulateSync([{ lon: '0' }], { x: ({ lon }) => lon, y: () => 0 });
// @ts-expect-error: a stride is for an array of numbers
void triangulate([[0, 0]], { stride: 3 });
// @ts-expect-error: a diagram needs the triangulation
void voronoi([[0, 0]], { bounds: [0, 0, 1, 1] });
// @ts-expect-error: a box is four numbers
void voronoi([[0, 0]], triangulateSync([[0, 0]]), { bounds: '0 0 1 1' });
// @ts-expect-error: a call without a promise has one thread
void triangulateSync([[0, 0]], { threads: 2 });
// @ts-expect-error: this entry has no module of engines
void initPoints({ core: 'https://example.org/edgeflip.wasm' });
// @ts-expect-error: the entry `edgeflip` does not load the module of the points
void init({ points: 'https://example.org/edgeflip_points.wasm' });
