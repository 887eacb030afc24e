/** Draws points, edges and triangles with d3. */

import type { Selection } from 'd3-selection';
import type { Edge, Point } from './mesh.ts';

export type Svg = Selection<SVGSVGElement, undefined, null, undefined>;
export type Layer = Selection<SVGGElement, undefined, null, undefined>;

/** A path or a text with its class. */
export interface Shape {
  d: string;
  kind: string;
}

export interface Label {
  text: string;
  at: Point;
  kind?: string;
}

export const layer = (svg: Svg, kind: string): Layer => svg.append('g').attr('class', kind);

export const polyline = (points: readonly Point[]) => `M${points.map((point) => point.join()).join('L')}`;
export const polygon = (points: readonly Point[]) => `${polyline(points)}Z`;

/** The point at `t` of the way. */
export const between = (from: Point, to: Point, t: number): Point => [
  from[0] + t * (to[0] - from[0]),
  from[1] + t * (to[1] - from[1]),
];

export function middle(...points: readonly Point[]): Point {
  const sum = points.reduce(([x, y], point) => [x + point[0], y + point[1]], [0, 0]);
  return [sum[0] / points.length, sum[1] / points.length];
}

/** The point at a distance from `from` in the direction of `to`. */
export function towards(from: Point, to: Point, distance: number): Point {
  return between(from, to, distance / (Math.hypot(to[0] - from[0], to[1] - from[1]) || 1));
}

/** An arrow between two points; `size` is the length of its head. */
export function arrow(from: Point, tip: Point, size = 8): string {
  const back = towards(tip, from, size);
  const [x, y] = [(tip[1] - back[1]) * 0.6, (back[0] - tip[0]) * 0.6];
  return polyline([from, tip]) + polyline([[back[0] + x, back[1] + y], tip, [back[0] - x, back[1] - y]]);
}

/** An edge on its way to the other diagonal: its ends slide along two sides of its triangles. */
export function turned(
  { ends, facing }: Pick<Edge, 'ends' | 'facing'>,
  points: readonly Point[],
  t: number,
): [Point, Point] {
  return [between(points[ends[0]]!, points[facing[0]!]!, t), between(points[ends[1]]!, points[facing[1]!]!, t)];
}

export function drawShapes(into: Layer, shapes: readonly Shape[]): void {
  into
    .selectAll('path')
    .data(shapes)
    .join('path')
    .attr('class', ({ kind }) => kind)
    .attr('d', ({ d }) => d);
}

export function drawDots(into: Layer, points: readonly Point[], radius = 4): void {
  into
    .selectAll('circle')
    .data(points)
    .join('circle')
    .attr('cx', ([x]) => x)
    .attr('cy', ([, y]) => y)
    .attr('r', radius);
}

export function drawLabels(into: Layer, labels: readonly Label[]): void {
  into
    .selectAll('text')
    .data(labels)
    .join('text')
    .attr('class', ({ kind }) => kind ?? '')
    .attr('x', ({ at }) => at[0])
    .attr('y', ({ at }) => at[1])
    .text(({ text }) => text);
}
