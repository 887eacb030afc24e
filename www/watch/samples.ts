/** The meshes that the page offers. `spec` names a family of the crate, or a file of `www/models/`. */

export interface Sample {
  spec: string;
  name: string;
  /** The β that suits it, if it is not that of most meshes. */
  beta?: number;
}

/** The folder of the files. */
export const BROUGHT = 'models/';

export const SAMPLES: readonly { group: string; samples: readonly Sample[] }[] = [
  {
    group: 'Real meshes',
    samples: [
      // A scan has no sharp edges to keep.
      { spec: 'models/bunny.ply', name: 'Stanford bunny with random flips', beta: 30 },
      { spec: 'models/flange.ply', name: 'Flange, cut from solids' },
    ],
  },
  {
    group: 'Surfaces',
    samples: [
      { spec: 'uvsphere 28 0.1', name: 'Sphere, 1,568 triangles' },
      { spec: 'uvsphere 100', name: 'Paper’s mesh 3, 20,000 triangles' },
      { spec: 'uvsphere 600', name: 'Paper’s mesh 5, 720,000 triangles' },
      { spec: 'roof 16', name: 'Roof with a sharp ridge' },
      { spec: 'pole 60', name: 'Two poles' },
    ],
  },
  {
    group: 'Plane',
    samples: [
      { spec: 'strips 16', name: 'Paper’s worst case, 16 nodes' },
      { spec: 'strips 200', name: 'Worst case, 200 nodes' },
      { spec: 'strips 1000', name: 'Worst case, 1,000 nodes' },
      { spec: 'shear 16', name: 'Sheared lattice' },
      { spec: 'random 24', name: 'Random points' },
      { spec: 'sweep 300', name: 'Slivers of a sweep' },
      { spec: 'regular 16', name: 'Regular lattice: all ties, no flip' },
      { spec: 'random 500', name: 'Random points, 498,000 triangles' },
    ],
  },
];

/** The sample that is shown when the page opens. */
export const FIRST = 'models/bunny.ply';

export function sampleOf(spec: string): Sample {
  const found = SAMPLES.flatMap(({ samples }) => samples).find((sample) => sample.spec === spec);
  return found ?? { spec, name: spec };
}
