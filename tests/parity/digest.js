/** FNV-1a with 64 bits over the little-endian bytes of the words so far, as in tests/native/simulation/digest.rs. */
export class Digest {
  #high = 0xcbf29ce4;
  #low = 0x84222325;

  /** @param {Uint32Array} words - The first words. */
  constructor(words) {
    this.feed(words);
  }

  /** @param {Uint32Array} words */
  feed(words) {
    let high = this.#high;
    let low = this.#low;
    for (const word of words) {
      for (let shift = 0; shift < 32; shift += 8) {
        low = (low ^ ((word >>> shift) & 0xff)) >>> 0;
        // Times 2^40 + 435; a double holds the product with 435.
        const product = low * 435;
        high = (Math.imul(high, 435) + Math.floor(product / 2 ** 32) + (low << 8)) >>> 0;
        low = product >>> 0;
      }
    }
    this.#high = high;
    this.#low = low;
  }

  toString() {
    return [this.#high, this.#low].map((half) => half.toString(16).padStart(8, '0')).join('');
  }
}
