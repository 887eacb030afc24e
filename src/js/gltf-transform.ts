/**
 * Makes the meshes of a glTF-Transform document Delaunay.
 *
 * ```ts
 * import { delaunay } from 'edgeflip/gltf-transform';
 * await document.transform(delaunay());
 * ```
 *
 * @packageDocumentation
 */

import type { Accessor, Document, ILogger, Primitive, Transform } from '@gltf-transform/core';
import { EdgeflipError } from './error.js';
import { makeDelaunay } from './index.js';
import {
  type Limited,
  limitsOf,
  runWithin,
  type ShiftOptions,
  type ShiftResult,
  type TerrainOptions,
} from './limited.js';
import { namesOf, optionsOf } from './names.js';
import { type Matrix, stretched, stretches } from './placement.js';
import { type Columns, meshOf, pointsOf, sequence, type Surface, unitOf } from './surface.js';
import type { MakeDelaunayOptions, Reason, Reasons, Result } from './types.js';

export { EdgeflipError, type ErrorCode } from './error.js';
export type { ShiftOptions, TerrainOptions } from './limited.js';

/**
 * The options of {@link delaunay}. `maxDeviation` is in the units of each mesh. `constraints` are vertices of a primitive,
 * so the document may have only one; a `plane` is that of the primitive's own coordinates.
 */
export interface DelaunayOptions
  extends Pick<
      MakeDelaunayOptions,
      | 'backend'
      | 'maxNormalAngle'
      | 'maxDeviation'
      | 'maxIterations'
      | 'reorient'
      | 'order'
      | 'threads'
      | 'device'
      | 'signal'
    >,
    TerrainOptions,
    ShiftOptions {
  /**
   * By default, vertices at the same position are joined for the run, and all their attributes are compared, also those
   * of morph targets. `true` ignores attributes, `false` joins no vertices.
   */
  weld?: boolean | undefined;
}

const OPTIONS = namesOf<DelaunayOptions>({
  backend: true,
  maxNormalAngle: true,
  maxDeviation: true,
  maxIterations: true,
  reorient: true,
  order: true,
  threads: true,
  device: true,
  signal: true,
  weld: true,
  maxAttributeShift: true,
  plane: true,
  constraints: true,
  constraintTolerance: true,
  skipConstraints: true,
  untangle: true,
});

/** Modes of primitives. */
const [TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN] = [4, 5, 6];

/**
 * A transform that flips the edges of each primitive until every edge is Delaunay or cannot flip. Only indices change,
 * and their type stays. A primitive without indices gets indices if one of its edges flips. Each primitive is a mesh by
 * itself: edges between two primitives never flip. Triangle strips and fans stay as they are, with a warning.
 *
 * Positions count as the numbers in the document, also if they are quantized. If a node scales a mesh unevenly, the
 * scaled positions count; if several nodes scale it differently, the first one does.
 *
 * An edge stays if its flip would shift a texture too far.
 *
 * The logger of the document gets a line with the number of flips, of edges that are still not Delaunay, and of edges
 * that stay for the texture.
 *
 * @throws {@link EdgeflipError} `invalid-option`. The transform throws errors about a mesh, the options or the backend;
 * primitives before that mesh have changed then.
 */
export function delaunay(options: DelaunayOptions = {}): Transform {
  const settings: DelaunayOptions = { ...optionsOf(options, OPTIONS) };
  const transform = (document: Document) => transformed(document, settings);
  return Object.defineProperty(transform, 'name', { value: NAME });
}

const NAME = 'delaunay';

