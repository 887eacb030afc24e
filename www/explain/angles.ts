/** Draws angles, and lays two of them side by side on a straight line. */

import { polyline, type Shape, towards } from './draw.ts';
import type { Point } from './mesh.ts';

/** The angle at `corner` in degrees. */
export function angle(corner: Point, one: Point, other: Point): number {
  const [ux, uy, vx, vy] = [one[0] - corner[0], one[1] - corner[1], other[0] - corner[0], other[1] - corner[1]];
  return (Math.atan2(Math.abs(ux * vy - uy * vx), ux * vx + uy * vy) * 180) / Math.PI;
}

/** A sector with its tip at `corner`; its ends are on the way to `one` and to `other`. */
export function wedge(corner: Point, one: Point, other: Point, radius: number): string {
  const [from, to] = [towards(corner, one, radius), towards(corner, other, radius)];
  const isClockwise = (from[0] - corner[0]) * (to[1] - corner[1]) > (from[1] - corner[1]) * (to[0] - corner[0]);
  return `M${corner}L${from}A${radius} ${radius} 0 0 ${isClockwise ? 1 : 0} ${to}Z`;
}

/** Two angles side by side over a straight line, from its left end; what goes past 180° is drawn if `isOver`. */
export function dial(centre: Point, radius: number, [one, other]: [number, number], isOver: boolean): Shape[] {
  const at = (degrees: number): Point => {
    const radians = (degrees * Math.PI) / 180;
    return [centre[0] - radius * Math.cos(radians), centre[1] - radius * Math.sin(radians)];
  };
  return [
    { d: wedge(centre, at(0), at(one), radius), kind: 'explain-angle-one' },
    { d: wedge(centre, at(one), at(one + other), radius), kind: 'explain-angle-two' },
    { d: isOver ? wedge(centre, at(180), at(one + other), radius) : '', kind: 'explain-excess' },
    { d: polyline([at(0), at(180)]), kind: 'explain-straight' },
  ];
}
