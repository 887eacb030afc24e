/** Draws the edges of a small mesh in the colours of their states. */

import { EDGE_STATES, type EdgeState } from 'edgeflip';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import { LineSegments2 } from 'three/addons/lines/webgpu/LineSegments2.js';
import { Group, Triangle, Vector3, type Line2NodeMaterial } from 'three/webgpu';
import { lineMaterial, MARKS } from './line-material.ts';
import type { Palette } from './palette.ts';
import { LOOKS } from './states.ts';

/** The most of the picture that Delaunay edges may cover before they fade, and the least opacity. */
const [COVERED, FAINTEST] = [0.4, 0.4];

/** Widths in pixels: of Delaunay edges, of boundary edges, and of all others. */
function widthsFor(triangles: number): { plain: number; boundary: number; coloured: number } {
  if (triangles <= 600) return { plain: 1.2, boundary: 2, coloured: 3.2 };
  if (triangles <= 4000) return { plain: 1, boundary: 1.8, coloured: 2.6 };
  return { plain: 0.8, boundary: 1.6, coloured: 1.8 };
}

/** The declared type of the material lacks its scale. */
type Lines = LineSegments2 & { material: Line2NodeMaterial & { scale: number } };

export class EdgeLines {
  readonly group = new Group();
  /** For each state: its lines, made when they are first needed. They are kept, and so are their compiled shaders. */
  readonly #lines = new Map<EdgeState, Lines>();
  /** The share of the surface that the Delaunay edges cover if a pixel has the size 1. */
  #density = 0;

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
      const lines = this.#linesOf(name);
      lines.geometry = new LineSegmentsGeometry();
      lines.geometry.setPositions(new Float32Array(ends));
      if (LOOKS[name].dash) lines.computeLineDistances();
      lines.material.color.set(palette.states[name]);
      lines.material.linewidth =
        name === 'delaunay' ? widths.plain : name === 'boundary' ? widths.boundary : widths.coloured;
      lines.visible = true;
      if (name === 'delaunay') this.#density = (widths.plain * lengthOf(ends)) / areaOf(positions, indices);
    });
  }

  /**
   * Sets the size of a pixel in the scene, so that dashes have their lengths in pixels, and so that dense edges are
   * faint.
   */
  setPixel(size: number): void {
    for (const [name, { material }] of this.#lines) {
      material.scale = 1 / size;
      if (name !== 'delaunay') continue;
      material.opacity = Math.min(1, Math.max(FAINTEST, COVERED / (size * this.#density)));
    }
  }

  clear(): void {
    for (const lines of this.#lines.values()) {
      if (lines.visible) lines.geometry.dispose();
      lines.visible = false;
    }
  }

  #linesOf(name: EdgeState): Lines {
    const known = this.#lines.get(name);
    if (known) return known;
    const { dash } = LOOKS[name];
    const material = lineMaterial({ dashed: dash !== undefined }, name === 'delaunay' ? MARKS.plain : undefined);
    if (dash) Object.assign(material, { dashSize: dash[0], gapSize: dash[1] });
    const lines = new LineSegments2(new LineSegmentsGeometry(), material) as Lines;
    lines.frustumCulled = false;
    // Coloured edges are drawn over plain edges, and flips over all.
    lines.renderOrder = name === 'delaunay' ? 1 : name === 'flips' ? 3 : 2;
    this.#lines.set(name, lines);
    this.group.add(lines);
    return lines;
  }
}

/** The length of all pieces of line; `ends` has 6 numbers for each. */
function lengthOf(ends: readonly number[]): number {
  let length = 0;
  for (let i = 0; i < ends.length; i += 6) {
    length += Math.hypot(ends[i + 3]! - ends[i]!, ends[i + 4]! - ends[i + 1]!, ends[i + 5]! - ends[i + 2]!);
  }
  return length;
}

function areaOf(positions: Float32Array, indices: Uint32Array): number {
  const corners = [new Vector3(), new Vector3(), new Vector3()] as const;
  const triangle = new Triangle(...corners);
  let area = 0;
  for (let h = 0; h < indices.length; h += 3) {
    corners.forEach((corner, k) => corner.fromArray(positions, 3 * indices[h + k]!));
    area += triangle.getArea();
  }
  return area;
}

/** Whether a half-edge in this state has no twin. */
function isOfOneTriangle(name: EdgeState): boolean {
  return name === 'boundary' || name === 'non-manifold' || name === 'inconsistent';
}
