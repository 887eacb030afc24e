// The types of `edgeflip/three`, in a strict project with three.js.

import { delaunayGeometry, type GeometryOptions } from 'edgeflip/three';
import type { BufferGeometry } from 'three';

export async function textured(geometry: BufferGeometry): Promise<number> {
  const options: GeometryOptions = { inPlace: true, maxAttributeShift: { uv: 0.01, color: Infinity } };
  const { shiftEdges, largestShifts } = await delaunayGeometry(geometry, options);
  return shiftEdges + (largestShifts?.['uv'] ?? 0);
}
