/** The drawings of the inspector. */

import { create, type Selection } from 'd3-selection';
import type { IndexedMesh } from 'edgeflip/files';
import { pointOf, type Quad } from './quad.ts';

type Flat = readonly [x: number, y: number];
type Svg = Selection<SVGSVGElement, undefined, null, undefined>;

const SIZE = 190;
const RADIANS = Math.PI / 180;

/** The triangles of the edge laid flat, with the edge turned by `turn` radians, its angles and circumcircles. */
export function lens(quad: Quad, mesh: IndexedMesh, colour: string, turn: number): SVGSVGElement {
  const svg: Svg = create('svg')
    .attr('class', 'lens')
    .attr('viewBox', `0 0 ${SIZE} ${SIZE}`)
    .attr('aria-hidden', 'true');
  const [p, q] = [pointOf(mesh, quad.a), pointOf(mesh, quad.b)];
  const long = Math.hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
  // Along the edge from -1/2 to 1/2; the first triangle above it, the second below.
  const flat = quad.opposite.slice(0, 2).map((v, i): Flat => {
    const r = pointOf(mesh, v);
    const [u, w] = [p, q].map((end) => Math.hypot(r[0] - end[0], r[1] - end[1], r[2] - end[2]) / long) as [
      number,
      number,
    ];
    const x = (u * u - w * w) / 2;
    const y = Math.sqrt(Math.max(0, u * u - (x + 0.5) ** 2));
    return [x, i === 0 ? y : -y];
  });
  const corners: Flat[] = [[-0.5, 0], [0.5, 0], ...flat];
  const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
  const turned = corners.map(([x, y]): Flat => [x * cos - y * sin, -(x * sin + y * cos)]);
  const [xs, ys] = [turned.map(([x]) => x), turned.map(([, y]) => y)];
  const [left, right, top, bottom] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const scale = (SIZE - 76) / Math.max(right - left, bottom - top, 0.01);
  const [a, b, ...others] = turned.map(
    ([x, y]): Flat => [SIZE / 2 + scale * (x - (left + right) / 2), SIZE / 2 + scale * (y - (top + bottom) / 2)],
  ) as [Flat, Flat, ...Flat[]];
  for (const c of others) drawCircle(svg, a, b, c);
  for (const c of others) {
    svg
      .append('path')
      .attr('d', `M${a}L${b}L${c}Z`)
      .attr('fill', 'var(--text)')
      .attr('fill-opacity', 0.06)
      .attr('stroke', 'var(--muted)');
  }
  others.forEach((c, i) => drawAngle(svg, c, a, b, quad.angles[i]!, colour));
  const [c, d] = others;
  if (c && d) line(svg, c, d).attr('stroke', 'var(--muted)').attr('stroke-dasharray', '2 4');
  line(svg, a, b).attr('stroke', `var(--${colour})`).attr('stroke-width', 4).attr('stroke-linecap', 'round');
  for (const [x, y] of [a, b, ...others])
    svg.append('circle').attr('cx', x).attr('cy', y).attr('r', 3.5).attr('fill', 'var(--text)');
  return svg.node()!;
}

const line = (svg: Svg, from: Flat, to: Flat) => svg.append('path').attr('d', `M${from}L${to}`).attr('fill', 'none');

function drawCircle(svg: Svg, [ax, ay]: Flat, [bx, by]: Flat, [cx, cy]: Flat): void {
  const twice = 2 * (ax * (by - cy) + bx * (cy - ay) + cx * (ay - by));
  const [a, b, c] = [ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy];
  const x = (a * (by - cy) + b * (cy - ay) + c * (ay - by)) / twice;
  const y = (a * (cx - bx) + b * (ax - cx) + c * (bx - ax)) / twice;
  const radius = Math.hypot(ax - x, ay - y);
  // The circle of a thin triangle is almost a line.
  if (!(radius < 20 * SIZE)) return;
  svg
    .append('circle')
    .attr('cx', x)
    .attr('cy', y)
    .attr('r', radius)
    .attr('fill', 'none')
    .attr('stroke', 'var(--control)')
    .attr('stroke-opacity', 0.6);
}

/** A wedge at corner `c` between the directions to `a` and `b`, and its size beside it. */
function drawAngle(svg: Svg, c: Flat, a: Flat, b: Flat, angle: number, colour: string): void {
  const unit = ([x, y]: Flat): Flat => {
    const length = Math.hypot(x - c[0], y - c[1]) || 1;
    return [(x - c[0]) / length, (y - c[1]) / length];
  };
  const [u, w] = [unit(a), unit(b)];
  const at = ([x, y]: Flat, radius: number): Flat => [c[0] + radius * x, c[1] + radius * y];
  const sweep = u[0] * w[1] - u[1] * w[0] > 0 ? 1 : 0;
  svg
    .append('path')
    .attr('d', `M${c}L${at(u, 20)}A20 20 0 0 ${sweep} ${at(w, 20)}Z`)
    .attr('fill', `var(--${colour})`)
    .attr('fill-opacity', 0.35);
  // Away from the edge, outside of the triangle.
  const [x, y] = at([-(u[0] + w[0]), -(u[1] + w[1])], 1);
  const length = Math.hypot(x - c[0], y - c[1]) || 1;
  svg
    .append('text')
    .attr('x', c[0] + (20 * (x - c[0])) / length)
    .attr('y', c[1] + (16 * (y - c[1])) / length)
    .attr('dy', '0.35em')
    .attr('text-anchor', 'middle')
    .attr('font-size', 13)
    .attr('fill', 'var(--text)')
    .text(`${Math.round(angle)}°`);
}

/** The two angles beside each other on a straight line; what is more than 180° is below it, in the colour. */
export function angleFan([first = 0, second = 0]: readonly number[], colour: string): SVGSVGElement {
  const [centre, radius] = [60, 54];
  const svg = create('svg').attr('viewBox', '0 0 120 116').attr('width', 118).attr('aria-hidden', 'true');
  const at = (angle: number): Flat => [
    centre - radius * Math.cos(angle * RADIANS),
    centre - radius * Math.sin(angle * RADIANS),
  ];
  const wedge = (from: number, to: number, fill: string, opacity: number) =>
    svg
      .append('path')
      .attr('d', `M${centre} ${centre}L${at(from)}A${radius} ${radius} 0 0 1 ${at(to)}Z`)
      .attr('fill', `var(--${fill})`)
      .attr('fill-opacity', opacity);
  const sum = first + second;
  wedge(0, Math.min(first, 180), 'text', 0.16);
  wedge(first, Math.min(sum, 180), 'text', 0.3);
  if (sum > 180) wedge(180, sum, colour, 1);
  svg.append('path').attr('d', `M2 ${centre}H118`).attr('stroke', 'var(--text)').attr('stroke-width', 1.6);
  return svg.node()!;
}
