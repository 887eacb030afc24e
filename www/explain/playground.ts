/** The playground: points that the visitor sets, and the four phases of a round, one at a time. */

import './playground.css';
import { type D3DragEvent, drag } from 'd3-drag';
import { made } from '../shell/elements.ts';
import { stillness } from '../shell/stillness.ts';
import { dial } from './angles.ts';
import { drawLabels, drawShapes, polyline } from './draw.ts';
import { addKnob, ARROWS } from './handles.ts';
import { glide } from './loop.ts';
import type { Point } from './mesh.ts';
import { cornersOf, planarOf, turn, withMoved, withoutPoint, withPoint } from './planar.ts';
import { marksOf, type Side, sidesOf } from './playground-marks.ts';
import { makeParts } from './playground-parts.ts';
import { aboutOf, anglesOf, captionOf, whyOf } from './playground-words.ts';
import { AREA, hashOf, inArea, isFree, MOST, type Place, placeOf, type State, STOPS, stateIn } from './stops.ts';

// biome-ignore format: one row for six points
const FIRST: Point[] = [
  [560, 90], [590, 270], [570, 440], [140, 110], [410, 380], [270, 200],
  [40, 360], [190, 350], [330, 100], [430, 160], [350, 270], [480, 330],
];

const begin = (): State => ({ planar: planarOf(FIRST), phase: 0, isPlain: true, edge: undefined });

const ANEW = 'A triangle would have turned over, so the point is joined anew.';

/** Milliseconds from a change to the address, which browsers let a page change only so often. */
const SETTLES = 300;

export class Playground {
  readonly #parts;
  #place: Place = placeOf(begin());
  /** The point that has, or had, the focus. */
  #chosen: number | undefined;
  /** A pixel of the screen, in the units of the drawing. */
  #unit = 1;
  #stopTurning = () => {};
  #settling: ReturnType<typeof setTimeout> | undefined;

  constructor(number: number) {
    this.#parts = makeParts(number);
    const { svg, element } = this.#parts;
    this.#connectButtons();
    this.#connectPointer();
    element.addEventListener('keydown', (event) => this.#onKey(event));
    new ResizeObserver(() => {
      const { width } = svg.node()!.getBoundingClientRect();
      if (width === 0) return;
      this.#unit = AREA[0] / width;
      svg.node()!.style.setProperty('--unit', `${this.#unit}px`);
      this.#draw();
    }).observe(svg.node()!);
    const open = () => {
      const state = stateIn(location.hash);
      if (!state) return false;
      this.#show(state, false);
      return true;
    };
    addEventListener('hashchange', () => {
      clearTimeout(this.#settling);
      if (open()) element.scrollIntoView();
    });
    if (!open()) this.#show(begin(), false);
  }

  get element(): HTMLElement {
    return this.#parts.element;
  }

  /** Runs the next phase, or goes back by one. Returns whether there was one. */
  step(by: 1 | -1): boolean {
    const phase = this.#place.phase + by;
    if (phase < 0 || phase > this.#place.last) return false;
    this.#goTo(phase);
    return true;
  }

  /** Explains the next edge between two triangles: first those that are not Delaunay. */
  explainNext(): void {
    const { tested, edge } = this.#place;
    const inner = tested.inner.toSorted((one, other) => (one.rank || Infinity) - (other.rank || Infinity));
    const at = inner.findIndex(({ ends }) => edge && ends.every((v) => edge.includes(v)));
    const next = inner[(at + 1) % inner.length];
    this.#explain(next?.ends);
    if (!next) this.#parts.says.textContent = 'No edge lies between two triangles.';
  }

  #show(state: State, isChange = true): void {
    this.#stopTurning();
    this.#place = placeOf(state);
    this.#draw();
    this.#parts.says.textContent = '';
    if (!isChange) return;
    clearTimeout(this.#settling);
    this.#settling = setTimeout(() => history.replaceState(history.state, '', this.link), SETTLES);
  }

  /** The address of what is shown. */
  get link(): string {
    const url = new URL(location.href);
    url.hash = hashOf(this.#place);
    return url.href;
  }

  #goTo(phase: number, isPlain = false): void {
    const { phase: before, isPlain: wasPlain } = this.#place;
    if (phase === before && isPlain === wasPlain) return;
    this.#show({ ...this.#place, phase, isPlain });
    if (this.#place.stop === 'flip' && phase > before && !stillness.matches) {
      this.#stopTurning = glide(0, 1, (flipped) => this.#draw(flipped));
    }
  }

  /** Takes over other points or triangles. The rounds begin anew with them. */
  #edit(planar: State['planar'], says = ''): void {
    this.#show({ planar, phase: 0, isPlain: true, edge: this.#place.edge });
    this.#parts.says.textContent = says;
  }

  /** The points with the triangles of now. */
  get #present(): State['planar'] {
    return { points: this.#place.planar.points, triangles: this.#place.triangles };
  }

  #add(at: Point): void {
    const point = inArea(at);
    const { points } = this.#place.planar;
    const { says } = this.#parts;
    if (points.length >= MOST) says.textContent = `${MOST} points are the most.`;
    else if (!isFree(point, points)) says.textContent = 'There is a point already.';
    else {
      this.#edit(withPoint(this.#present, point));
      this.#focus(points.length);
    }
  }

  /** Adds a point where there is most room. */
  #addAnywhere(): void {
    const { points } = this.#place.planar;
    const triangles = cornersOf(this.#place.triangles).map((corners) => corners.map((v) => points[v]!));
    const areaOf = ([a, b, c]: Point[]) => turn(a!, b!, c!);
    const largest = triangles.toSorted((one, other) => areaOf(other) - areaOf(one))[0];
    const few: Point[] = [
      [160, 360],
      [480, 330],
      [300, 110],
    ];
    const sum = (axis: 0 | 1) => largest!.reduce((total, point) => total + point[axis], 0) / 3;
    const place = largest ? ([sum(0), sum(1)] as Point) : few.find((point) => isFree(point, points));
    if (place) this.#add(place);
  }

  #move(v: number, to: Point): void {
    const point = inArea(to);
    if (!isFree(point, this.#place.planar.points, v)) return;
    const { planar, isJoinedAnew } = withMoved(this.#present, v, point);
    const { says } = this.#parts;
    // It stays to be read while the point moves on.
    this.#edit(planar, isJoinedAnew || says.textContent === ANEW ? ANEW : '');
  }

  #remove(v: number | undefined): void {
    if (v === undefined) return;
    // The points after it get other numbers.
    this.#place = { ...this.#place, edge: undefined };
    this.#edit(withoutPoint(this.#present, v));
    const left = this.#place.planar.points.length;
    if (left > 0) this.#focus(Math.min(v, left - 1));
    else this.#parts.tools.add.focus();
  }

  #explain(edge: [number, number] | undefined): void {
    this.#show({ ...this.#place, edge });
  }

  #focus(v: number): void {
    this.#parts.layers.points
      .selectAll<SVGGElement, unknown>('.explain-handle')
      .nodes()
      [v]?.focus({ preventScroll: true });
  }

