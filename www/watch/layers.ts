/** Decodes the images of textures, in a worker, and scales them to layers of one size. */

import type { Layers } from './colour-format.ts';

export interface Image {
  name: string;
  /** Its media type, or an empty text. */
  type: string;
  /** Whether it is compressed for GPUs, in the format KTX2. */
  isBasis: boolean;
  /** Whether its pixels have sharp borders when it is enlarged. */
  isSharp: boolean;
  /** `undefined` if its file was not opened. */
  bytes: Uint8Array<ArrayBuffer> | undefined;
}

/** The most pixels of all layers, of the side of one, and the most layers. */
const [MOST_PIXELS, LARGEST, MOST_LAYERS] = [2 ** 24, 4096, 255];

const list = new Intl.ListFormat('en');

/** The layers of those images that can be drawn, their places among these, from 1, and notes about the others. */
export async function layersOf(
  images: readonly Image[],
): Promise<{ layers: Layers | undefined; places: Map<Image, number>; notes: string[] }> {
  const most = largestFor(Math.min(images.length, MOST_LAYERS));
  const failed = new Map<string, string[]>();
  const bitmaps: { image: Image; bitmap: ImageBitmap }[] = [];
  for (const image of images) {
    const bitmap = bitmaps.length < MOST_LAYERS ? await decoded(image, most) : 'a page draws 255 textures';
    if (typeof bitmap !== 'string') bitmaps.push({ image, bitmap });
    else failed.set(bitmap, [...(failed.get(bitmap) ?? []), `“${image.name}”`]);
  }
  const notes = Array.from(failed, ([why, names]) => {
    const what = names.length === 1 ? 'The texture' : 'The textures';
    return `${what} ${list.format(names)} ${names.length === 1 ? 'is' : 'are'} not drawn: ${why}.`;
  });
  const places = new Map(bitmaps.map(({ image }, i) => [image, i + 1]));
  return { layers: bitmaps.length > 0 ? scaled(bitmaps) : undefined, places, notes };
}

/** The side of the largest square, a power of two, of which `count` have at most {@link MOST_PIXELS} pixels. */
function largestFor(count: number): number {
  let side = LARGEST;
  while (side * side * count > MOST_PIXELS) side /= 2;
  return side;
}

/** The image, at most `most` pixels wide and high, or why there is none. */
async function decoded({ bytes, type, isBasis }: Image, most: number): Promise<ImageBitmap | string> {
  if (!bytes) return 'its file was not opened together with the mesh';
  if (isBasis) return 'the page does not read KTX2';
  try {
    const asInFile = { colorSpaceConversion: 'none', premultiplyAlpha: 'none' } as const;
    const whole = await createImageBitmap(new Blob([bytes], { type }), asInFile);
    const { width, height } = whole;
    if (width <= most && height <= most) return whole;
    const size = { resizeWidth: Math.min(width, most), resizeHeight: Math.min(height, most) };
    const small = await createImageBitmap(whole, { ...asInFile, ...size, resizeQuality: 'high' });
    whole.close();
    return small;
  } catch {
    return 'the browser cannot read it';
  }
}

/** Scales each image to a layer, and closes it. Unlike a 2D canvas, WebGL keeps the colours of transparent pixels. */
function scaled(bitmaps: readonly { image: Image; bitmap: ImageBitmap }[]): Layers {
  const size = Math.max(...bitmaps.flatMap(({ bitmap: { width, height } }) => [width, height]));
  const pixels = new Uint8Array(4 * size * size * bitmaps.length);
  const gl = new OffscreenCanvas(1, 1).getContext('webgl2');
  if (!gl) throw new Error('the browser has no WebGL2 to scale the textures');
  const [whole, layer] = [gl.createFramebuffer(), gl.createFramebuffer()];
  const attach = (target: number, framebuffer: WebGLFramebuffer) => {
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.bindFramebuffer(target, framebuffer);
    gl.framebufferTexture2D(target, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    return texture;
  };
  attach(gl.DRAW_FRAMEBUFFER, layer);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, size, size);
  bitmaps.forEach(({ image, bitmap }, i) => {
    const { width, height } = bitmap;
    const texture = attach(gl.READ_FRAMEBUFFER, whole);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
    bitmap.close();
    const filter = image.isSharp ? gl.NEAREST : gl.LINEAR;
    gl.blitFramebuffer(0, 0, width, height, 0, 0, size, size, gl.COLOR_BUFFER_BIT, filter);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, layer);
    gl.readPixels(0, 0, size, size, gl.RGBA, gl.UNSIGNED_BYTE, pixels, 4 * size * size * i);
    gl.deleteTexture(texture);
  });
  if (gl.getError() !== gl.NO_ERROR) throw new Error('the browser has no memory left for the textures');
  return { pixels, size, count: bitmaps.length };
}
