/** The stops between the phases of an iteration, for small meshes: Label, Select, Flip and Update, with their marks. */

import { EDGE_STATES } from 'edgeflip';
import { select } from 'd3-selection';
import { arrow, between, middle, polyline, towards } from '../explain/draw.ts';
import type { Point } from '../explain/mesh.ts';
import { keyOf, relinked } from '../explain/phases.ts';
import { cornersOf, halvesOf, next } from '../explain/planar.ts';
import { made } from '../shell/elements.ts';
import { counted, number } from '../shell/numbers.ts';
import { element } from './controls.ts';
import { flipsBetween } from './flip-animation.ts';
import { widthOf } from './plan.ts';
import type { Run } from './run.ts';
import type { Scene } from './scene.ts';
import { waitOf } from './sentences.ts';
import type { Shown } from './shown.ts';

/** The most triangles of a mesh that stops between phases. */
export const FEW = 500;

const PHASES = ['label', 'select', 'flip', 'update'] as const;
type Phase = (typeof PHASES)[number];

const [DELAUNAY, FLIPS, WAITS] = (['delaunay', 'flips', 'waits'] as const).map((name) => EDGE_STATES.indexOf(name)) as [
  number,
  number,
  number,
];

/** What it needs of the page. */
export interface PhasesHost {
  scene(): Scene | undefined;
  shown(): Shown | undefined;
  /** Runs an iteration, or goes back by one, and draws it. */
  step(): Promise<void>;
  back(): Promise<void>;
  redraw(): Promise<void>;
  /** Draws edges in the colours of their states. */
  colour(): void;
}

/** An edge that can flip: its lower half-edge and the other one. */
type Candidate = { halves: [number, number]; flips: boolean };

export class Phases {
  readonly #host: PhasesHost;
  #phase: Phase | undefined;
  /** The run and the iteration that the phase belongs to. */
  #run: Run | undefined;
  #at = 0;
  #now: readonly number[] = [];
  /** The triangles of each iteration that was shown. */
  #seen = new Map<number, readonly number[]>();
  #last: Promise<unknown> = Promise.resolve();

  constructor(host: PhasesHost) {
    this.#host = host;
  }

  /** Goes on by a phase, or back by one, after the step before. Returns whether the mesh has phases to stop at. */
  step(by: 1 | -1): Promise<boolean> {
    const call = this.#last.then(() => this.#step(by));
    this.#last = call.catch(() => undefined);
    return call;
  }

  /** Another run begins, which has not stopped anywhere. */
  begin(): void {
    this.#phase = this.#run = undefined;
    this.#seen.clear();
  }

