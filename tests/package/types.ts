// Compiled, never run: what a strict TypeScript program sees of the package.

import { EDGE_STATES, EdgeflipError, type EdgeState, type ErrorCode, FlipSession, type Iteration, init, makeDelaunay, type Mesh } from 'edgeflip';

export async function use(mesh: Mesh, signal: AbortSignal, device?: GPUDevice): Promise<Uint32Array> {
  await init(new URL('https://example.org/edgeflip.wasm'));
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
  const gpu = await session.gpu();
  const buffer: GPUBuffer | undefined = gpu?.indices;
  console.log(buffer?.size);
  const states: EdgeState[] = Array.from(await session.edgeStates(), (number) => EDGE_STATES[number] ?? 'boundary');
  console.log(states);
  await session.setPositions(new Float64Array(9));
  session.free();
  return result.indices;
}

export function codeOf(error: unknown): ErrorCode | undefined {
  return error instanceof EdgeflipError ? error.code : undefined;
}

// @ts-expect-error: there is no such backend
void makeDelaunay({ positions: new Float32Array(), indices: new Uint16Array(), dimension: 2 }, { backend: 'gpu' });
// @ts-expect-error: a plain array is no typed array
void makeDelaunay({ positions: [0, 0], indices: new Uint16Array(), dimension: 2 });
