/**
 * The seams of a mesh: the edges that stay to keep an attribute of its file. It runs in a worker, and is loaded when it is
 * needed.
 */

import { readMesh, weld, type FileMesh } from 'edgeflip/files';
import { contentOfKept, GLTF, unpacked, type Kept } from './files.ts';
import { GltfFile, type Part } from './gltf-file.ts';
import { widthOf } from './plan.ts';
import { next } from './quad.ts';
import { keyOf, placeOf, type Seam, type Seams } from './seam.ts';

/** The names of what differs where two primitives meet. */
const [MATERIAL, PRIMITIVE] = ['material', 'primitive'];

/** The seams that are found so far: edges by their keys, for each seam. */
class Found {
  readonly seams: Seam[] = [];
  readonly #keys: number[][] = [];
  readonly #vertices: number;

  constructor(vertices: number) {
    this.#vertices = vertices;
  }

  /** Begins a seam, and returns its number. */
  begin(seam: Seam): number {
    this.#keys.push([]);
    return this.seams.push(seam) - 1;
  }

  add(seam: number, a: number, b: number): void {
    this.#keys[seam]!.push(keyOf(a, b, this.#vertices));
  }

  get result(): Seams {
    const all = Float64Array.from(this.#keys.flat()).sort();
    const edges = all.filter((key, i) => i === 0 || key !== all[i - 1]);
    const bits = new Uint32Array(edges.length);
    this.#keys.forEach((keys, seam) => {
      for (const key of keys) bits[placeOf(key, edges)]! |= 1 << seam;
    });
    return { seams: this.seams, edges, bits, vertices: this.#vertices };
  }
}

/** The most seams that are told apart: a bit for each. */
const MOST = 32;

/** The seams of a mesh as it was read from its file. */
export async function seamsOf(mesh: FileMesh, kept: Kept): Promise<Seams> {
  const found = new Found(mesh.positions.length / widthOf(mesh));
  for (const { name, edges } of mesh.attributeEdges.slice(0, MOST / 2)) {
    const others = mesh.attributeEdges.map((other) => other.name).filter((other) => other !== name);
    const { bytes, beside } = await contentOfKept(kept);
    const { dimension, plane } = mesh;
    const options = { ignoreAttributes: others, files: Object.fromEntries(beside), dimension, plane };
    addLocks(found, await readMesh(bytes, kept.name, options), { name, edges });
  }
  await addRims(
    found,
    mesh,
    GLTF.test(kept.name) ? await GltfFile.of(await unpacked(await contentOfKept(kept))) : undefined,
  );
  return found.result;
}

/** Adds the edges of a mesh that is locked to keep one attribute only. */
function addLocks(found: Found, { indices, groups, lockedEdges, lockedTriangles }: FileMesh, of: Omit<Seam, 'kind'>) {
  if (groups) {
    const border = found.begin({ ...of, kind: 'border' });
    const ends = endsOf(indices);
    forEachEdge(indices, ends, (halves) => {
      const first = halves[0]!;
      const group = (h: number) => groups[Math.floor(h / 3)];
      if (halves.some((h) => group(h) !== group(first))) found.add(border, indices[first]!, ends[first]!);
    });
  }
  if (!lockedEdges && !lockedTriangles) return;
  const seam = found.begin({ ...of, kind: 'seam' });
  for (let i = 0; i < (lockedEdges?.length ?? 0); i += 2) found.add(seam, lockedEdges![i]!, lockedEdges![i + 1]!);
  for (const triangle of lockedTriangles ?? []) {
    for (const h of [0, 1, 2].map((k) => 3 * triangle + k)) found.add(seam, indices[h]!, indices[next(h)]!);
  }
}

