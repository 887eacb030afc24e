/** What the shader of a surface reads: for each corner of each triangle its position, and the states of the sides. */

import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  FloatType,
  InstancedBufferAttribute,
  RedIntegerFormat,
  RGBAFormat,
  Sphere,
  StorageBufferAttribute,
  UnsignedIntType,
  Vector3,
  type Node,
} from 'three/webgpu';
import { attribute, ivec2, storage, textureLoad, uint, vec3, vertexIndex } from 'three/tsl';
import type { Drawn } from './run.ts';

/** Lets an attribute use a buffer directly. */
export type Sharing = <A extends BufferAttribute>(attribute: A, buffer: GPUBuffer, count: number) => A;

/**
 * The corners of triangles, drawn without an index buffer, so that the shader knows which corner of its triangle each
 * one is.
 */
export interface Corners {
  readonly geometry: BufferGeometry;
  /** The position of the corner. */
  readonly position: Node<'vec3'>;
  /** The numbers of the vertex in the colours of its file. */
  readonly colours: Node<'vec4'>;
  /** The states of the sides of its triangle: 4 bits each, that of side k from bit 4k. */
  readonly sides: Node<'uint'>;
  /** 3 numbers for each vertex. */
  setPositions(positions: Float32Array): void;
  /** 4 numbers for each vertex, or none. They are copied to the GPU. */
  setColours(colours: Float32Array | undefined): void;
  /** `count` is the number of indices. An array is copied to the GPU at each call. */
  setTriangles(drawn: Drawn, count: number): void;
  /** One number for each triangle, or none. An array is copied to the GPU at each call. */
  setSides(drawn: Drawn | undefined): void;
  /** Releases all buffers. */
  clear(): void;
}

/** A geometry without an index. Its only position tells three.js how many corners there are. */
function geometryFor(count: number): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', Object.assign(new InstancedBufferAttribute(new Float32Array(3), 3), { count }));
  geometry.boundingSphere = new Sphere(new Vector3(), 1);
  return geometry;
}

/** Reads from buffers of the device, also from those that the flips write. */
export class BufferCorners implements Corners {
  readonly #device: GPUDevice;
  readonly #share: Sharing;
  readonly #positions = storage(new StorageBufferAttribute(new Float32Array(1), 1), 'float', 1).toReadOnly();
  readonly #triangles = storage(new StorageBufferAttribute(new Uint32Array(1), 1), 'uint', 1).toReadOnly();
  /** In place of a buffer that may be destroyed. */
  readonly #none = new StorageBufferAttribute(new Uint32Array(1), 1);
  readonly #sides = storage(this.#none, 'uint', 1).toReadOnly();
  readonly #noColours = new StorageBufferAttribute(new Float32Array(4), 4);
  readonly #colours = storage(this.#noColours, 'vec4', 1).toReadOnly();
  readonly #attributes = new WeakMap<GPUBuffer, StorageBufferAttribute>();
  /** The buffers for arrays. */
  readonly #own = new Map<Float32Array | Uint32Array, GPUBuffer>();
  geometry = geometryFor(0);
  readonly position: Node<'vec3'>;
  readonly colours: Node<'vec4'>;
  readonly sides: Node<'uint'>;

  constructor(device: GPUDevice, share: Sharing) {
    this.#device = device;
    this.#share = share;
    const at = this.#triangles.element(vertexIndex).mul(3);
    const [x, y, z] = [at, at.add(1), at.add(2)] as const;
    const numbers = this.#positions;
    this.position = vec3(numbers.element(x), numbers.element(y), numbers.element(z));
    this.colours = this.#colours.element(this.#triangles.element(vertexIndex));
    this.sides = this.#sides.element(vertexIndex.div(3));
  }

  setPositions(positions: Float32Array): void {
    this.#positions.value = this.#attribute(this.#copy(positions, 'positions'));
  }

  setColours(colours: Float32Array | undefined): void {
    this.#colours.value = colours ? this.#attribute(this.#copy(colours, 'colours')) : this.#noColours;
  }

  setTriangles(drawn: Drawn, count: number): void {
    this.#triangles.value = this.#attribute(drawn instanceof Uint32Array ? this.#copy(drawn, 'triangles') : drawn);
    if (this.geometry.attributes['position']?.count === count) return;
    this.geometry.dispose();
    this.geometry = geometryFor(count);
  }

  setSides(drawn: Drawn | undefined): void {
    if (!drawn) this.#sides.value = this.#none;
    else this.#sides.value = this.#attribute(drawn instanceof Uint32Array ? this.#copy(drawn, 'sides') : drawn);
  }

