// A screenshot of the canvas. Decodes as much of PNG as screenshots need.

import assert from 'node:assert/strict';
import { inflateSync } from 'node:zlib';

export class Picture {
  /** @param {Uint8Array} png - 8 bits per channel, RGB or RGBA, not interlaced, as browsers write it. */
  constructor(png) {
    const bytes = Buffer.from(png);
    const parts = [];
    for (let at = 8; at < bytes.length; at += bytes.readUInt32BE(at) + 12) {
      const [type, data] = [
        bytes.toString('latin1', at + 4, at + 8),
        bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at)),
      ];
      if (type === 'IHDR') {
        this.width = data.readUInt32BE(0);
        this.height = data.readUInt32BE(4);
        assert.equal(data[8], 8, 'bits a channel');
        assert.ok(data[9] === 2 || data[9] === 6, 'RGB or RGBA');
        this.channels = data[9] === 2 ? 3 : 4;
        assert.equal(data[12], 0, 'not interlaced');
      }
      if (type === 'IDAT') parts.push(data);
    }
    const channels = this.#unfilter(inflateSync(Buffer.concat(parts)));
    /** The colours of the pixels, one number each. */
    this.pixels = Uint32Array.from({ length: this.width * this.height }, (_, i) => {
      const at = this.channels * i;
      return (channels[at] << 16) | (channels[at + 1] << 8) | channels[at + 2];
    });
  }

  /**
   * PNG specification, section 9: a prediction from the bytes left (a), above (b) and above left (c) was subtracted.
   */
  #unfilter(rows) {
    const { width, height, channels } = this;
    const stride = width * channels;
    const pixels = new Uint8Array(stride * height);
    for (let y = 0; y < height; y++) {
      const filter = rows[y * (stride + 1)];
      for (let x = 0; x < stride; x++) {
        const at = y * stride + x;
        const a = x < channels ? 0 : pixels[at - channels];
        const b = y === 0 ? 0 : pixels[at - stride];
        const c = x < channels || y === 0 ? 0 : pixels[at - stride - channels];
        pixels[at] = rows[y * (stride + 1) + 1 + x] + [0, a, b, (a + b) >> 1, paeth(a, b, c)][filter];
      }
    }
    return pixels;
  }

  /** The number of colours. */
  get colours() {
    return new Set(this.pixels).size;
  }

  /** The share of pixels that differ from another picture. */
  differsFrom({ pixels }) {
    assert.equal(pixels.length, this.pixels.length);
    return this.pixels.reduce((count, colour, i) => count + Number(colour !== pixels[i]), 0) / pixels.length;
  }
}

function paeth(a, b, c) {
  const [toA, toB, toC] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
  if (toA <= toB && toA <= toC) return a;
  return toB <= toC ? b : c;
}
