/** The form in which the colours of a file come to the picture. */

/** The textures of a file, each scaled to the same square. */
export interface Layers {
  /** The pixels of all layers, 4 bytes each, in sRGB. */
  pixels: Uint8Array<ArrayBuffer>;
  size: number;
  count: number;
}

/** The numbers of a vertex in {@link FileColours.vertices}. */
export const NUMBERS = 4;

/**
 * Where the bits of the ways to repeat a texture begin, how many each way has, and the bit of a texture whose pixels have
 * sharp borders.
 */
export const [WRAPS, BITS, SHARP] = [8, 2, 12];

/** What happens beyond the border of a texture. */
export const REPEAT = { repeat: 0, clamp: 1, mirror: 2 } as const;

export interface FileColours {
  /**
   * For each vertex: two texture coordinates; a colour, in sRGB with 8 bits for each of red, green and blue; and the
   * layer of its texture, from 1, or 0, from bit {@link WRAPS} how the texture repeats to the right and downwards, and the
   * bit {@link SHARP}.
   */
  vertices: Float32Array<ArrayBuffer>;
  layers: Layers | undefined;
}

/** The colours, `undefined` if the file has none, and notes about what is not drawn: a sentence each. */
export interface FoundColours {
  colours: FileColours | undefined;
  notes: string[];
}

/** The numbers of vertices and triangles of a mesh, and what its file has besides these. */
export interface Sizes {
  vertices: number;
  triangles: number;
  dropped: readonly string[];
}

/** A colour in sRGB, from 0 to 1, as one number. */
export function packed(red: number, green: number, blue: number): number {
  const byte = (x: number) => Math.round(255 * Math.min(1, Math.max(0, x || 0)));
  return (byte(red) << 16) | (byte(green) << 8) | byte(blue);
}
