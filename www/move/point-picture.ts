/** Draws points, their triangles, and the hull around them. */

import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import { LineSegments2 } from 'three/addons/lines/webgpu/LineSegments2.js';
import {
  CircleGeometry,
  Color,
  DynamicDrawUsage,
  Group,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Mesh,
  MeshBasicNodeMaterial,
  type InterleavedBufferAttribute,
  type Line2NodeMaterial,
} from 'three/webgpu';
import { attribute, positionLocal, uniform, vec3 } from 'three/tsl';
import { lineMaterial } from '../watch/line-material.ts';
import type { Palette } from '../watch/palette.ts';
import type { MovingPicture } from './moving-mesh.ts';
import { MovingSurface } from './moving-surface.ts';

/** Pixels: the width of the hull, and the radius of a point and of the one that is held. */
const [HULL, DOT, HELD] = [2, 1.8, 6];

export class PointPicture implements MovingPicture {
  readonly object = new Group();
  readonly #triangles: MovingSurface;
  readonly #hull: LineSegments2;
  /** x, y, and the radius in pixels. */
  readonly #places: InstancedBufferAttribute;
  readonly #dots: Mesh<InstancedBufferGeometry, MeshBasicNodeMaterial>;
  readonly #colour = uniform(new Color());

  /** For so many points. `pixel` is the size of a pixel in the scene. */
  constructor(count: number, pixel: () => number) {
    this.#triangles = MovingSurface.onArrays(6 * count, 2);
    const material = lineMaterial({ linewidth: HULL });
    material.depthTest = false;
    this.#hull = new LineSegments2(new LineSegmentsGeometry(), material);
    this.#hull.geometry.setPositions(new Float32Array(6 * count));
    this.#places = new InstancedBufferAttribute(new Float32Array(3 * count), 3).setUsage(DynamicDrawUsage);
    const { index, attributes } = new CircleGeometry(1, 16);
    const discs = new InstancedBufferGeometry().setIndex(index);
    discs.setAttribute('position', attributes['position']!).setAttribute('place', this.#places);
    discs.instanceCount = count;
    this.#dots = new Mesh(discs, new MeshBasicNodeMaterial({ depthTest: false }));
    const [place, size] = [attribute<'vec3'>('place', 'vec3'), uniform(1)];
    this.#dots.material.positionNode = vec3(place.xy, 0).add(positionLocal.mul(place.z.mul(size)));
    this.#dots.material.colorNode = this.#colour;
    this.#dots.onBeforeRender = () => void (size.value = pixel());
    const parts = [this.#triangles.object, this.#hull, this.#dots];
    for (const [order, part] of parts.entries()) Object.assign(part, { renderOrder: order, frustumCulled: false });
    this.object.add(...parts);
  }

  fill(
    positions: Float32Array,
    indices: Uint32Array,
    flashed: Float32Array,
    hull: Uint32Array,
    held: number | undefined,
  ): void {
    this.#triangles.fill(positions, indices, flashed);
    const { data } = this.#hull.geometry.attributes['instanceStart'] as InterleavedBufferAttribute;
    hull.forEach((from, i) => {
      const to = hull[(i + 1) % hull.length]!;
      data.array.set(
        [positions[2 * from]!, positions[2 * from + 1]!, 0, positions[2 * to]!, positions[2 * to + 1]!],
        6 * i,
      );
    });
    data.needsUpdate = true;
    this.#hull.geometry.instanceCount = hull.length;
    const { array } = this.#places;
    for (let i = 0; 2 * i < positions.length; i++)
      array.set([positions[2 * i]!, positions[2 * i + 1]!, i === held ? HELD : DOT], 3 * i);
    this.#places.needsUpdate = true;
  }

  /** The seconds of the frame that is drawn. */
  set time(seconds: number) {
    this.#triangles.time = seconds;
  }

  setPalette(palette: Palette): void {
    this.#triangles.setPalette(palette);
    (this.#hull.material as Line2NodeMaterial).color.set(palette.states.boundary);
    this.#colour.value.set(palette.text);
  }

  dispose(): void {
    this.#triangles.dispose();
    for (const { geometry, material } of [this.#hull, this.#dots]) {
      geometry.dispose();
      material.dispose();
    }
  }
}