/** Adds the edges at which two boundaries meet: each side has vertices of its own. */
async function addRims(found: Found, mesh: FileMesh, file: GltfFile | undefined): Promise<void> {
  const { indices } = mesh;
  const [from, to]: number[][] = [[], []];
  const heads = endsOf(indices);
  forEachEdge(indices, heads, ([h, second]) => {
    if (second !== undefined) return;
    from!.push(indices[h!]!);
    to!.push(heads[h!]!);
  });
  const positions = mesh.placed ?? mesh.positions;
  const dimension = mesh.placed ? 3 : widthOf(mesh);
  const joined = await weld({ positions, indices, dimension });
  const { places } = joined;
  const vertices = positions.length / dimension;
  const parts = file?.parts(vertices, indices.length / 3);
  const differing = file && parts && differencesIn(file, parts);
  const seams = new Map<string, number>();
  const placed = (list: readonly number[]) => Uint32Array.from(list, (v) => places[v]!);
  forEachEdge(placed(from!), placed(to!), (edges) => {
    if (edges.length < 2) return;
    // The ends of an edge, in the order of their places.
    const ends = edges.map((e) => [from![e]!, to![e]!].sort((a, b) => places[a]! - places[b]!));
    const differ = (v: number, k: number) => [...(differing?.(v, ends[0]![k]!) ?? [])];
    const names = new Set(ends.flatMap((pair) => pair.flatMap(differ)));
    for (const name of names.size > 0 ? names : ['']) {
      if (!seams.has(name)) {
        if (found.seams.length === MOST) continue;
        const isMeeting = name === MATERIAL || name === PRIMITIVE;
        const kind = !differing ? 'unknown' : isMeeting ? 'meeting' : name === '' ? 'equal' : 'split';
        seams.set(name, found.begin({ name, edges: 0, kind }));
      }
      const seam = seams.get(name)!;
      found.seams[seam]!.edges++;
      for (const [a, b] of ends) found.add(seam, a!, b!);
    }
  });
  joined.free();
}

/** A function that says which attributes of two vertices differ. */
function differencesIn(file: GltfFile, parts: readonly Part[]): (u: number, v: number) => Set<string> {
  const partAt = (vertex: number) => parts.findLast(({ first }) => first <= vertex)!;
  return (u, v) => {
    const names = new Set<string>();
    if (u === v) return names;
    const [p, q] = [partAt(u), partAt(v)];
    if (p !== q) return names.add(p.primitive.material === q.primitive.material ? PRIMITIVE! : MATERIAL!);
    const element = (vertex: number) => (p.elements ? p.elements[vertex - p.first]! : vertex - p.first);
    for (const name of Object.keys(p.primitive.attributes)) {
      const accessor = name === 'POSITION' ? undefined : file.attribute(p.primitive, name);
      const [x, y]: number[][] = [[], []];
      accessor?.getElement(element(u), x!);
      accessor?.getElement(element(v), y!);
      if (x!.some((number, k) => number !== y![k])) names.add(name);
    }
    return names;
  };
}

/** For each half-edge, the vertex where it ends. */
const endsOf = (indices: Uint32Array) => indices.map((_, h) => indices[next(h)]!);

/** Calls `visit` with each edge: the numbers of all that go from one end to the other, or back. */
function forEachEdge(from: Uint32Array, to: Uint32Array, visit: (numbers: readonly number[]) => void): void {
  const least = from.map((a, i) => Math.min(a, to[i]!));
  const starts = new Uint32Array(least.reduce((most, v) => Math.max(most, v), 0) + 2);
  for (const v of least) starts[v + 1]!++;
  for (let v = 1; v < starts.length; v++) starts[v]! += starts[v - 1]!;
  const [ends, sorted] = [starts.slice(), new Uint32Array(from.length)];
  least.forEach((v, i) => (sorted[ends[v]!++] = i));
  for (let v = 0; v + 1 < starts.length; v++) {
    const others = new Map<number, number[]>();
    for (const i of sorted.subarray(starts[v], starts[v + 1])) {
      const other = Math.max(from[i]!, to[i]!);
      const known = others.get(other);
      if (known) known.push(i);
      else if (other !== v) others.set(other, [i]);
    }
    for (const numbers of others.values()) visit(numbers);
  }
}
