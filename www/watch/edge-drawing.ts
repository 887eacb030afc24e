/** Draws edges into a mesh in the plane: from one point to another, by dragging. */

import type { IndexedMesh } from 'edgeflip/files';
import { select } from 'd3-selection';
import { controls, element } from './controls.ts';
import { widthOf } from './plan.ts';
import type { Scene } from './scene.ts';

/** How near to a point a line begins and ends, in pixels. A finger hides more than that. */
const NEAR = 32;

/** The most triangles of a mesh into which edges can be drawn: each move of the pointer looks at all points. */
const MOST = 200_000;

export class EdgeDrawing {
  readonly #scene: () => Scene | undefined;
  /** The mesh, if edges can be drawn into it. */
  #mesh: IndexedMesh | undefined;
  #from: number | undefined;

  /** `draw` is called with the points of a line. `begun` is called when lines can be drawn from now on. */
  constructor(scene: () => Scene | undefined, draw: (from: number, to: number) => void, begun: () => void) {
    this.#scene = scene;
    controls.draw.addEventListener('click', () => {
      // A key may press the button while it is hidden.
      this.show(!this.isOn && this.#mesh !== undefined);
      if (this.isOn) begun();
    });
    const view = element('view');
    // Before the camera takes the pointer.
    const begin = (event: PointerEvent) => {
      if (!this.isOn || event.button !== 0) return;
      this.#from = this.#nearest(event);
      const scene = this.#scene();
      if (this.#from !== undefined && scene) scene.camera.isFree = false;
      this.#show(event);
    };
    const end = (event: PointerEvent) => {
      const [from, to] = [this.#from, this.#nearest(event)];
      this.#drop();
      if (event.type === 'pointerup' && from !== undefined && to !== undefined && from !== to) draw(from, to);
    };
    view.addEventListener('pointerdown', begin, { capture: true });
    view.addEventListener('pointermove', (event) => this.#show(event));
    view.addEventListener('pointerup', end);
    view.addEventListener('pointercancel', end);
    view.addEventListener('pointerleave', () => this.#from === undefined && this.#drop());
  }

  /** Whether a drag draws an edge. */
  get isOn(): boolean {
    return controls.draw.ariaPressed === 'true';
  }

  /** Takes another mesh, or none. Edges can be drawn into it only in the plane. */
  begin(mesh: IndexedMesh | undefined): void {
    this.#mesh = mesh?.dimension === 2 && mesh.indices.length <= 3 * MOST ? mesh : undefined;
    controls.draw.hidden = !this.#mesh;
    if (!this.#mesh) this.show(false);
    this.#drop();
  }

  show(isOn: boolean): void {
    controls.draw.ariaPressed = `${isOn}`;
    element('draw-says').hidden = !isOn;
    this.#drop();
  }

  #drop(): void {
    this.#from = undefined;
    const scene = this.#scene();
    if (scene) scene.camera.isFree = true;
    this.#mark([]);
  }

  /** The point of the mesh that is nearest to the pointer, if one is near. */
  #nearest({ offsetX, offsetY }: PointerEvent): number | undefined {
    const [mesh, at] = [this.#mesh, this.#scene()?.projector()];
    if (!mesh || !at) return undefined;
    let [nearest, found]: [number, number | undefined] = [NEAR, undefined];
    for (let vertex = 0; vertex < mesh.positions.length / widthOf(mesh); vertex++) {
      const [x, y] = at(vertex);
      const distance = Math.hypot(x - offsetX, y - offsetY);
      if (distance < nearest) [nearest, found] = [distance, vertex];
    }
    return found;
  }

  /** Shows the line so far, and the point that the pointer is near. */
  #show(event: PointerEvent): void {
    const at = this.#scene()?.projector();
    if (!this.isOn || !at) return;
    const [from, to] = [this.#from, this.#nearest(event)];
    const pointer: [number, number] = to === undefined ? [event.offsetX, event.offsetY] : at(to);
    const dot = (vertex: number) => {
      const [x, y] = at(vertex);
      return `M${x - 6} ${y}a6 6 0 1 0 12 0a6 6 0 1 0 -12 0`;
    };
    const ends = [from, to].flatMap((vertex) => (vertex === undefined ? [] : dot(vertex))).join('');
    this.#mark([from === undefined ? '' : `M${at(from)}L${pointer}`, ends]);
  }

  #mark(paths: string[]): void {
    select(element('thread'))
      .selectAll<SVGPathElement, string>('path.drawn')
      .data(paths)
      .join('path')
      .attr('class', 'drawn')
      .attr('d', (d) => d);
  }
}
