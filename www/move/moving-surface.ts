/** Draws a mesh that moves: from the buffers of the GPU engine, or from arrays. Edges flash as they flip. */

import type { IndexedMesh } from 'edgeflip/files';
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  DynamicDrawUsage,
  Mesh,
  MeshBasicNodeMaterial,
  Sphere,
  StorageBufferAttribute,
  Vector3,
  type Node,
} from 'three/webgpu';
import {
  attribute,
  float,
  Fn,
  fwidth,
  max,
  mix,
  smoothstep,
  storage,
  uniform,
  varying,
  vec3,
  vertexIndex,
} from 'three/tsl';
import type { Sharing } from '../watch/corners.ts';
import { light } from '../watch/light.ts';
import type { Palette } from '../watch/palette.ts';
import type { MovingPicture } from './moving-mesh.ts';

/** Seconds in which the heat of an edge falls to a third. */
const COOLING = 0.38;

export class MovingSurface implements MovingPicture {
  readonly object: Mesh<BufferGeometry, MeshBasicNodeMaterial>;
  readonly #time = uniform(0);
  readonly #dimension: 2 | 3;
  readonly #colours = {
    lit: uniform(new Color()),
    shaded: uniform(new Color()),
    line: uniform(new Color()),
    spark: uniform(new Color()),
  };

  private constructor(geometry: BufferGeometry, flashed: Node<'vec3'>, dimension: 2 | 3, position?: Node<'vec3'>) {
    this.#dimension = dimension;
    geometry.boundingSphere = new Sphere(new Vector3(), 2);
    const material = new MeshBasicNodeMaterial({ side: DoubleSide });
    if (position) material.positionNode = position;
    material.colorNode = this.#paint(flashed);
    this.object = new Mesh(geometry, material);
    this.object.frustumCulled = false;
  }

  /** From buffers of the device: positions, triangles, and the moment at which each side of a triangle flipped. */
  static onBuffers(
    share: Sharing,
    positions: GPUBuffer,
    triangles: GPUBuffer,
    flashed: GPUBuffer,
    { positions: { length }, indices, dimension }: IndexedMesh,
  ): MovingSurface {
    const floats = () => new StorageBufferAttribute(new Float32Array(), 1);
    const numbers = storage(share(floats(), positions, length), 'float', length).toReadOnly();
    const words = new StorageBufferAttribute(new Uint32Array(), 1);
    const corners = storage(share(words, triangles, indices.length), 'uint', indices.length).toReadOnly();
    const moments = storage(share(floats(), flashed, indices.length), 'float', indices.length).toReadOnly();
    const at = corners.element(vertexIndex).mul(dimension);
    const position = vec3(
      numbers.element(at),
      numbers.element(at.add(1)),
      dimension === 3 ? numbers.element(at.add(2)) : float(0),
    );
    const first = vertexIndex.div(3).mul(3);
    const sides = vec3(moments.element(first), moments.element(first.add(1)), moments.element(first.add(2)));
    const geometry = new BufferGeometry();
    // Four bytes for each corner, which tell three.js only how many there are.
    geometry.setAttribute('position', new BufferAttribute(new Uint8Array(4 * indices.length), 4, true));
    return new MovingSurface(geometry, sides, dimension, position);
  }

  /** From arrays with at most so many corners of triangles, see {@link fill}. */
  static onArrays(corners: number, dimension: 2 | 3): MovingSurface {
    const geometry = new BufferGeometry();
    for (const name of ['position', 'flashed']) {
      const array = new BufferAttribute(new Float32Array(3 * corners), 3);
      geometry.setAttribute(name, array.setUsage(DynamicDrawUsage));
    }
    return new MovingSurface(geometry, attribute<'vec3'>('flashed', 'vec3'), dimension);
  }

  fill(positions: Float32Array, indices: Uint32Array, flashed: Float32Array): void {
    const attributes = this.object.geometry.attributes as Record<string, BufferAttribute>;
    const [at, moments] = [attributes['position']!, attributes['flashed']!];
    const dimension = this.#dimension;
    for (let i = 0; i < indices.length; i++) {
      const [first, from] = [i - (i % 3), dimension * indices[i]!];
      for (let k = 0; k < 3; k++) {
        at.array[3 * i + k] = k < dimension ? positions[from + k]! : 0;
        moments.array[3 * i + k] = flashed[first + k]!;
      }
    }
    at.needsUpdate = moments.needsUpdate = true;
    this.object.geometry.setDrawRange(0, indices.length);
  }

  /** The seconds of the frame that is drawn. */
  set time(seconds: number) {
    this.#time.value = seconds;
  }

  setPalette({ lit, shaded, plane, line, states }: Palette): void {
    const { lit: high, shaded: low, line: thin, spark } = this.#colours;
    high.value.set(this.#dimension === 3 ? lit : plane);
    low.value.set(this.#dimension === 3 ? shaded : plane);
    thin.value.set(line);
    spark.value.set(states.flips);
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
  }

  #paint(flashed: Node<'vec3'>) {
    const { lit, shaded, line, spark } = this.#colours;
    return Fn(() => {
      const corner = vertexIndex.mod(3);
      // The distances of a point from the sides, each as a share of the height of the triangle. Side k begins at
      // corner k, and faces corner k + 2.
      const distances = varying(
        vec3(corner.equal(2).select(1, 0), corner.equal(0).select(1, 0), corner.equal(1).select(1, 0)),
      );
      const heats = varying(this.#time.sub(flashed).div(-COOLING).exp());
      const heights = fwidth(distances);
      const pixels = distances.div(heights);
      // Where triangles have few pixels, their faces show what their lines cannot.
      const clear = smoothstep(0.15, 0.6, max(heights.x, max(heights.y, heights.z))).oneMinus();
      const face = mix(shaded, lit, light());
      const hottest = max(heats.x, max(heats.y, heats.z));
      const warm = mix(face, spark, hottest.mul(mix(float(0.8), float(0.14), clear)));
      const cover = (half: Node<'vec3'>) => half.sub(pixels).add(0.5).clamp(0, 1);
      const thin = cover(vec3(0.45));
      const lines = max(thin.x, max(thin.y, thin.z)).mul(clear).mul(0.75);
      const lined = mix(warm, line, max(lines, clear.oneMinus().mul(0.3)));
      const hot = cover(heats.mul(0.9).add(0.3)).mul(smoothstep(0.02, 0.5, heats));
      return mix(lined, spark, max(hot.x, max(hot.y, hot.z)));
    })();
  }
}