async function transformed(document: Document, options: DelaunayOptions): Promise<void> {
  const logger = document.getLogger();
  let [flips, changed, done, flat, shiftEdges] = [0, 0, 0, 0, 0];
  const largest = new Map<string, number>();
  const remaining: Reasons = {};
  const alike = surfacesOf(document, logger);
  if (options.constraints !== undefined && alike.length > 1) {
    const why = `its vertices are those of one primitive, and the document has ${alike.length}`;
    throw new EdgeflipError('invalid-option', `option constraints: ${why}`);
  }
  const limits = limitsIn(alike, options);
  for (const { name, primitives, stretch } of alike) {
    if (options.signal?.aborted) break;
    done += 1;
    const { indices, ...result } = await flipped(primitives[0]!, stretch, limits, options).catch((cause: unknown) => {
      if (!(cause instanceof EdgeflipError)) throw cause;
      throw new EdgeflipError(cause.code, `${name}: ${cause.message}`, { cause });
    });
    flips += result.flips;
    flat += result.flat;
    shiftEdges += result.shiftEdges;
    for (const [name, shift] of Object.entries(result.largestShifts ?? {})) {
      largest.set(name, Math.max(largest.get(name) ?? 0, shift));
    }
    for (const [reason, count] of Object.entries(result.remaining)) {
      remaining[reason as Reason] = (remaining[reason as Reason] ?? 0) + count;
    }
    if (result.flips + result.turnedTriangles + result.crossedEdges === 0) continue;
    changed += 1;
    write(document, primitives, indices);
  }
  const reasons = Object.entries(remaining).map(([reason, count]) => `${reason} ${count}`);
  const rest =
    reasons.length > 0 ? `edges that are still not Delaunay: ${reasons.join(', ')}` : 'every edge is Delaunay';
  const areas = flat > 0 ? `; triangles of no area: ${flat}` : '';
  const stopped = done < alike.length ? `; stopped after ${done}` : '';
  const shifts = [...largest].map(([name, shift]) => `${name} ${Number(shift.toPrecision(3))}`).join(', ');
  const shifted = shiftEdges > 0 ? `; maxAttributeShift locked ${shiftEdges} edges; largest shifts: ${shifts}` : '';
  logger.info(
    `${NAME}: ${flips} flips in ${changed} of ${alike.length} primitives${stopped}; ${rest}${areas}${shifted}`,
  );
}

async function flipped(
  primitive: Primitive,
  stretch: Matrix | undefined,
  most: ReadonlyMap<string, number>,
  { maxAttributeShift: _, plane, ...options }: DelaunayOptions,
): Promise<Result & ShiftResult> {
  const limits = [...most].flatMap(([name, most]) => {
    const attribute = primitive.getAttribute(name);
    return attribute ? { name, ...numbersOf(attribute), most } : [];
  });
  const joining = options.weld === false ? 'none' : options.weld ? 'all' : 'equal';
  const given = meshOf(surfaceOf(primitive, stretch), plane, options);
  const limited: Limited = { limits, joining };
  const { result, ...shifts } = await runWithin(limited, ...given, async (mesh, options) => ({
    result: await makeDelaunay(mesh, options),
  }));
  return { ...result, ...shifts };
}

/** The largest shifts that are allowed, for the attributes of all primitives. */
function limitsIn(
  alike: readonly Alike[],
  { maxAttributeShift, weld, constraints }: DelaunayOptions,
): Map<string, number> {
  const semantics = alike.flatMap(({ primitives }) => primitives[0]!.listSemantics());
  const names = [...new Set(semantics)].filter((name) => name !== 'POSITION');
  return limitsOf(
    maxAttributeShift,
    names,
    (name) => name.startsWith('TEXCOORD_'),
    weld === true || constraints !== undefined,
  );
}

/** The numbers of an accessor that the shaders get. */
function numbersOf(accessor: Accessor): { values: Float64Array; width: number } {
  const [count, width] = [accessor.getCount(), accessor.getElementSize()];
  const [values, element] = [new Float64Array(count * width), new Array<number>(width)];
  for (let i = 0; i < count; i++) values.set(accessor.getElement(i, element), width * i);
  return { values, width };
}

/** Primitives with the same vertices, triangles and placement. */
interface Alike {
  /** The name of the first one, for messages. */
  name: string;
  primitives: Primitive[];
  stretch: Matrix | undefined;
}

