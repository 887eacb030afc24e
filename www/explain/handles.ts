/** Points that the pointer and the arrow keys move. */

import { type D3DragEvent, drag } from 'd3-drag';
import type { BaseType, Selection } from 'd3-selection';
import type { Svg } from './draw.ts';
import type { Point } from './mesh.ts';

/** A point that moves within a box, so that the mesh stays one. */
export interface Handle {
  /** Its index among the points of the figure. */
  point: number;
  name: string;
  box: { x: [number, number]; y: [number, number] };
}

export const ARROWS: Record<string, Point> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

const within = (value: number, [least, most]: [number, number]) => Math.min(most, Math.max(least, value));

/** What a handle looks like, with its ring when it has the focus, and a reach that fingers hit. */
export function addKnob<Datum, Parent extends BaseType>(groups: Selection<SVGGElement, Datum, Parent, unknown>): void {
  const parts = { reach: 24, ring: 12, knob: 7 };
  for (const [kind, radius] of Object.entries(parts)) {
    groups.append('circle').attr('class', `explain-${kind}`).attr('r', radius);
  }
}

/** Adds handles to a drawing. They change `points`, then call `moved`. Returns what draws them. */
export function addHandles(svg: Svg, points: Point[], handles: readonly Handle[], moved: () => void): () => void {
  const move = ({ point, box }: Handle, [x, y]: Point) => {
    points[point] = [within(x, box.x), within(y, box.y)];
    moved();
  };
  const groups = svg
    .append('g')
    .selectAll<SVGGElement, Handle>('g')
    .data(handles)
    .join('g')
    .attr('class', 'explain-handle')
    .attr('tabindex', 0)
    .attr('role', 'button')
    .attr('aria-roledescription', 'movable point')
    .attr('aria-label', ({ name }) => `${name}. Arrow keys move it.`)
    .call(
      drag<SVGGElement, Handle>()
        .container(() => svg.node()!)
        .subject((_, { point }) => ({ x: points[point]![0], y: points[point]![1] }))
        .on('drag', ({ x, y }: D3DragEvent<SVGGElement, Handle, unknown>, handle) => move(handle, [x, y])),
    )
    .on('keydown', (event: KeyboardEvent, handle) => {
      const arrow = ARROWS[event.key];
      if (!arrow || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      event.stopPropagation();
      const step = event.shiftKey ? 1 : 6;
      const [x, y] = points[handle.point]!;
      move(handle, [x + step * arrow[0], y + step * arrow[1]]);
    });
  addKnob(groups);
  return () => groups.attr('transform', ({ point }) => `translate(${points[point]!.join()})`);
}