  clear(): void {
    this.setSides(undefined);
    this.setColours(undefined);
    for (const buffer of this.#own.values()) buffer.destroy();
    this.#own.clear();
    this.geometry.dispose();
    this.geometry = geometryFor(0);
  }

  /** A buffer with the numbers of an array. */
  #copy(array: Float32Array | Uint32Array, what: string): GPUBuffer {
    let buffer = this.#own.get(array);
    if (!buffer) {
      const usage = GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST;
      buffer = this.#device.createBuffer({ label: `copied ${what}`, size: array.byteLength, usage });
      this.#own.set(array, buffer);
    }
    this.#device.queue.writeBuffer(buffer, 0, array as Uint32Array<ArrayBuffer>);
    return buffer;
  }

  #attribute(buffer: GPUBuffer): StorageBufferAttribute {
    let found = this.#attributes.get(buffer);
    if (!found) {
      found = this.#share(new StorageBufferAttribute(new Uint32Array(), 1), buffer, buffer.size / 4);
      this.#attributes.set(buffer, found);
    }
    return found;
  }
}

/** The entries of a row of a texture. */
const ROW = 2048;

/** Reads from textures and a vertex buffer, for WebGL2, whose shaders cannot read from other buffers. */
export class TextureCorners implements Corners {
  readonly #positions: ReturnType<typeof textureLoad>;
  readonly #colours: ReturnType<typeof textureLoad>;
  readonly #sides: ReturnType<typeof textureLoad>;
  #triangles: Uint32Array | undefined;
  geometry = geometryFor(0);
  readonly position: Node<'vec3'>;
  readonly colours: Node<'vec4'>;
  readonly sides: Node<'uint'>;

  constructor() {
    const place = (at: Node<'uint'>) => ivec2(at.mod(uint(ROW)).toInt(), at.div(uint(ROW)).toInt());
    const vertex = place(attribute<'uint'>('corner', 'uint'));
    this.#positions = textureLoad(floatsFor(0), vertex);
    this.#colours = textureLoad(floatsFor(0), vertex);
    this.#sides = textureLoad(wordsFor(0), place(vertexIndex.div(uint(3)) as Node<'uint'>));
    this.position = this.#positions.xyz;
    this.colours = this.#colours as unknown as Node<'vec4'>;
    this.sides = this.#sides.x.toUint();
  }

  setPositions(positions: Float32Array): void {
    const texture = floatsFor(positions.length / 3);
    const data = texture.image.data as Float32Array;
    for (let v = 0, i = 0; i < positions.length; v += 4, i += 3) {
      data[v] = positions[i]!;
      data[v + 1] = positions[i + 1]!;
      data[v + 2] = positions[i + 2]!;
    }
    this.#positions.value.dispose();
    this.#positions.value = texture;
  }

  setColours(colours: Float32Array | undefined): void {
    const texture = floatsFor((colours?.length ?? 0) / 4);
    if (colours) (texture.image.data as Float32Array).set(colours);
    this.#colours.value.dispose();
    this.#colours.value = texture;
  }

  setTriangles(drawn: Drawn, count: number): void {
    if (!(drawn instanceof Uint32Array)) throw new Error('WebGL2 cannot draw from a buffer of WebGPU');
    if (this.#triangles === drawn) {
      this.geometry.attributes['corner']!.needsUpdate = true;
      return;
    }
    this.geometry.dispose();
    this.geometry = geometryFor(count);
    this.geometry.setAttribute('corner', new BufferAttribute(drawn, 1));
    this.#triangles = drawn;
  }

  setSides(drawn: Drawn | undefined): void {
    if (!drawn) return;
    if (!(drawn instanceof Uint32Array)) throw new Error('WebGL2 cannot draw from a buffer of WebGPU');
    let texture = this.#sides.value as DataTexture;
    if (texture.image.height !== rowsFor(drawn.length)) {
      texture.dispose();
      texture = wordsFor(drawn.length);
      this.#sides.value = texture;
    }
    (texture.image.data as Uint32Array).set(drawn);
    texture.needsUpdate = true;
  }

  clear(): void {
    this.geometry.dispose();
    this.geometry = geometryFor(0);
    this.#triangles = undefined;
    for (const texture of [this.#positions, this.#sides]) texture.value.dispose();
    this.#positions.value = floatsFor(0);
    this.setColours(undefined);
    this.#sides.value = wordsFor(0);
  }
}

const rowsFor = (entries: number) => Math.max(1, Math.ceil(entries / ROW));

/** A texture with four floats for each entry, and one with an integer for each entry. */
function floatsFor(entries: number): DataTexture {
  const rows = rowsFor(entries);
  const texture = new DataTexture(new Float32Array(4 * ROW * rows), ROW, rows, RGBAFormat, FloatType);
  texture.needsUpdate = true;
  return texture;
}

function wordsFor(entries: number): DataTexture {
  const rows = rowsFor(entries);
  const texture = new DataTexture(new Uint32Array(ROW * rows), ROW, rows, RedIntegerFormat, UnsignedIntType);
  texture.needsUpdate = true;
  return texture;
}
