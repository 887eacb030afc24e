// The meshes that the page offers, in their order.

/**
 * `spec` names a family of the crate, or a file that `models.js` writes; `drawn` is the mesh of its thumbnail, if it is
 * another one. `beta` is the β that suits it, if it is not that of most meshes; `plane` is that of a terrain.
 * @typedef {{ spec: string, name: string, short: string, what?: string, thumb: string, drawn?: string, beta?: number,
 *   plane?: import('edgeflip').Plane, credit?: string, licence?: string }} Sample
 */

/** The folder of the files. */
export const BROUGHT = 'models/';

const thumb = (name) => `thumbs/${name}.svg`;

/** @type {readonly Sample[]} */
export const SAMPLES = [
  {
    spec: 'models/bunny.ply',
    name: 'Stanford bunny',
    short: 'Bunny',
    what: 'A scan, edges scrambled',
    thumb: thumb('bunny'),
    // A scan has no sharp edges to keep.
    beta: 30,
    credit: 'Stanford 3D Scanning Repository',
    licence: 'public domain',
  },
  {
    spec: 'models/flange.obj',
    name: 'Flange',
    short: 'Flange',
    what: 'A part cut from solids, in four materials',
    thumb: thumb('flange'),
    credit: 'made with manifold-3d',
    licence: 'Apache-2.0',
  },
  {
    spec: 'models/terrain.obj',
    name: 'Terrain',
    short: 'Terrain',
    what: 'Judged from above, edges scrambled',
    thumb: thumb('terrain'),
    plane: 'xz',
    credit: 'noise of simplex-noise',
    licence: 'MIT',
  },
  {
    spec: 'models/suzi.glb',
    name: 'Suzanne',
    short: 'Suzanne',
    what: 'A glTF model, edges scrambled',
    thumb: thumb('suzanne'),
    beta: 30,
    credit: '@pmndrs/assets',
    licence: 'CC0',
  },
  { spec: 'uvsphere 28 0.1', name: 'Lumpy sphere', short: 'Sphere', thumb: thumb('sphere') },
  { spec: 'roof 16', name: 'Roof with a sharp ridge', short: 'Roof', thumb: thumb('roof') },
  { spec: 'pole 60', name: 'A vertex with 60 triangles', short: 'Pole', thumb: thumb('pole'), drawn: 'pole 24' },
  { spec: 'random 24', name: 'Random points', short: 'Points', thumb: thumb('points'), drawn: 'random 9' },
  { spec: 'shear 16', name: 'Sheared lattice', short: 'Sheared', thumb: thumb('sheared'), drawn: 'shear 8' },
  { spec: 'sweep 300', name: 'Slivers of a sweep', short: 'Slivers', thumb: thumb('slivers'), drawn: 'sweep 40' },
  {
    spec: 'regular 16',
    name: 'Regular lattice',
    short: 'Ties',
    what: 'All ties: no edge flips',
    thumb: thumb('ties'),
    drawn: 'regular 8',
  },
  { spec: 'strips 16', name: 'The paper’s worst case, 16 vertices', short: 'Worst case', thumb: thumb('worst') },
  {
    spec: 'strips 200',
    name: 'Worst case, 200 vertices',
    short: '200 vertices',
    thumb: thumb('worst-200'),
    drawn: 'strips 40',
  },
  {
    spec: 'strips 1000',
    name: 'Worst case, 1,000 vertices',
    short: '1,000 vertices',
    thumb: thumb('worst-1000'),
    drawn: 'strips 64',
  },
  {
    spec: 'uvsphere 100',
    name: 'The paper’s mesh 3',
    short: 'Mesh 3',
    thumb: thumb('mesh-3'),
    drawn: 'uvsphere 16',
  },
  {
    spec: 'uvsphere 600',
    name: 'The paper’s mesh 5',
    short: 'Mesh 5',
    thumb: thumb('mesh-5'),
    drawn: 'uvsphere 24',
  },
  {
    spec: 'random 500',
    name: 'Half a million triangles',
    short: 'Large',
    what: 'Random points',
    thumb: thumb('large'),
    drawn: 'random 20',
  },
];

/**
 * Meshes that move, and points; `kind` is the motion. The thumbnail is of the family `drawn`, with each vertex moved by `warp`,
 * or of points.
 * @typedef {{ kind: 'sheet' | 'waves' | 'relax' | 'points', spec: string, name: string, short: string, thumb: string,
 *   drawn?: string, warp?: (vertex: number[]) => number[] }} MovingSample
 */

/** @type {readonly MovingSample[]} */
export const MOVING = [
  {
    kind: 'sheet',
    spec: 'moving sheet',
    name: 'A sheet that twists',
    short: 'Twisting',
    thumb: thumb('sheet'),
    drawn: 'random 9',
    warp: ([x, y]) => {
      const [u, v] = [x - 0.5, y - 0.5];
      const angle = 1.4 * Math.exp(-8 * (u * u + v * v));
      return [Math.cos(angle) * u - Math.sin(angle) * v, Math.sin(angle) * u + Math.cos(angle) * v];
    },
  },
  {
    kind: 'waves',
    spec: 'moving waves',
    name: 'A sphere with waves',
    short: 'Waving',
    thumb: thumb('waves'),
    drawn: 'uvsphere 14',
    warp: ([x, y, z]) => {
      const wide = 1 + 0.3 * Math.sin(6 * z) * (1 - z * z);
      return [wide * y, z, wide * x];
    },
  },
  {
    kind: 'relax',
    spec: 'moving relax',
    name: 'Points that even out',
    short: 'Relaxing',
    thumb: thumb('relax'),
    drawn: 'random 10',
    warp: (vertex) => vertex.map((at) => (2 * at - 1) * (0.25 + 0.75 * Math.abs(2 * at - 1))),
  },
  {
    kind: 'points',
    spec: 'moving points',
    name: 'Points that move freely',
    short: 'Free points',
    thumb: thumb('free'),
  },
];

/**
 * Points in a disc of radius 1, as the seeds of a sunflower are, but closer together in the middle: x and y of each.
 * @param {number} count
 */
export function sunflower(count) {
  const golden = Math.PI * (3 - Math.sqrt(5));
  return Float32Array.from({ length: 2 * count }, (_, k) => {
    const i = k >> 1;
    return ((i + 0.5) / count) ** 0.55 * Math[k % 2 === 0 ? 'cos' : 'sin'](golden * i);
  });
}

/** The sample that is shown when the page opens. */
export const FIRST = 'models/bunny.ply';

/**
 * @param {string} spec
 * @returns {Sample}
 */
export function sampleOf(spec) {
  return SAMPLES.find((sample) => sample.spec === spec) ?? { spec, name: spec, short: spec, thumb: '' };
}
