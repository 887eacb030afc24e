/** Draws the edges of a small mesh in the colours of their states. */

import { EDGE_STATES, type EdgeState } from 'edgeflip';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import { LineSegments2 } from 'three/addons/lines/webgpu/LineSegments2.js';
import { Group, Line2NodeMaterial } from 'three/webgpu';
import type { Palette } from './palette.ts';
import { LOOKS } from './states.ts';

/** Widths in pixels: of Delaunay edges, of boundary edges, and of all others. */
function widthsFor(triangles: number): { plain: number; boundary: number; coloured: number } {
  if (triangles <= 600) return { plain: 1.2, boundary: 2, coloured: 3.2 };
  if (triangles <= 4000) return { plain: 1, boundary: 1.8, coloured: 2.6 };
  return { plain: 0.8, boundary: 1.6, coloured: 1.8 };
}

export class EdgeLines {
  readonly group = new Group();

  /** `positions` has 3 numbers per vertex, `states` one entry per half-edge. */
  show(positions: Float32Array, indices: Uint32Array, states: Uint8Array, palette: Palette): void {
    const widths = widthsFor(indices.length / 3);
    const byState = EDGE_STATES.map((): number[] => []);
    const twins = new Set<number>();
    const vertices = positions.length / 3;
    states.forEach((state, h) => {
      const a = indices[h]!;
      const b = indices[h % 3 === 2 ? h - 2 : h + 1]!;
      // An edge between two triangles is drawn once.
      if (!isOfOneTriangle(EDGE_STATES[state]!)) {
        const key = Math.min(a, b) * vertices + Math.max(a, b);
        if (twins.delete(key)) return;
        twins.add(key);
      }
      byState[state]!.push(...positions.subarray(3 * a, 3 * a + 3), ...positions.subarray(3 * b, 3 * b + 3));
    });
    byState.forEach((ends, state) => {
      if (ends.length === 0) return;
      const name = EDGE_STATES[state]!;
      const geometry = new LineSegmentsGeometry();
      geometry.setPositions(new Float32Array(ends));
      const { dash } = LOOKS[name];
      const material = new Line2NodeMaterial({ color: palette.states[name], dashed: dash !== undefined });
      material.linewidth = name === 'delaunay' ? widths.plain : name === 'boundary' ? widths.boundary : widths.coloured;
      if (dash) Object.assign(material, { dashSize: dash[0], gapSize: dash[1] });
      const lines = new LineSegments2(geometry, material);
      if (dash) lines.computeLineDistances();
      lines.frustumCulled = false;
      // Coloured edges are drawn over plain edges, and flips over all.
      lines.renderOrder = name === 'delaunay' ? 1 : name === 'flips' ? 3 : 2;
      this.group.add(lines);
    });
  }

  /** Sets the size of a pixel in the scene, so that dashes have their lengths in pixels. */
  setPixel(size: number): void {
    for (const { material } of this.group.children as LineSegments2[]) {
      (material as Line2NodeMaterial & { scale: number }).scale = 1 / size;
    }
  }

  clear(): void {
    for (const lines of [...this.group.children] as LineSegments2[]) {
      lines.geometry.dispose();
      lines.material.dispose();
      this.group.remove(lines);
    }
  }
}

/** Whether a half-edge in this state has no twin. */
function isOfOneTriangle(name: EdgeState): boolean {
  return name === 'boundary' || name === 'non-manifold' || name === 'inconsistent';
}
