/** Paints the first view: quiet ink on lit triangles, and one hot colour for edges that flip. */

import {
  createBufferInfoFromArrays,
  createProgramInfo,
  drawBufferInfo,
  setAttribInfoBufferFromArray,
  setBuffersAndAttributes,
  setUniforms,
  type BufferInfo,
  type ProgramInfo,
} from 'twgl.js';
import { colourReader } from '../shell/theme.ts';
import type { Flashes } from './flashes.ts';

type Rgb = [number, number, number];

/** Towards the light. */
const LIGHT = [-0.46, -0.62, 0.64] as const;
/** Edges longer than these multiples of the shortest spacing are fainter than shorter ones. */
const [SHORT, LONG] = [1.8, 3.4];

/** Numbers of a triangle: its corners, its light, its warmth, and of its sides how strong and how hot they are. */
const WORDS = { a: 2, b: 2, c: 2, light: 1, warmth: 1, strengths: 3, heats: 3 } as const;

const VERTEX = `#version 300 es
  uniform vec2 size;
  in vec2 a, b, c;
  in float light, warmth;
  in vec3 strengths, heats;
  out vec3 distances;
  flat out float shade, warm;
  flat out vec3 strength, heat;
  void main() {
    int corner = gl_VertexID;
    vec2 at = corner == 0 ? a : corner == 1 ? b : c;
    distances = vec3(corner == 0, corner == 1, corner == 2);
    (shade = light, warm = warmth, strength = strengths, heat = heats);
    gl_Position = vec4(2.0 * at.x / size.x - 1.0, 1.0 - 2.0 * at.y / size.y, 0.0, 1.0);
  }`;

const FRAGMENT = `#version 300 es
  precision highp float;
  uniform vec3 low, high, line, spark;
  uniform float scale, glow;
  in vec3 distances;
  flat in float shade, warm;
  flat in vec3 strength, heat;
  out vec4 colour;
  // How much of a line of this width covers the pixel, at a distance in CSS pixels from its middle.
  vec3 covered(vec3 pixels, vec3 width) {
    return clamp((0.5 * width - pixels) * scale + 0.5, 0.0, 1.0);
  }
  void main() {
    vec3 pixels = distances / fwidth(distances) / scale;
    vec3 mixed = mix(mix(low, high, shade), spark, warm);
    vec3 thin = strength * covered(pixels, vec3(0.9));
    mixed = mix(mixed, line, max(thin.x, max(thin.y, thin.z)));
    vec3 halo = glow * heat * exp(-pixels * pixels / 12.0);
    mixed = mix(mixed, spark, max(halo.x, max(halo.y, halo.z)));
    vec3 hot = step(0.01, heat) * (0.25 + 0.75 * heat) * covered(pixels, 0.9 + 1.7 * heat);
    colour = vec4(mix(mixed, spark, max(hot.x, max(hot.y, hot.z))), 1.0);
  }`;

export interface Picture {
  /** In CSS pixels. */
  positions: Float32Array;
  heights: Float32Array;
  indices: Uint32Array;
  flashes: Flashes;
  /** The shortest spacing of points. */
  finest: number;
}

export class Painter {
  readonly #gl: WebGL2RenderingContext;
  readonly #program: ProgramInfo;
  #buffers: BufferInfo | undefined;
  #arrays = arraysFor(0);
  #ink = presentInk();
  /** Tells when the GPU has done the last picture. */
  #fence: WebGLSync | null = null;

  constructor(canvas: HTMLCanvasElement) {
    const gl = canvas.getContext('webgl2', { alpha: false, antialias: false, powerPreference: 'low-power' });
    if (!gl) throw new Error('the browser has no WebGL2');
    this.#gl = gl;
    this.#program = createProgramInfo(gl, [VERTEX, FRAGMENT]);
  }

  /** Takes over the present colours of the page. */
  recolour(): void {
    this.#ink = presentInk();
  }