  #connectButtons(): void {
    const { steps, tools, says } = this.#parts;
    const on = (button: HTMLButtonElement, act: () => void) =>
      button.addEventListener('click', () => button.ariaDisabled !== 'true' && act());
    const begun = () => 4 * Math.floor(this.#place.phase / 4);
    on(steps.back, () => this.step(-1));
    for (const [index, name] of STOPS.entries()) on(steps[name], () => this.#goTo(begun() + index + 1));
    on(steps.round, () => this.#goTo(begun() + 4, true));
    on(tools.why, () => this.explainNext());
    on(tools.add, () => this.#addAnywhere());
    on(tools.remove, () => this.#remove(this.#chosen));
    on(tools.clear, () => this.#edit(planarOf([])));
    on(tools.reset, () => this.#show(begin()));
    on(tools.link, () => {
      const copied = 'Link copied. It opens these points, triangles and marks.';
      const refused = 'The browser does not let the page copy. The address of the page is the link.';
      const say = (words: string) => () => void (says.textContent = words);
      history.replaceState(history.state, '', this.link);
      navigator.clipboard.writeText(this.link).then(say(copied), say(refused));
    });
  }

  #connectPointer(): void {
    const { svg } = this.#parts;
    svg.on('click', (event: MouseEvent) => {
      const { target } = event;
      if (!(target instanceof Element) || target.closest('.explain-handle')) return;
      if (target.closest('.playground-reach')) return;
      const { left, top } = svg.node()!.getBoundingClientRect();
      this.#add([(event.clientX - left) * this.#unit, (event.clientY - top) * this.#unit]);
    });
  }

  #onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || !(event.target instanceof Element)) return;
    const handle = event.target.closest('.explain-handle');
    const arrow = ARROWS[event.key];
    const v = handle ? [...handle.parentElement!.children].indexOf(handle) : undefined;
    if (v !== undefined && arrow) {
      const [x, y] = this.#place.planar.points[v]!;
      const step = event.shiftKey ? 1 : 6;
      this.#move(v, [x + step * arrow[0], y + step * arrow[1]]);
    } else if (v !== undefined && (event.key === 'Delete' || event.key === 'Backspace')) this.#remove(v);
    else if (event.key === 'ArrowLeft' || event.key === 'ArrowRight') this.step(event.key === 'ArrowLeft' ? -1 : 1);
    else if (event.key.toLowerCase() === 'n') this.explainNext();
    else if (event.key === 'Escape' && this.#place.edge) this.#show({ ...this.#place, edge: undefined });
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  #draw(flipped = 1): void {
    const { layers, caption, stop } = this.#parts;
    const place = this.#place;
    const marks = marksOf(place, this.#unit, flipped);
    drawShapes(layers.under, marks.under);
    drawShapes(layers.edges, marks.edges);
    drawShapes(layers.over, flipped < 1 ? [] : marks.over);
    drawLabels(layers.labels, marks.labels);
    this.#drawReach();
    this.#drawPoints();
    this.#drawButtons();
    this.#drawWhy();
    const text = captionOf(place);
    if (caption.textContent !== text) caption.textContent = text;
    caption.classList.toggle('explain-hot', place.stop === 'label' && place.round.flips.length > 0);
    const [name, words] = aboutOf(place);
    stop.replaceChildren(made('b', '', name), ` ${words}`);
  }

  /** Edges that a click explains. */
  #drawReach(): void {
    const { points } = this.#place.planar;
    this.#parts.layers.reach
      .selectAll<SVGPathElement, Side>('path')
      .data(sidesOf(this.#place.triangles))
      .join((enter) =>
        enter
          .append('path')
          .on('click', (_, { ends }) => this.#explain(ends.join() === this.#place.edge?.join() ? undefined : ends)),
      )
      .attr('d', ({ ends }) => polyline(ends.map((v) => points[v]!)));
  }

  #drawPoints(): void {
    const { svg, layers } = this.#parts;
    const { points } = this.#place.planar;
    layers.points
      .selectAll<SVGGElement, Point>('.explain-handle')
      .data(points)
      .join((enter) => {
        const groups = enter
          .append('g')
          .attr('class', 'explain-handle')
          .attr('tabindex', 0)
          .attr('role', 'button')
          .attr('aria-roledescription', 'movable point')
          .on('focus', (event: FocusEvent) => {
            const handle = event.currentTarget as SVGGElement;
            this.#chosen = [...handle.parentElement!.children].indexOf(handle);
            this.#drawButtons();
          });
        addKnob(groups);
        return groups.call(
          drag<SVGGElement, Point>()
            .container(() => svg.node()!)
            // Where reaches overlap, the nearest point is meant.
            .subject(({ x, y }: { x: number; y: number }) => {
              const all = this.#place.planar.points;
              const far = all.map(([u, v]) => Math.hypot(u - x, v - y));
              const v = far.indexOf(Math.min(...far));
              return { x: all[v]![0], y: all[v]![1], v };
            })
            .on('start', ({ subject }: { subject: { v: number } }) => {
              this.#parts.says.textContent = '';
              this.#focus(subject.v);
            })
            .on('drag', ({ x, y, subject }: D3DragEvent<SVGGElement, Point, { v: number }>) =>
              this.#move(subject.v, [x, y]),
            ),
        );
      })
      .attr('aria-label', (_, v) => `Point ${v + 1}. Arrow keys move it, Delete removes it.`)
      .attr('transform', (point) => `translate(${point.join()})`);
  }

  #drawButtons(): void {
    const { steps, tools } = this.#parts;
    const { phase, last, stop, planar } = this.#place;
    const begun = 4 * Math.floor(phase / 4);
    const can = (button: HTMLButtonElement, isPossible: boolean) => (button.ariaDisabled = `${!isPossible}`);
    can(steps.back, phase > 0);
    for (const [index, name] of STOPS.entries()) {
      can(steps[name], begun + index + 1 <= last);
      if (name === stop) steps[name].ariaCurrent = 'step';
      else steps[name].removeAttribute('aria-current');
    }
    can(steps.round, begun + 4 <= last);
    can(tools.why, planar.triangles.length > 0);
    can(tools.add, planar.points.length < MOST);
    can(tools.remove, this.#chosen !== undefined && this.#chosen < planar.points.length);
    can(tools.clear, planar.points.length > 0);
  }

  #drawWhy(): void {
    const { why, whyWords, dialShapes } = this.#parts;
    const { edge, tested, planar } = this.#place;
    why.hidden = !edge;
    if (!edge) return;
    const inner = tested.inner.find(({ ends }) => ends.every((v) => edge.includes(v)));
    const text = whyOf(this.#place, inner);
    if (whyWords.textContent !== text) whyWords.textContent = text;
    drawShapes(dialShapes, inner ? dial([60, 62], 54, anglesOf(inner, planar.points), inner.excess > 0) : []);
  }
}
