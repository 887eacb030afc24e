/** A surface in the colours of its file. It is loaded when a file has colours. */

import {
  DataArrayTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  RepeatWrapping,
  SRGBColorSpace,
  type Node,
} from 'three/webgpu';
import { dFdx, dFdy, float, floor, select, sRGBTransferEOTF, sRGBTransferOETF, texture, uint } from 'three/tsl';
import { varying, vec2, vec3 } from 'three/tsl';
import { BITS, REPEAT, SHARP, WRAPS, type FileColours } from './colour-format.ts';
import type { Corners } from './corners.ts';

export class FileSurface {
  /** The numbers of the vertices, for {@link Corners.setColours}. */
  readonly vertices: Float32Array;
  readonly #texture: DataArrayTexture | undefined;
  readonly #size: number;

  constructor({ vertices, layers }: FileColours) {
    this.vertices = vertices;
    this.#size = layers?.size ?? 1;
    if (!layers) return;
    const { pixels, size, count } = layers;
    this.#texture = Object.assign(new DataArrayTexture(pixels, size, size, count), {
      wrapS: RepeatWrapping,
      wrapT: RepeatWrapping,
      magFilter: LinearFilter,
      minFilter: LinearMipmapLinearFilter,
      generateMipmaps: true,
      colorSpace: SRGBColorSpace,
      needsUpdate: true,
    });
  }

  dispose(): void {
    this.#texture?.dispose();
  }

  /** The colour at a point of a triangle, in sRGB, without light. Call it in a function of the shader. */
  colour(corners: Corners): Node<'vec3'> {
    const numbers = corners.colours;
    const channels = numbers.z.toUint();
    const byte = (from: number) => channels.shiftRight(uint(from)).bitAnd(uint(255)).toFloat().div(255);
    // Colours are mixed in linear light.
    const linear = sRGBTransferEOTF(vec3(byte(16), byte(8), byte(0))) as Node<'vec3'>;
    const colour = varying(linear);
    const whole = this.#texture ? colour.mul(this.#texel(this.#texture, numbers)) : colour;
    return sRGBTransferOETF(whole) as Node<'vec3'>;
  }

  /** The texture, in linear light; white where there is none. */
  #texel(layers: DataArrayTexture, numbers: Node<'vec4'>): Node<'vec3'> {
    const at = varying(numbers.xy).toVar() as Node<'vec2'>;
    const bits = varying(numbers.w).add(0.5).toUint().toVar() as Node<'uint'>;
    const layer = bits.bitAnd(uint((1 << WRAPS) - 1));
    const way = (from: number) => bits.shiftRight(uint(from)).bitAnd(uint((1 << BITS) - 1));
    // Where the coordinates jump, the size of a texel does not.
    const inside = vec2(this.#within(at.x, way(WRAPS)), this.#within(at.y, way(WRAPS + BITS)));
    // The middle of a pixel.
    const sharp = floor(inside.mul(this.#size)).add(0.5).div(this.#size);
    const point = select(bits.shiftRight(uint(SHARP)).equal(uint(0)), inside, sharp);
    const isNone = layer.equal(uint(0));
    const place = select(isNone, uint(0), layer.sub(uint(1))).toInt();
    const found = texture(layers, point).depth(place).grad(dFdx(at), dFdy(at));
    return select(isNone, vec3(1), found.xyz) as Node<'vec3'>;
  }

  /** A coordinate as the texture continues beyond its border. The texture itself repeats. */
  #within(x: Node<'float'>, way: Node<'uint'>): Node<'float'> {
    const half = 0.5 / this.#size;
    const pair = x.sub(floor(x.div(2)).mul(2));
    const mirrored = float(1).sub(pair.sub(1).abs());
    const kept = select(way.equal(uint(REPEAT.clamp)), x, mirrored).clamp(half, 1 - half);
    return select(way.equal(uint(REPEAT.repeat)), x, kept) as Node<'float'>;
  }
}
