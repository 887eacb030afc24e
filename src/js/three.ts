/**
 * Makes a geometry of three.js Delaunay.
 *
 * ```ts
 * import { delaunayGeometry } from 'edgeflip/three';
 * const { flips, remaining } = await delaunayGeometry(mesh.geometry);
 * ```
 *
 * This entry does not import three.js; it works with the objects of any copy of it.
 *
 * @packageDocumentation
 */

import type { BufferAttribute, BufferGeometry, GLBufferAttribute, InterleavedBufferAttribute } from 'three';
import { inRange, type Range, rangeOf } from './draw-range.js';
import { EdgeflipError } from './error.js';
import { objectOf, read, shown } from './given.js';
import { makeDelaunay } from './index.js';
import {
  type Limited,
  limitsOf,
  runWithin,
  type ShiftOptions,
  type ShiftResult,
  type TerrainOptions,
} from './limited.js';
import { flipShared, type OnGpu, type Renderer, rendererOf, type Run } from './renderer.js';
import type { FlipSession } from './session.js';
import type { Limit } from './shift.js';
import { type Columns, meshOf, sequence, type Surface } from './surface.js';
import type { MakeDelaunayOptions, Result } from './types.js';

export { EdgeflipError, type ErrorCode } from './error.js';
export type { ShiftOptions, ShiftResult, TerrainOptions } from './limited.js';
export type { Renderer } from './renderer.js';

/**
 * The options of {@link delaunayGeometry}. `lockedTriangles` and `groups` count all triangles of the geometry, and
 * `lockedEdges` are edges of it, also where a `drawRange` hides them.
 * `maxDeviation` is in the units of the positions; for normalized positions, the largest integer stands for 1.
 *
 * Two options have other defaults. `weld` joins vertices at the same position and compares all their attributes, also
 * those of morph targets; `false` joins no vertices. `groups` are the groups of the geometry.
 */
export interface GeometryOptions extends MakeDelaunayOptions, TerrainOptions, ShiftOptions {
  /** Whether to leave the geometry as it is and change a clone of it. Default: `false`. */
  copy?: boolean | undefined;
  /**
   * Whether `geometry.index` keeps its attribute and its array, and gets a new version. Other geometries with the same
   * attribute change too: GLTFLoader makes one for primitives that share an accessor. Default: `false`, the geometry
   * gets a new attribute for its index if an edge flips.
   */
  inPlace?: boolean | undefined;
  /**
   * The `WebGPURenderer` that draws the geometry. The run uses its device, and the renderer then draws from the buffer
   * that the flips wrote; the triangles do not travel to the CPU, unless some edges are non-manifold or inconsistent.
   * `geometry.index` becomes a new attribute with a Uint32Array, which still has the triangles before the run. Raycasts,
   * wireframes, other renderers and the next call use that array.
   *
   * `weld` is then `false` by default. With `weld`, for a geometry without an index, and for a part of one in
   * `drawRange`, the option has no effect. Where the renderer has no WebGPU, and where `'auto'` takes the CPU, the index
   * is written on the CPU.
   */
  renderer?: Renderer | undefined;
}

/** The result of {@link delaunayGeometry}. Its indices are in the geometry. */
export interface GeometryResult<G extends BufferGeometry = BufferGeometry>
  extends Omit<Result, 'indices'>,
    ShiftResult {
  /** The geometry that was changed: the given one, or its clone. */
  geometry: G;
  /**
   * The session with the buffer that the `renderer` draws from, if the triangles are on its device. It is freed when
   * the geometry is disposed of, or gets another session. `await session.triangles()` reads them.
   */
  session: FlipSession | undefined;
}

type Attribute = BufferAttribute | InterleavedBufferAttribute | GLBufferAttribute;

/**
 * Flips the edges of a geometry until every edge is Delaunay or cannot flip. If an edge flips, the geometry gets a new
 * index. Its type, the vertices, the attributes, `groups` and the bounding volumes stay. Only triangles in `drawRange`
 * change.
 *
 * Edges of a seam, where the attributes of vertices at the same position differ, stay. So do edges between groups, and
 * those whose flip would shift a texture too far. Positions are those without morph targets and skinning.
 *
 * Do not change the index during the run. After the run, update what you have derived from the triangles: for
 * three-mesh-bvh, call `geometry.boundsTree.refit()`.
 *
 * @throws {@link EdgeflipError} about the geometry, the options or the backend; the geometry is unchanged then.
 */
