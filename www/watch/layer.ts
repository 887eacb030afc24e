/** One picture of the mesh: its surface, the outlines of its triangles, and its edges in colours. */

import {
  type BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  Group,
  LineBasicNodeMaterial,
  LineSegments,
  Mesh,
  MeshBasicNodeMaterial,
  Sphere,
  Vector3,
} from 'three/webgpu';
import { mix, uniform } from 'three/tsl';
import { EdgeLines } from './edge-lines.ts';
import { light } from './light.ts';
import type { Palette } from './palette.ts';
import { FlipAnimation } from './flip-animation.ts';

/** The colours of surfaces. All layers share them. */
export class Materials {
  readonly #lit = uniform(new Color());
  readonly #shaded = uniform(new Color());
  readonly #plane = uniform(new Color());
  /** For surfaces in space, and for the plane. */
  readonly surfaces: Record<2 | 3, MeshBasicNodeMaterial>;
  readonly line = new LineBasicNodeMaterial({ transparent: true, opacity: 0.55 });

  constructor() {
    const make = () =>
      new MeshBasicNodeMaterial({
        side: DoubleSide,
        polygonOffset: true,
        polygonOffsetFactor: 1,
        polygonOffsetUnits: 1,
      });
    const [flat, solid] = [make(), make()];
    flat.colorNode = this.#plane;
    solid.colorNode = mix(this.#shaded, this.#lit, light());
    this.surfaces = { 2: flat, 3: solid };
  }

  setPalette({ lit, shaded, plane, line }: Palette): void {
    this.#lit.value.set(lit);
    this.#shaded.value.set(shaded);
    this.#plane.value.set(plane);
    this.line.color.set(line);
  }
}

export class Layer {
  readonly group = new Group();
  readonly edges = new EdgeLines();
  readonly flipAnimation = new FlipAnimation();
  readonly #surface: Mesh<BufferGeometry, MeshBasicNodeMaterial>;
  readonly #wire: LineSegments<BufferGeometry, LineBasicNodeMaterial>;
  readonly #materials: Materials;

  constructor(materials: Materials) {
    this.#materials = materials;
    this.#surface = new Mesh(new BufferGeometry(), materials.surfaces[3]);
    this.#wire = new LineSegments(new BufferGeometry(), materials.line);
    this.group.add(this.#surface, this.#wire, this.edges.group, this.flipAnimation.lines);
    for (const object of [this.#surface, this.#wire]) Object.assign(object, { frustumCulled: false, visible: false });
  }

  setPositions(positions: BufferAttribute, dimension: 2 | 3): void {
    for (const object of [this.#surface, this.#wire]) {
      object.geometry.setAttribute('position', positions);
      object.geometry.boundingSphere = new Sphere(new Vector3(), 1);
    }
    this.#surface.material = this.#materials.surfaces[dimension];
  }

  show(triangles: BufferAttribute, lines: BufferAttribute | undefined): void {
    this.#surface.geometry.setIndex(triangles);
    this.#surface.visible = true;
    this.#wire.visible = lines !== undefined;
    if (lines) this.#wire.geometry.setIndex(lines);
  }

  /** Shows nothing. Buffers of attributes for which `isShared` holds are not destroyed. */
  clear(isShared: (index: BufferAttribute) => boolean): void {
    this.edges.clear();
    this.flipAnimation.clear();
    for (const object of [this.#surface, this.#wire]) {
      object.visible = false;
      const { index } = object.geometry;
      if (index && isShared(index)) object.geometry.index = null;
      object.geometry.dispose();
      object.geometry = new BufferGeometry();
    }
  }
}
