/**
 * A surface, drawn at once. Its fragment shader draws the edges in the colours of their states; where edges are too short
 * on screen, it tints each triangle by its smallest angle.
 */

import { EDGE_STATES } from 'edgeflip';
import { Color, DoubleSide, Mesh, MeshBasicNodeMaterial, Vector4, type BufferGeometry, type Node } from 'three/webgpu';
import {
  acos,
  dFdx,
  dFdy,
  float,
  Fn,
  fract,
  max,
  min,
  mix,
  positionView,
  select,
  uint,
  uniform,
  uniformArray,
  varying,
  vec2,
  vec3,
  vertexIndex,
} from 'three/tsl';
import type { Corners } from './corners.ts';
import { CLEAR, GONE } from './edge-scale.ts';
import type { FileSurface } from './file-surface.ts';
import { light } from './light.ts';
import type { Palette } from './palette.ts';
import type { Drawn } from './run.ts';
import { LOOKS } from './states.ts';

/** The smallest angle, in degrees, from which on a triangle counts as round. */
export const ROUND = 45;
/** How much of the colour of edges a round triangle and the thinnest one have. */
export const [LEAST, MOST] = [0.16, 0.92];
/** The most of a triangle that its edges may cover before they fade, and their opacity where they do not. */
const [COVERED, OPAQUE] = [0.45, 0.85];
/** How much of the hot colour a triangle has that an edge of it flips: if it is tinted, and if its edges are drawn. */
const [HOT, WARM] = [0.88, 0.13];
/** The same of a triangle that is not tinted, because it has the colours of a file, and how bright these are in shade. */
const [HOT_IN_FILE, DIM] = [0.6, 0.5];
/** Widths in pixels: of edges without a colour, of the boundary, and of all others. */
const [PLAIN, RIM, COLOURED] = [0.9, 1.6, 2.2];
const DEGREES = 180 / Math.PI;

/** The colours of surfaces. All surfaces of a scene share them. */
export class Paint {
  readonly lit = uniform(new Color());
  readonly shaded = uniform(new Color());
  readonly plane = uniform(new Color());
  readonly line = uniform(new Color());
  readonly spark = uniform(new Color());
  /** Pixels of the device for one of the page. */
  readonly ratio = uniform(1);
  readonly #states = EDGE_STATES.map((state) => ({ state, look: new Vector4(), dash: new Vector4() }));
  /** For each state: its colour and its width. */
  readonly looks = uniformArray<'vec4'>(
    this.#states.map(({ look }) => look),
    'vec4',
  );
  /** For each state: the length of a dash, and that of a dash and a gap. */
  readonly dashes = uniformArray<'vec4'>(
    this.#states.map(({ dash }) => dash),
    'vec4',
  );

  setPalette({ lit, shaded, plane, line, states }: Palette): void {
    this.lit.value.set(lit);
    this.shaded.value.set(shaded);
    this.plane.value.set(plane);
    this.line.value.set(line);
    this.spark.value.set(states.flips);
    for (const { state, look, dash } of this.#states) {
      const { r, g, b } = new Color(states[state]);
      const width = state === 'delaunay' ? PLAIN : state === 'boundary' ? RIM : COLOURED;
      look.set(r, g, b, width);
      const [stroke, gap] = LOOKS[state].dash ?? [1, 0];
      dash.set(stroke, stroke + gap, 0, 0);
    }
  }
}

/** The materials of a surface: of its face alone, and of its face with edges or tints. */
interface Looks {
  readonly face: MeshBasicNodeMaterial;
  readonly lined: MeshBasicNodeMaterial;
}

export class Surface {
  readonly object: Mesh<BufferGeometry, MeshBasicNodeMaterial>;
  readonly corners: Corners;
  readonly #paint: Paint;
  readonly #plain: Looks;
  /** The colours of a file, the materials that draw them, and whether these are shown. */
  #file: FileSurface | undefined;
  #inFile: Looks | undefined;
  #isFileShown = false;
  #isLined = false;
  readonly #isSolid = uniform(1);
  /** All bits set if the states of the sides are known. */
  readonly #known = uniform(0, 'uint');