export async function delaunayGeometry<G extends BufferGeometry>(
  geometry: G,
  options: GeometryOptions = {},
): Promise<GeometryResult<G>> {
  const { target, surface, range, plane, settings, limited, isInPlace, renderer } = read('the geometry', () =>
    opened(geometry, options),
  );
  const { index } = target;
  const version = index?.version;
  const {
    result: made,
    onGpu,
    ...shifts
  } = await runWithin(
    limited,
    ...meshOf(surface, plane, settings),
    async (mesh, options): Promise<Run> =>
      renderer ? flipShared(renderer, mesh, options) : { result: await makeDelaunay(mesh, options) },
  );
  const { indices, ...result } = made;
  if (target.index !== index || index?.version !== version) {
    onGpu?.session.free();
    throw new EdgeflipError('invalid-input', 'the index of the geometry changed during the run');
  }
  if (onGpu) draw(target, onGpu);
  else {
    release(target);
    if (result.flips + result.turnedTriangles + result.crossedEdges > 0)
      write(target, indices, range, surface.vertices, isInPlace);
  }
  return { geometry: target, session: onGpu?.session, ...result, ...shifts };
}

/** The sessions whose buffers are drawn, by geometry. */
const drawn = new WeakMap<BufferGeometry, FlipSession>();

/** `StaticDrawUsage` of three.js. With any other usage, it would upload the old triangles again. */
const STATIC_DRAW = 35044;

/** Gives the geometry an index of its own on the CPU again, and frees the session whose buffer it was drawn from. */
function release(geometry: BufferGeometry): void {
  geometry.removeEventListener('dispose', onDispose);
  if (!drawn.has(geometry)) return;
  geometry.setIndex(geometry.index!.clone());
  drawn.get(geometry)?.free();
  drawn.delete(geometry);
}

const onDispose = ({ target }: { target: BufferGeometry }) => release(target);

/** Gives the geometry an index that is drawn from the buffer of the session. */
function draw(geometry: BufferGeometry, { session, adopt }: OnGpu): void {
  release(geometry);
  const index = geometry.index!.clone();
  // The renderer takes the size of an index from this array.
  if (!(index.array instanceof Uint32Array)) index.array = new Uint32Array(index.array);
  index.setUsage(STATIC_DRAW);
  adopt(index);
  geometry.setIndex(index);
  drawn.set(geometry, session);
  geometry.addEventListener('dispose', onDispose);
}

/** Reads a geometry and the options before the first wait. */
function opened<G extends BufferGeometry>(geometry: G, options: GeometryOptions) {
  const {
    copy = false,
    inPlace = false,
    renderer: drawing,
    maxAttributeShift,
    plane,
    ...given
  } = objectOf(options, 'options') as GeometryOptions;
  const renderer = rendererOf(drawing);
  for (const [name, flag] of Object.entries({ copy, inPlace })) {
    if (typeof flag === 'boolean') continue;
    throw new EdgeflipError('invalid-option', `option ${name}: ${shown(flag)} is not true or false`);
  }
  if (objectOf(geometry, 'geometry')['isBufferGeometry'] !== true) {
    throw invalid('geometry: it is not a BufferGeometry of three.js');
  }
  const target = copy ? (geometry.clone() as G) : geometry;
  const { index, drawRange } = target;
  const isWhole = index !== null && drawRange.start <= 0 && drawRange.start + drawRange.count >= index.count;
  const isShared = renderer !== undefined && isWhole && !given.weld;
  const isCompared = given.weld === undefined && !isShared;
  const { vertices, positions, attributes } = verticesOf(target, isCompared);
  const corners = index?.count ?? vertices;
  if (corners % 3 > 0) {
    throw invalid(`the geometry has ${corners} ${index ? 'indices' : 'vertices and no index'}, not a multiple of 3`);
  }
  const range = rangeOf('drawRange', drawRange, corners);
  const whole: Surface = { vertices, positions, attributes, indices: index?.array ?? sequence(0, corners) };
  const surface = { ...whole, indices: whole.indices.subarray(...range) };
  const groups = given.groups ?? groupsOf(target, corners);
  const settings = inRange({ ...given, groups, ...(isShared && { weld: false }) }, range, whole);
  const limited: Limited = {
    limits: shiftLimits(target, maxAttributeShift, given.weld === true || given.constraints !== undefined),
    joining: settings.weld === false ? 'none' : isCompared ? 'equal' : 'all',
  };
  return {
    target,
    surface,
    range,
    plane,
    settings,
    limited,
    isInPlace: inPlace || copy,
    renderer: isShared ? renderer : undefined,
  };
}

/** Texture coordinates of three.js. */
const TEXTURE = /^uv\d?$/;

/** The attributes whose shift is limited. */
function shiftLimits({ attributes }: BufferGeometry, given: unknown, isOff: boolean): Limit[] {
  const all = Object.entries(attributes as Record<string, Attribute>).filter(
    ([name, attribute]) =>
      name !== 'position' && !('isGLBufferAttribute' in attribute) && columnsOf(name, attribute) !== undefined,
  );
  const names = all.map(([name]) => name);
  const most = limitsOf(given, names, (name) => TEXTURE.test(name), isOff);
  return all.flatMap(([name, attribute]) => {
    if (!most.has(name)) return [];
    checkCount(name, attribute, attributes['position']!);
    return { name, ...numbersOf(attribute as BufferAttribute), most: most.get(name)! };
  });
}

