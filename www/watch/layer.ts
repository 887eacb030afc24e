/** One picture of the mesh: its surface, the edges of a small mesh in colours, and those that have just flipped. */

import { Group } from 'three/webgpu';
import type { Corners } from './corners.ts';
import { EdgeLines } from './edge-lines.ts';
import { FlipAnimation } from './flip-animation.ts';
import { Surface, type Paint } from './surface.ts';

export class Layer {
  readonly group = new Group();
  readonly edges = new EdgeLines();
  readonly flipAnimation = new FlipAnimation();
  readonly surface: Surface;

  constructor(corners: Corners, paint: Paint) {
    this.surface = new Surface(corners, paint);
    this.group.add(this.surface.object, this.edges.group, this.flipAnimation.lines);
  }

  /** Shows nothing, and releases all buffers. */
  clear(): void {
    this.edges.clear();
    this.flipAnimation.clear();
    this.surface.clear();
  }
}
