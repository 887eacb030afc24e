/** The generated meshes that the page offers. `spec` names a family of the crate. */

export interface Sample {
  spec: string;
  name: string;
}

export const SAMPLES: readonly { group: string; samples: readonly Sample[] }[] = [
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
export const FIRST = 'uvsphere 28 0.1';