/** The numbers of an attribute that the shaders get: integers and 16-bit floats stand for others. */
function numbersOf(attribute: BufferAttribute | InterleavedBufferAttribute): Pick<Limit, 'values' | 'width'> {
  const { count, itemSize: width } = attribute;
  const getters = (['getX', 'getY', 'getZ', 'getW'] as const).slice(0, width);
  const values = new Float64Array(count * getters.length);
  for (let i = 0, to = 0; i < count; i++) {
    for (const get of getters) values[to++] = attribute[get](i);
  }
  return { values, width: getters.length };
}

/** The columns of the positions and, if they are compared, of the other attributes. */
function verticesOf({ attributes, morphAttributes }: BufferGeometry, isCompared: boolean): Omit<Surface, 'indices'> {
  const { position, ...others } = attributes as Record<string, Attribute>;
  if (!position) throw invalid('the geometry has no attribute position');
  const positions = columnsOf('position', position);
  if (!positions) throw invalid('attribute position: it belongs to instances, not to vertices');
  if (positions.width < 3) throw invalid(`attribute position: it has ${positions.width} numbers per vertex, not 3`);
  const morphs = Object.entries(morphAttributes as Record<string, Attribute[]>);
  const compared: [string, Attribute][] = [
    ...Object.entries(others),
    ...morphs.flatMap(([name, all]) => all.map((one): [string, Attribute] => [`${name} of a morph target`, one])),
  ];
  const columns = (isCompared ? compared : []).flatMap(([name, attribute]) => {
    const columns = columnsOf(name, attribute);
    if (columns) checkCount(name, attribute, position);
    return columns ?? [];
  });
  return { vertices: position.count, positions: { ...positions, width: 3 }, attributes: columns };
}

/** @throws {@link EdgeflipError} `invalid-input` if an attribute has fewer vertices than the position. */
function checkCount(name: string, { count }: Attribute, position: Attribute): void {
  if (count >= position.count) return;
  throw invalid(`attribute ${name}: it has ${count} vertices, and position has ${position.count}`);
}

function invalid(message: string): EdgeflipError {
  return new EdgeflipError('invalid-input', message);
}

/** Where the numbers of an attribute are; `undefined` if they belong to instances. */
function columnsOf(name: string, attribute: Attribute): Columns | undefined {
  if ('isGLBufferAttribute' in attribute) {
    throw invalid(`attribute ${name}: a GLBufferAttribute is on the GPU and cannot be read`);
  }
  const { itemSize: width, normalized: isNormalized } = attribute;
  if ('data' in attribute) {
    const { data, offset } = attribute;
    if ('isInstancedInterleavedBuffer' in data) return undefined;
    return { array: data.array, width, stride: data.stride, offset, isNormalized };
  }
  if ('isInstancedBufferAttribute' in attribute) return undefined;
  const { array, count } = attribute;
  if (name !== 'position' || !('isFloat16BufferAttribute' in attribute)) {
    return { array, width, stride: width, offset: 0, isNormalized };
  }
  const floats = new Float32Array(3 * count);
  for (let i = 0; i < count; i++) floats.set([attribute.getX(i), attribute.getY(i), attribute.getZ(i)], 3 * i);
  return { array: floats, width: 3, stride: 3, offset: 0, isNormalized: false };
}

/** A number for each triangle. Triangles have the same number if the same groups have them. */
function groupsOf({ groups }: BufferGeometry, corners: number): Uint32Array | undefined {
  if (groups.length === 0) return undefined;
  const numbers = new Uint32Array(corners / 3);
  let last = 0;
  groups.forEach((group, i) => {
    const [first, end] = rangeOf(`group ${i}`, group, corners);
    const next = new Map<number, number>();
    for (let t = first / 3; t < end / 3; t++) {
      const number = numbers[t]!;
      if (!next.has(number)) next.set(number, ++last);
      numbers[t] = next.get(number)!;
    }
  });
  return numbers;
}

/** Writes the triangles of the range. Unless this is done in place, other geometries with the same index keep it. */
function write(
  geometry: BufferGeometry,
  indices: Uint32Array,
  [start]: Range,
  vertices: number,
  isInPlace: boolean,
): void {
  const { index } = geometry;
  if (index && isInPlace) {
    index.array.set(indices, start);
    index.clearUpdateRanges();
    index.needsUpdate = true;
  } else if (index) {
    const own = index.clone();
    own.array.set(indices, start);
    // three.js makes wireframes again if the version of the index is another one.
    own.version = index.version + 1;
    geometry.setIndex(own);
  } else {
    // three.js makes an attribute with 16 or 32 bits of it.
    const all = sequence(0, vertices);
    all.set(indices, start);
    geometry.setIndex(Array.from(all));
  }
}