  paint(picture: Picture, scale: number): void {
    const { canvas } = this.#gl;
    this.#fill(picture, this.#ink.isDark);
    this.#gl.viewport(0, 0, canvas.width, canvas.height);
    this.#gl.useProgram(this.#program.program);
    const buffers = this.#buffers!;
    setBuffersAndAttributes(this.#gl, this.#program, buffers);
    setUniforms(this.#program, {
      ...this.#ink.colours,
      size: [canvas.width / scale, canvas.height / scale],
      scale,
      glow: this.#ink.isDark ? 0.5 : 0.3,
    });
    drawBufferInfo(this.#gl, buffers, this.#gl.TRIANGLES, 3, 0, picture.indices.length / 3);
    this.#gl.deleteSync(this.#fence);
    this.#fence = this.#gl.fenceSync(this.#gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  }

  /** Whether the GPU has done the last picture. */
  get isDone(): boolean {
    return !this.#fence || this.#gl.getSyncParameter(this.#fence, this.#gl.SYNC_STATUS) === this.#gl.SIGNALED;
  }

  /** One entry for each triangle in each array. */
  #fill({ positions, heights, indices, flashes, finest }: Picture, isDark: boolean): void {
    const count = indices.length / 3;
    if (this.#arrays.light.length !== count) this.#allocate(count);
    const arrays = this.#arrays;
    const strengths = isDark ? [0.4, 0.3, 0.2] : [0.62, 0.5, 0.36];
    for (let t = 0; t < count; t++) {
      const corners = [indices[3 * t]!, indices[3 * t + 1]!, indices[3 * t + 2]!] as const;
      const [a, b, c] = corners;
      [arrays.a, arrays.b, arrays.c].forEach((array, k) => {
        array[2 * t] = positions[2 * corners[k]!]!;
        array[2 * t + 1] = positions[2 * corners[k]! + 1]!;
      });
      const [ux, uy, uz] = [
        arrays.b[2 * t]! - arrays.a[2 * t]!,
        arrays.b[2 * t + 1]! - arrays.a[2 * t + 1]!,
        heights[b]! - heights[a]!,
      ];
      const [vx, vy, vz] = [
        arrays.c[2 * t]! - arrays.a[2 * t]!,
        arrays.c[2 * t + 1]! - arrays.a[2 * t + 1]!,
        heights[c]! - heights[a]!,
      ];
      const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
      // The corners of all triangles go round the other way.
      const facing = nz < 0 ? -1 : 1;
      const light = (facing * (nx * LIGHT[0] + ny * LIGHT[1] + nz * LIGHT[2])) / (Math.hypot(nx, ny, nz) || 1);
      const shade = Math.max(0, Math.min(1, (light - 0.1) / 0.86));
      arrays.light[t] = isDark ? shade ** 2 : Math.min(1, 1.35 * shade);
      // Side k is opposite to corner k.
      const lengths = [Math.hypot(ux - vx, uy - vy), Math.hypot(vx, vy), Math.hypot(ux, uy)];
      const heats = [flashes.heatOf(b, c), flashes.heatOf(c, a), flashes.heatOf(a, b)];
      lengths.forEach((length, k) => {
        arrays.strengths[3 * t + k] = strengths[length <= SHORT * finest ? 0 : length <= LONG * finest ? 1 : 2]!;
        arrays.heats[3 * t + k] = heats[k]!;
      });
      arrays.warmth[t] = 0.17 * Math.max(...heats);
    }
    const { attribs } = this.#buffers!;
    for (const [name, array] of Object.entries(arrays)) setAttribInfoBufferFromArray(this.#gl, attribs![name]!, array);
  }

  #allocate(count: number): void {
    this.#arrays = arraysFor(count);
    const entries = Object.entries(this.#arrays).map(([name, data]) => {
      const numComponents = WORDS[name as keyof typeof WORDS];
      return [name, { data, numComponents, divisor: 1, drawType: this.#gl.DYNAMIC_DRAW }];
    });
    this.#buffers = createBufferInfoFromArrays(this.#gl, Object.fromEntries(entries));
  }
}

/** The arrays of an entry per triangle, for so many triangles. */
function arraysFor(count: number): Record<keyof typeof WORDS, Float32Array> {
  const entries = Object.entries(WORDS).map(([name, words]) => [name, new Float32Array(words * count)]);
  return Object.fromEntries(entries) as Record<keyof typeof WORDS, Float32Array>;
}

/** The present colours of the page, each from 0 to 1. */
function presentInk(): { isDark: boolean; colours: Record<'low' | 'high' | 'line' | 'spark', Rgb> } {
  const read = colourReader();
  const colour = (token: string) =>
    read(token)
      .match(/\d+/g)!
      .map((part) => Number(part) / 255) as Rgb;
  const mixed = (from: Rgb, to: Rgb, part: number) => from.map((x, k) => x + (to[k]! - x) * part) as Rgb;
  const [ground, text, lit, shaded, edge] = (['ground', 'text', 's0', 's1', 'edge'] as const).map(colour) as [
    Rgb,
    Rgb,
    Rgb,
    Rgb,
    Rgb,
  ];
  const isDark = ground[0] < text[0];
  return {
    isDark,
    colours: {
      low: isDark ? mixed(ground, shaded, 0.3) : mixed(shaded, edge, 0.18),
      high: isDark ? mixed(shaded, lit, 0.86) : lit,
      line: mixed(edge, text, isDark ? 0.35 : 0.12),
      spark: colour('spark'),
    },
  };
}