/** All primitives that are lists of triangles. */
function surfacesOf(document: Document, logger: ILogger): Alike[] {
  const [alike, seen, ids] = [new Map<string, Alike>(), new Set<Primitive>(), new Map<Accessor | null, number>()];
  const idOf = (accessor: Accessor | null) => ids.get(accessor) ?? ids.set(accessor, ids.size).size - 1;
  const stretchOf = stretches(document);
  for (const [m, mesh] of document.getRoot().listMeshes().entries()) {
    for (const [p, primitive] of mesh.listPrimitives().entries()) {
      const [mode, name] = [primitive.getMode(), `mesh ${m} ('${mesh.getName()}'), primitive ${p}`];
      if (mode === TRIANGLE_STRIP || mode === TRIANGLE_FAN) {
        logger.warn(`${NAME}: ${name}: a triangle ${mode === TRIANGLE_FAN ? 'fan' : 'strip'} stays as it is`);
      }
      const positions = primitive.getAttribute('POSITION');
      if (mode !== TRIANGLES || !positions?.getCount() || seen.has(primitive)) continue;
      seen.add(primitive);
      const stretch = stretchOf.get(mesh);
      const accessors = [primitive.getIndices(), positions, ...attributesOf(primitive)];
      const key = JSON.stringify([accessors.map(idOf), stretch]);
      const found = alike.get(key);
      if (found) found.primitives.push(primitive);
      else alike.set(key, { name, primitives: [primitive], stretch });
    }
  }
  return [...alike.values()];
}

/** All attributes except the positions. */
function attributesOf(primitive: Primitive): Accessor[] {
  const positions = primitive.getAttribute('POSITION');
  const targets = primitive.listTargets().flatMap((target) => target.listAttributes());
  return [...primitive.listAttributes().filter((accessor) => accessor !== positions), ...targets];
}

function surfaceOf(primitive: Primitive, stretch: Matrix | undefined): Surface {
  const accessor = primitive.getAttribute('POSITION')!;
  const vertices = accessor.getCount();
  const given = columnsOf(accessor);
  let positions = given;
  if (stretch) {
    const scaled = stretch.map((number) => number / unitOf(given));
    positions = { ...given, array: stretched(pointsOf(given, vertices), scaled), isNormalized: false };
  }
  const attributes = attributesOf(primitive).map((attribute) => {
    const count = attribute.getCount();
    if (count === vertices) return columnsOf(attribute);
    throw new EdgeflipError('invalid-input', `an attribute has ${count} vertices, and POSITION has ${vertices}`);
  });
  const indices = (primitive.getIndices()?.getArray() as Surface['indices'] | null) ?? sequence(0, vertices);
  return { vertices, positions, attributes, indices };
}

function columnsOf(accessor: Accessor): Columns {
  const width = accessor.getElementSize();
  return { array: accessor.getArray()!, width, stride: width, offset: 0, isNormalized: accessor.getNormalized() };
}

/** Gives the primitives their new indices, and changes no indices of other primitives. */
function write(document: Document, primitives: readonly Primitive[], indices: Uint32Array): void {
  const [old, root] = [primitives[0]!.getIndices(), document.getRoot()];
  const positions = primitives[0]!.getAttribute('POSITION')!;
  // 65535 is no index of 16 bits in glTF.
  const array = old?.getArray() ?? (positions.getCount() < 2 ** 16 ? new Uint16Array() : new Uint32Array());
  const owners = old?.listParents().filter((owner) => owner !== root) ?? [];
  const isOurs = owners.every((owner) => primitives.includes(owner as Primitive));
  const accessor = old ? (isOurs ? old : old.clone()) : document.createAccessor('', positions.getBuffer());
  accessor.setArray(new (array.constructor as Uint32ArrayConstructor)(indices));
  for (const primitive of primitives) primitive.setIndices(accessor);
}
