/** The meshes that move: what each is made of, and where its vertices are at a moment. */

export type Kind = 'sheet' | 'waves' | 'relax';
export type Point = [x: number, y: number, z: number];

/** Half of the side of a square. */
export const HALF = 0.7;

export interface Motion {
  dimension: 2 | 3;
  /** The crease limit in degrees. */
  beta: number;
  /** The family and the size of a mesh with about so many triangles. */
  spec(triangles: number): string;
  /** The half sides of a box around the moving mesh. */
  box: Point;
  /** Where a vertex of the family begins. */
  start(vertex: Point): Point;
  /**
   * Where a vertex is after so many seconds, from where it began. Absent if each frame moves the vertices on from where
   * they are, towards an even mesh.
   */
  pose?(start: Point, seconds: number): Point;
  /** The same as WGSL, a body of `fn pose(start: vec3f, seconds: f32) -> vec3f`. */
  wgsl?: string;
}

const square = ([x, y]: Point): Point => [HALF * (2 * x - 1), HALF * (2 * y - 1), 0];
const half = (triangles: number) => Math.max(2, Math.round(Math.sqrt(triangles / 2)));

export const MOTIONS: Record<Kind, Motion> = {
  sheet: {
    dimension: 2,
    beta: 10,
    spec: (triangles) => `random ${half(triangles)}`,
    box: [1.3 * HALF, HALF, 0],
    start: square,
    pose([x, y], seconds) {
      const angle = 2.5 * Math.sin(0.7 * seconds) * Math.exp(-8 * (x * x + y * y));
      const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
      const up = sin * x + cos * y;
      return [cos * x - sin * y + 0.4 * Math.sin(0.45 * seconds) * up, up, 0];
    },
    wgsl: `
      let angle = 2.5 * sin(0.7 * seconds) * exp(-8 * dot(start.xy, start.xy));
      let up = sin(angle) * start.x + cos(angle) * start.y;
      return vec3f(cos(angle) * start.x - sin(angle) * start.y + 0.4 * sin(0.45 * seconds) * up, up, 0);`,
  },
  waves: {
    dimension: 3,
    beta: 30,
    spec: (triangles) => `uvsphere ${half(triangles)}`,
    box: [1.2 * HALF, 1.1 * HALF, 1.2 * HALF],
    // The poles are above and below.
    start: ([x, y, z]) => [HALF * y, HALF * z, HALF * x],
    pose([x, y, z], seconds) {
      const height = y / HALF;
      const wide = 1 + 0.25 * Math.sin(6 * height + 2 * seconds) * (1 - height * height);
      return [wide * x, y * (1 + 0.1 * Math.sin(seconds)), wide * z];
    },
    wgsl: `
      let height = start.y / ${HALF};
      let wide = 1 + 0.25 * sin(6 * height + 2 * seconds) * (1 - height * height);
      return vec3f(wide * start.x, start.y * (1 + 0.1 * sin(seconds)), wide * start.z);`,
  },
  relax: {
    dimension: 2,
    beta: 10,
    spec: (triangles) => `random ${half(triangles)}`,
    box: [HALF, HALF, 0],
    // Most points are near the middle.
    start(vertex) {
      const [x, y] = square(vertex).map((at) => at * (0.25 + (0.75 * Math.abs(at)) / HALF)) as Point;
      return [x, y, 0];
    },
  },
};

/** What the pointer does in a frame: it drags the vertices near its line of sight. */
export interface Drag {
  /** A point of the line, and its direction, of length 1. */
  origin: Point;
  way: Point;
  /** Vertices further along the line stay: they are on the far side. */
  depth: number;
  /** How far the pointer has moved since the last frame. */
  by: Point;
}

/** The drag falls off with the square of the distance from the line, by this factor. */
export const SHARPNESS = 60;

export interface Step {
  /** Seconds since the start, and since the last frame. */
  time: number;
  seconds: number;
  drag: Drag | undefined;
  /** Whether the pointer is pressed. Else the mesh springs back. */
  isHeld: boolean;
}

/** The share of a displacement that a frame of the released mesh keeps. */
export const kept = ({ isHeld, seconds }: Step): number => (isHeld ? 1 : Math.exp(-3 * seconds));

/** A bubble wanders through the mesh that relaxes, and pushes the points outwards. */
export const bubble = (time: number): [x: number, y: number] => [
  0.42 * Math.cos(0.6 * time),
  0.42 * Math.sin(0.9 * time),
];
/** How strongly it pushes in a second, and how sharply that falls off. */
export const PUSH = { strength: 2.4, sharpness: 60 };
/** The longest step of a point that relaxes, in mean lengths of edges: a longer one would turn triangles over. */
export const LONGEST = 0.2;

/** The mean length of an edge of a square with so many triangles. */
export const lengthOf = (triangles: number): number => HALF * Math.sqrt(8 / triangles);

/** The vertices of edges with one triangle, which stay where they are: 1, all others 0. */
export function rimOf(
  edges: { v1: Uint32Array; v2: Uint32Array; tb: Uint32Array },
  vertices: number,
): Uint32Array<ArrayBuffer> {
  const rim = new Uint32Array(vertices);
  edges.tb.forEach((other, edge) => {
    if (other === 0xffffffff) rim[edges.v1[edge]!] = rim[edges.v2[edge]!] = 1;
  });
  return rim;
}