  constructor(corners: Corners, paint: Paint) {
    this.corners = corners;
    this.#paint = paint;
    this.#plain = this.#looks(undefined);
    this.object = new Mesh(corners.geometry, this.#plain.face);
    Object.assign(this.object, { frustumCulled: false, visible: false });
  }

  setPositions(positions: Float32Array, dimension: 2 | 3): void {
    this.corners.setPositions(positions);
    this.#isSolid.value = dimension === 3 ? 1 : 0;
  }

  /** Takes the colours of a file for these positions, or none, and draws them if `isShown`. */
  setFile(file: FileSurface | undefined, isShown: boolean): void {
    this.corners.setColours(file?.vertices);
    if (file !== this.#file) {
      this.#inFile?.face.dispose();
      this.#inFile?.lined.dispose();
      this.#inFile = file && this.#looks(file);
      this.#file = file;
    }
    this.#isFileShown = isShown;
    this.#wear();
  }

  /** `isLined`: whether it shows its edges, or tints. `sides` has the states of the sides of each triangle. */
  show(triangles: Drawn, count: number, isLined: boolean, sides: Drawn | undefined): void {
    this.corners.setTriangles(triangles, count);
    this.corners.setSides(sides);
    this.#known.value = sides ? 0xfff : 0;
    this.#isLined = isLined;
    this.#wear();
    this.object.geometry = this.corners.geometry;
    this.object.visible = true;
  }

  /** Shows nothing, and releases all buffers. */
  clear(): void {
    this.object.visible = false;
    this.corners.clear();
    this.object.geometry = this.corners.geometry;
  }

  #looks(file: FileSurface | undefined): Looks {
    const { plane, shaded, lit } = this.#paint;
    const face = file
      ? file.colour(this.corners).mul(mix(float(1), mix(float(DIM), float(1), light()), this.#isSolid))
      : mix(plane, mix(shaded, lit, light()), this.#isSolid);
    return { face: this.#material(face), lined: this.#material(this.#colour(this.#paint, face, file !== undefined)) };
  }

  #wear(): void {
    const { face, lined } = (this.#isFileShown && this.#inFile) || this.#plain;
    this.object.material = this.#isLined ? lined : face;
  }

  #material(colour: Node<'vec3'>): MeshBasicNodeMaterial {
    const material = new MeshBasicNodeMaterial({
      side: DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    material.positionNode = this.corners.position;
    material.colorNode = colour;
    return material;
  }

  /** The colour of the face with its edges, or with a tint unless it has the colours of a file. */
  #colour(paint: Paint, face: Node<'vec3'>, isOfFile: boolean): Node<'vec3'> {
    return Fn(() => {
      const corner = vertexIndex.mod(uint(3));
      // The share of each corner. Side k goes from corner k to the next, and faces corner k + 2.
      const shares = varying(
        vec3(
          select(corner.equal(uint(0)), float(1), float(0)),
          select(corner.equal(uint(1)), float(1), float(0)),
          select(corner.equal(uint(2)), float(1), float(0)),
        ),
      );
      const word = varying(this.corners.sides.bitAnd(this.#known)) as Node<'uint'>;
      const states = [0, 4, 8].map((bit) => word.shiftRight(uint(bit)).bitAnd(uint(15)));
      const [right, down] = [dFdx(shares).toVar(), dFdy(shares).toVar()];
      // The sides in the picture, in pixels of the device, follow from how the shares change from pixel to pixel.
      const turn = right.y.mul(down.z).sub(down.y.mul(right.z)).toVar();
      const inverse = float(1).div(select(turn.abs().lessThan(1e-30), float(1e-30), turn));
      const first = vec2(down.z, right.z.negate()).mul(inverse);
      const last = vec2(down.y.negate(), right.y).mul(inverse);
      const lengths = vec3(first.length(), last.sub(first).length(), last.length()).toVar();
      const slopes = vec3(
        vec2(right.z, down.z).length(),
        vec2(right.x, down.x).length(),
        vec2(right.y, down.y).length(),
      );
      const longest = max(lengths.x, lengths.y, lengths.z);
      const shortest = min(lengths.x, lengths.y, lengths.z);
      const median = lengths.x.add(lengths.y).add(lengths.z).sub(longest).sub(shortest).div(paint.ratio);
      // From 0, where the triangle is tinted, to 1, where its edges are drawn.
      const clear = median
        .sub(GONE)
        .div(CLEAR - GONE)
        .clamp(0, 1)
        .toVar();
      const pixels = shares.zxy.div(slopes).toVar();
      const along = shares.yzx.sub(shares).mul(0.5).mul(lengths).div(paint.ratio).toVar();

      const thin = float(1)
        .sub(smallestAngle(right, down).mul(DEGREES / ROUND))
        .clamp(0, 1);
      const tint = mix(float(LEAST), float(MOST), thin).mul(clear.oneMinus());
      const hot = max(...(states.map((state) => select(state.equal(uint(1)), float(1), float(0))) as [Num, Num, Num]));
      const tinted = isOfFile ? face : mix(face, paint.line, tint);
      const heat = mix(float(isOfFile ? HOT_IN_FILE : HOT), float(WARM), clear);
      const colour = mix(tinted, paint.spark, hot.mul(heat)).toVar();

      const sides = [0, 1, 2].map((k) => {
        const look = paint.looks.element(states[k]!) as Node<'vec4'>;
        const dash = paint.dashes.element(states[k]!) as Node<'vec4'>;
        const axis = (['x', 'y', 'z'] as const)[k]!;
        const [pixel, at] = [pixels[axis], along[axis]];
        const cover = look.w.mul(paint.ratio).mul(0.5).sub(pixel).add(0.5).clamp(0, 1);
        // Dashes are centred, so that those of both triangles of an edge meet.
        const isInDash = fract(at.add(dash.x.mul(0.5)).div(dash.y))
          .mul(dash.y)
          .lessThan(dash.x);
        const isPlain = states[k]!.equal(uint(0));
        return {
          look,
          plain: select(isPlain, cover, float(0)),
          coloured: select(isPlain.not().and(isInDash), cover, float(0)),
        };
      });
      // How much of the triangle its edges would cover.
      const cover = lengths.x.add(lengths.y).add(lengths.z).mul(turn.abs()).mul(paint.ratio).mul(PLAIN);
      const opacity = float(COVERED)
        .div(max(cover, float(COVERED)))
        .mul(OPAQUE);
      const plain = max(...(sides.map((side) => side.plain) as [Num, Num, Num]));
      colour.assign(mix(colour, paint.line, plain.mul(opacity).mul(clear)));
      for (const { look, coloured } of sides) colour.assign(mix(colour, look.xyz, coloured.mul(clear)));
      return colour;
    })() as Node<'vec3'>;
  }
}

type Num = Node<'float'>;

/** The smallest angle of the triangle, in radians, from how the shares of two corners change from pixel to pixel. */
function smallestAngle(right: Node<'vec3'>, down: Node<'vec3'>): Num {
  const [x, y] = [dFdx(positionView), dFdy(positionView)];
  // Two sides of the triangle, both larger by the same factor.
  const u = x.mul(down.z).sub(y.mul(right.z)).toVar();
  const v = y.mul(right.y).sub(x.mul(down.y)).toVar();
  const w = v.sub(u).toVar();
  const long = (side: typeof u) => side.length().max(1e-30).toVar();
  const [a, b, c] = [long(u), long(v), long(w)];
  const cosines = max(u.dot(v).div(a.mul(b)), u.dot(w).negate().div(a.mul(c)), v.dot(w).div(b.mul(c)));
  return acos(cosines.clamp(-1, 1)) as Num;
}
