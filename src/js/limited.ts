/** Runs that shift no texture too far, for `three.ts` and `gltf-transform.ts`. */

import { EdgeflipError } from './error.js';
import { copyOf, read, shown } from './given.js';
import { inSpace, readMesh } from './mesh.js';
import type { Run } from './renderer.js';
import { MAKE_OPTIONS, settingsOf, watchOf } from './settings.js';
import type { Joining, Limit } from './shift.js';
import type { MakeDelaunayOptions, Mesh, Plane } from './types.js';

/** The option that limits how far flips shift textures. */
export interface ShiftOptions {
  /**
   * How far flips may shift a texture, a colour or another attribute of the vertices, in the units of the attribute: a
   * number for all texture coordinates, or one for each attribute by its name. An edge stays if its flip would shift an
   * attribute further, measured where the two diagonals cross, as a camera 27° beside the normal sees it. If many flips
   * together shift an attribute further than that, the edges that they crossed stay too, and the run starts again. More
   * oblique cameras are not measured, nor are silhouettes and light. `Infinity` sets no limit. Default: 1/1024 for
   * texture coordinates, one texel of a texture with 1,024 texels in a row, and `Infinity` for other attributes; with
   * `weld: true`, which ignores attributes, and with `constraints`, `Infinity` for all. With a `plane`, the camera is
   * above the terrain.
   */
  maxAttributeShift?: number | Readonly<Record<string, number>> | undefined;
}

/** The options of a terrain, besides those of a surface. */
export interface TerrainOptions
  extends Pick<MakeDelaunayOptions, 'constraints' | 'constraintTolerance' | 'skipConstraints' | 'untangle'> {
  /**
   * The plane of a terrain: these two coordinates decide, and the third, the height, counts for nothing. In three.js and
   * glTF y is up: `'xz'`. The options `constraints`, `constraintTolerance`, `skipConstraints` and `untangle`
   * need it.
   */
  plane?: Plane | undefined;
}

/** What `maxAttributeShift` did. */
export interface ShiftResult {
  /** The edges that `maxAttributeShift` locked. */
  shiftEdges: number;
  /**
   * The largest shift of each attribute that `maxAttributeShift` limits, by name: at the crossings of edges of the result
   * with edges of the input. `undefined` if the triangles are on the device of a renderer.
   */
  largestShifts: Record<string, number> | undefined;
}

/** The attributes whose shift is limited, and how the vertices of the surface are joined. */
export interface Limited {
  limits: readonly Limit[];
  joining: Joining;
}

/** The default: one texel of a texture with 1,024 texels in a row. */
const TEXEL = 1 / 1024;

/**
 * The largest shifts that are allowed, by the names of the attributes that have a limit.
 *
 * @param names - All attributes that can have one.
 * @param isTexture - Whether an attribute of this name has texture coordinates.
 * @param isOff - Whether no attribute has a limit by default.
 * @throws {@link EdgeflipError} `invalid-option`.
 */
export function limitsOf(
  given: unknown,
  names: readonly string[],
  isTexture: (name: string) => boolean,
  isOff: boolean,
): Map<string, number> {
  const wrong = (why: string) => new EdgeflipError('invalid-option', `option maxAttributeShift: ${why}`);
  const checked = (value: unknown) => {
    if (typeof value === 'number' && value >= 0) return value;
    throw wrong(`${shown(value)} is not a number of at least 0`);
  };
  return read('the options', () => {
    const isList = typeof given === 'object' && given !== null;
    const ofTextures = given === undefined || isList ? (isOff ? Infinity : TEXEL) : checked(given);
    const limits = new Map(names.filter(isTexture).map((name) => [name, ofTextures]));
    for (const [name, value] of Object.entries(isList ? given : {})) {
      if (value === undefined) continue;
      if (!names.includes(name)) {
        const known = names.length > 0 ? `there are ${names.join(', ')}` : 'the geometry has only positions';
        throw wrong(`there is no attribute ${shown(name)}; ${known}`);
      }
      limits.set(name, checked(value));
    }
    return new Map([...limits].filter(([, most]) => most < Infinity));
  });
}

/**
 * Runs, and locks the edges whose flips would shift an attribute too far. Reads its arguments before it returns its
 * promise.
 */
export async function runWithin(
  { limits, joining }: Limited,
  mesh: Mesh<Uint32Array>,
  options: MakeDelaunayOptions,
  run: (mesh: Mesh<Uint32Array>, options: MakeDelaunayOptions) => Promise<Run>,
): Promise<Run & ShiftResult> {
  if (limits.length === 0) return { ...(await run(mesh, options)), shiftEdges: 0, largestShifts: {} };
  const { isStopped: _, ...watch } = watchOf(options);
  const settings = settingsOf(options, MAKE_OPTIONS);
  const [copy, { plane }] = readMesh(mesh, copyOf);
  const { positions, indices } = inSpace(copy);
  const again = { positions, indices, dimension: copy.dimension, plane, stride: 3 };
  // Without textures, this code is not loaded.
  const { Attributes } = await import('./shift.js');
  const attributes = new Attributes(copy, limits, joining);
  const given = settings.lockedEdges ?? new Uint32Array();
  for (;;) {
    const own = attributes.lockedEdges;
    const lockedEdges = new Uint32Array(given.length + own.length);
    lockedEdges.set(given);
    lockedEdges.set(own, given.length);
    const made = await run(again, { ...watch, ...settings, lockedEdges });
    const shiftEdges = own.length / 2;
    if (made.onGpu) return { ...hinted(made, shiftEdges), shiftEdges, largestShifts: undefined };
    const largest = attributes.compare(made.result.indices);
    if (attributes.lockedEdges.length > own.length) continue;
    const largestShifts = Object.fromEntries(limits.map(({ name }, i) => [name, largest[i]!]));
    return { ...hinted(made, shiftEdges), shiftEdges, largestShifts };
  }
}

/** The run, with advice if `maxAttributeShift` keeps more edges from their flips than flip. */
function hinted({ result, ...made }: Run, shiftEdges: number): Run {
  const { flips, remaining, hint } = result;
  const locked = remaining.locked ?? 0;
  if (Math.min(locked, shiftEdges) <= flips) return { result, ...made };
  const advice = `Locked edges that are not Delaunay: ${locked}. To save the texture, maxAttributeShift locks ${shiftEdges} edges, also Delaunay ones; pass a larger limit, or Infinity for none.`;
  return { result: { ...result, hint: hint === undefined ? advice : `${hint} ${advice}` }, ...made };
}