  async #step(by: 1 | -1): Promise<boolean> {
    const shown = this.#host.shown();
    if (!shown?.run.states || shown.opened.mesh.indices.length > 3 * FEW) return false;
    this.#host.colour();
    const { run } = shown;
    const index = this.#phase ? PHASES.indexOf(this.#phase) : -1;
    if (by > 0) {
      if (index === 0 && this.#candidates().length === 0) return true;
      if (index === 1) await this.#cross('flip', run.at + 1, this.#host.step);
      else await this.#stop(PHASES[(index + 1) % 4]!);
    } else if (index === 2) await this.#cross('select', run.at - 1, this.#host.back);
    else if (index > 0) await this.#stop(PHASES[index - 1]!);
    else if (run.at === 0) await this.#stop(undefined);
    else if (index === 0 && this.#seen.has(run.at - 1)) await this.#stop('update');
    else await this.#cross('select', run.at - 1, this.#host.back);
    return true;
  }

  /** Stops at a phase of another iteration, if there is one. */
  async #cross(phase: Phase, at: number, go: () => Promise<void>): Promise<void> {
    const before = [this.#phase, this.#at] as const;
    [this.#phase, this.#at] = [phase, at];
    await go();
    if (this.#host.shown()?.run.at !== at) [this.#phase, this.#at] = before;
  }

  async #stop(phase: Phase | undefined): Promise<void> {
    this.#phase = phase;
    this.#at = this.#host.shown()!.run.at;
    await this.#host.redraw();
  }

  /**
   * Takes the triangles that are shown. Returns the states to draw: where a stop has marks of its own, edges that can flip
   * look like the others.
   */
  take(run: Run, indices: Uint32Array, states: Uint8Array): Uint8Array {
    if (run !== this.#run) this.#seen.clear();
    if (run !== this.#run || run.at !== this.#at) this.#phase = undefined;
    this.#run = run;
    if (indices.length > 3 * FEW) return states;
    this.#now = [...indices];
    this.#seen.set(run.at, this.#now);
    if (!this.#phase || this.#phase === 'select') return states;
    return states.map((state) => (state === FLIPS || state === WAITS ? DELAUNAY : state));
  }

  /** Says where it has stopped, in place of what the page says of the iteration. */
  say(): void {
    const phase = this.#phase;
    if (!phase || this.#host.shown()?.run.at !== this.#at) return;
    const candidates = this.#candidates();
    const flips = candidates.filter((edge) => edge.flips).length;
    const waits = candidates.length - flips;
    const sentences: Record<Phase, () => string> = {
      label: () => `${counted(candidates.length, 'edge')} can flip.`,
      select: () =>
        `Each triangle points to one of its edges that can flip: ${number.format(flips)} ${flips === 1 ? 'flips' : 'flip'}${waits > 0 ? `, ${waitOf(waits)}` : ''}.`,
      flip: () => `${counted(this.#flips().length / 4, 'edge')} flipped at once.`,
      update: () => {
        const sides = this.#changed().length;
        return `${sides === 1 ? '1 side of a triangle has' : `${number.format(sides)} sides of triangles have`} a new neighbour.`;
      },
    };
    const name = `${phase[0]!.toUpperCase()}${phase.slice(1)}.`;
    element('status').replaceChildren(made('b', '', name), ` ${sentences[phase]()}`);
  }

  /** Draws the marks over the picture, where the camera sees the mesh now. */
  draw(): void {
    const scene = this.#host.scene();
    const isOn = this.#phase && scene && element('halves').hidden && this.#host.shown()?.run.at === this.#at;
    select(element('thread'))
      .selectAll<SVGPathElement, [string, string]>('path.phase')
      .data(isOn ? this.#marks(scene.projector()) : [])
      .join('path')
      .attr('class', ([kind]) => `phase ${kind}`)
      .attr('d', ([, d]) => d);
  }

  /** The kind of each mark, and its path. */
  #marks(at: (vertex: number) => Point): [string, string][] {
    const places = (vertices: readonly number[]) => vertices.map(at);
    const now = cornersOf(this.#now).map(places);
    const centres = now.map((corners) => middle(...corners));
    // The picture's y points down, so a triangle that faces the camera is clockwise.
    const mesh = this.#host.shown()?.opened.mesh;
    const isFlat = mesh !== undefined && widthOf(mesh) === 2;
    const isSeen = (t: number) => {
      const [[ax, ay], [bx, by], [cx, cy]] = now[t] as [Point, Point, Point];
      return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) < 0 || isFlat;
    };
    const ends = (half: number) => places([this.#now[half]!, this.#now[next(half)]!]);
    const candidates = this.#candidates().filter(({ halves }) => halves.some((half) => isSeen(triangleOf(half))));
    if (this.#phase === 'label') return candidates.map(({ halves: [half] }) => ['candidate', polyline(ends(half))]);
    if (this.#phase === 'select') {
      return this.#choices(candidates).flatMap(([t, half]): [string, string][] => {
        const from = centres[t]!;
        return isSeen(t) ? [['choice', arrow(from, towards(middle(...ends(half)), from, 5), 7)]] : [];
      });
    }
    if (this.#phase === 'flip') {
      const halves = halvesOf(this.#now);
      const flips = this.#flips();
      return Array.from({ length: flips.length / 4 }, (_, i) => [...flips.subarray(4 * i, 4 * i + 4)]).flatMap(
        ([a, b, c, d]): [string, string][] => {
          const half = halves.get(`${c} ${d}`) ?? halves.get(`${d} ${c}`);
          if (half === undefined || !isSeen(triangleOf(half))) return [];
          return [
            ['old', polyline(places([a!, b!]))],
            ['fresh', polyline(places([c!, d!]))],
          ];
        },
      );
    }
    return this.#changed()
      .filter(({ triangle }) => isSeen(triangle))
      .map(({ triangle, neighbour, ends }) => {
        const side = middle(...places(ends));
        return ['link', arrow(between(centres[triangle]!, side, 0.4), between(side, centres[neighbour]!, 0.55), 7)];
      });
  }

  /** The edges that can flip at the shown iteration. */
  #candidates(): Candidate[] {
    const states = this.#host.shown()?.run.states;
    if (!states) return [];
    const halves = halvesOf(this.#now);
    return this.#now.flatMap((from, half): Candidate[] => {
      if (states[half] !== FLIPS && states[half] !== WAITS) return [];
      const twin = halves.get(`${this.#now[next(half)]} ${from}`);
      return twin !== undefined && half < twin ? [{ halves: [half, twin], flips: states[half] === FLIPS }] : [];
    });
  }

  /** The edge of the smallest number in each triangle, as the triangle and a half-edge. */
  #choices(candidates: readonly Candidate[]): [number, number][] {
    const key = ({ halves: [lower] }: Candidate) => keyOf(lower, this.#at);
    const best = new Map<number, number>();
    for (const edge of candidates.toSorted((one, other) => key(other) - key(one))) {
      for (const half of edge.halves) best.set(triangleOf(half), half);
    }
    return [...best];
  }

  /** The triangles before the iteration that has led here. */
  get #before(): readonly number[] {
    return this.#seen.get(this.#at - 1) ?? this.#now;
  }

  #flips = () => flipsBetween(Uint32Array.from(this.#before), Uint32Array.from(this.#now));

  #changed = () => relinked({ before: this.#before, after: this.#now });
}

const triangleOf = (half: number) => Math.floor(half / 3);
