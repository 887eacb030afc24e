/** The picture that is saved: the mesh before and after beside each other, and a line of words under them. */

import type { Palette } from './palette.ts';

/** The width of a half, in pixels at least, and the type relative to it. */
export const HALF = 900;
const [TYPE, LABEL] = [1 / 38, 1 / 48];

/** One picture, or two: the first is before, the second after. All have the same size. */
export function snapshot(
  pictures: readonly OffscreenCanvas[],
  words: string,
  { ground, text, muted, hair }: Palette,
): Promise<Blob> {
  const [{ width, height } = { width: HALF, height: HALF }] = pictures;
  const [whole, room, size] = [width * pictures.length, width / 24, width * TYPE];
  const canvas = new OffscreenCanvas(whole, Math.round(height + 2 * room + size));
  const context = canvas.getContext('2d')!;
  const write = (what: string, x: number, y: number, points: number, weight: number, colour: string) => {
    const font = (of: number) => `${weight} ${of}px Inter, system-ui, sans-serif`;
    context.font = font(points);
    // Long words get smaller, so that they have room.
    const share = Math.min(1, (whole - 2 * room) / context.measureText(what).width);
    if (share < 1) context.font = font(points * share);
    context.fillStyle = colour;
    context.fillText(what, x, y);
  };
  context.fillStyle = ground;
  context.fillRect(0, 0, canvas.width, canvas.height);
  pictures.forEach((picture, i) => {
    context.drawImage(picture, i * width, 0);
    if (pictures.length > 1) write(i === 0 ? 'Before' : 'After', i * width + room, room, width * LABEL, 560, muted);
  });
  context.fillStyle = hair;
  if (pictures.length > 1) context.fillRect(width - 1, room, 2, height - room);
  write(words, room, height + room + size * 0.75, size, 450, text);
  return canvas.convertToBlob();
}
