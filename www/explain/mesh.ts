/** Tiny meshes in the plane, and what the engine says about them. */

import { EDGE_STATES, type EdgeState, FlipSession } from 'edgeflip';

/** A point of a figure, in the units of its drawing. */
export type Point = [x: number, y: number];

/** A mesh between two iterations. */
export interface Frame {
  triangles: Uint32Array;
  /** Of each half-edge, in the order of `triangles`. */
  states: EdgeState[];
  /** The triangle behind each half-edge; `undefined` on the boundary. */
  behind: (number | undefined)[];
}

/** An edge with its two ends, and the corners that face it: the ends of the other diagonal. */
export interface Edge {
  ends: [number, number];
  facing: number[];
  state: EdgeState;
}

/** The coordinates as the engine takes them. */
export const flat = (points: readonly Point[]) => Float64Array.from(points.flat());

/** Opens a session on the CPU engine. */
export function open(points: readonly Point[], triangles: readonly number[]): Promise<FlipSession> {
  const mesh = { positions: flat(points), indices: Uint32Array.from(triangles), dimension: 2 } as const;
  return FlipSession.create(mesh, { backend: 'cpu', threads: 1 });
}

/** What the engine says about the edges now. */
export async function statesOf(session: FlipSession): Promise<EdgeState[]> {
  return [...(await session.edgeStates())].map((state) => EDGE_STATES[state]!);
}

async function frameOf(session: FlipSession): Promise<Frame> {
  const triangles = await session.triangles();
  const behind = Array<number | undefined>(triangles.length).fill(undefined);
  const { ta, tb } = await session.edges();
  for (const [edge, half] of ta.entries()) {
    const twin = tb[edge]!;
    if (twin === 0xffffffff) continue;
    behind[half] = Math.floor(twin / 3);
    behind[twin] = Math.floor(half / 3);
  }
  return { triangles, states: await statesOf(session), behind };
}

/** Steps the engine through the mesh until no edge flips: the mesh at the start and after each iteration. */
export async function record(points: readonly Point[], triangles: readonly number[]): Promise<Frame[]> {
  const session = await open(points, triangles);
  const frames = [await frameOf(session)];
  while (await session.step()) frames.push(await frameOf(session));
  session.free();
  return frames;
}

/** The corners of each triangle. */
export function corners({ triangles }: Pick<Frame, 'triangles'>): [number, number, number][] {
  return Array.from({ length: triangles.length / 3 }, (_, t) => [
    triangles[3 * t]!,
    triangles[3 * t + 1]!,
    triangles[3 * t + 2]!,
  ]);
}

/** Each edge once. */
export function edgesOf(frame: Pick<Frame, 'triangles' | 'states'>): Edge[] {
  const edges = new Map<string, Edge>();
  for (const [t, triangle] of corners(frame).entries()) {
    for (const side of [0, 1, 2] as const) {
      const [from, to, facing] = [triangle[side], triangle[(side + 1) % 3]!, triangle[(side + 2) % 3]!];
      const known = edges.get(`${to} ${from}`);
      if (known) known.facing.push(facing);
      else edges.set(`${from} ${to}`, { ends: [from, to], facing: [facing], state: frame.states[3 * t + side]! });
    }
  }
  return [...edges.values()];
}

/** The edges that the next iteration flips. */
export const flipping = (frame: Frame) => edgesOf(frame).filter(({ state }) => state === 'flips');
