/** Where the playground is: its points, their triangles as the rounds began, the stop, and the edge that is explained. */

import type { Point } from './mesh.ts';
import { type Round, runOf } from './phases.ts';
import { halvesOf, isTriangulation, type Planar, planarOf } from './planar.ts';

/** The drawing's size, in the units of the points. Points keep a distance from its border. */
export const AREA: Point = [640, 480];
const BORDER = 14;
export const MOST = 40;
/** The least distance between two points. */
const APART = 8;

/** The stops of a round, after its beginning. */
export const STOPS = ['label', 'select', 'flip', 'update'] as const;

export interface State {
  planar: Planar;
  /** The phases that have run: four to a round. */
  phase: number;
  /** After a whole round, without the marks of its last phase. */
  isPlain: boolean;
  /** The ends of the edge that is explained. */
  edge: [number, number] | undefined;
}

/** A state with its rounds and what is there at its phase. */
export interface Place extends State {
  rounds: Round[];
  /** The last phase: Label of the last round, which has nothing to flip; 0 without triangles. */
  last: number;
  /** What the phase shows: `start` before the first one and after whole rounds. */
  stop: (typeof STOPS)[number] | 'start';
  /** The round that the stop is in; after its last phase, still that one. */
  round: Round;
  /** The triangles now, and the round that begins with them or has begun with them. */
  triangles: readonly number[];
  tested: Round;
}

export function placeOf(state: State): Place {
  const rounds = runOf(state.planar);
  const last = state.planar.triangles.length === 0 ? 0 : 4 * (rounds.length - 1) + 1;
  const phase = Math.max(0, Math.min(last, state.phase));
  const [begun, within] = [Math.floor(phase / 4), phase % 4];
  const isAtUpdate = within === 0 && phase > 0 && !state.isPlain;
  const tested = rounds[within === 3 ? begun + 1 : begun]!;
  const edge = state.edge && halvesOf(tested.before).has(state.edge.join(' ')) ? state.edge : undefined;
  return {
    ...state,
    phase,
    edge,
    rounds,
    last,
    stop: isAtUpdate ? 'update' : within === 0 ? 'start' : STOPS[within - 1]!,
    round: rounds[isAtUpdate ? begun - 1 : begun]!,
    triangles: tested.before,
    tested,
  };
}

const within = (value: number, size: number) => Math.round(Math.max(BORDER, Math.min(size - BORDER, value)));

/** The nearest place in the drawing that a point may have. */
export const inArea = ([x, y]: Point): Point => [within(x, AREA[0]), within(y, AREA[1])];

/** Whether a place is far enough from all points but `except`. */
export function isFree([x, y]: Point, points: readonly Point[], except = -1): boolean {
  return points.every(([u, v], i) => i === except || Math.hypot(u - x, v - y) >= APART);
}

// Links. A coordinate has two digits, a corner one.

const DIGITS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_';
const digit = (value: number) => DIGITS[value]!;
const valuesOf = (text: string) => Array.from(text, (char) => DIGITS.indexOf(char));

/** The part of the address after `#` that opens this state. */
export function hashOf(place: Place): string {
  const { planar, phase, stop, edge } = place;
  const { points, triangles } = planar;
  const number = (value: number) => digit(value >> 6) + digit(value & 63);
  const parts = new URLSearchParams({ points: points.map(([x, y]) => number(x) + number(y)).join('') });
  if (triangles.length > 0) parts.set('triangles', triangles.map(digit).join(''));
  const rounds = stop === 'update' ? phase / 4 - 1 : Math.floor(phase / 4);
  parts.set('at', stop === 'start' ? `${rounds}` : `${rounds}.${stop}`);
  if (edge) parts.set('edge', edge.join('-'));
  return `explain?${parts}`;
}

/** The state that an address opens; `undefined` if it has no points for the playground. */
export function stateIn(hash: string): State | undefined {
  if (!hash.startsWith('#explain?')) return undefined;
  const parts = new URLSearchParams(hash.slice('#explain?'.length));
  const numbers = valuesOf(parts.get('points') ?? '');
  const points: Point[] = [];
  for (let i = 0; i + 3 < numbers.length; i += 4) {
    const [a, b, c, d] = numbers.slice(i, i + 4) as [number, number, number, number];
    const point = inArea([64 * a + b, 64 * c + d]);
    if (points.length < MOST && isFree(point, points)) points.push(point);
  }
  if (!parts.has('points')) return undefined;
  const given = { points, triangles: valuesOf(parts.get('triangles') ?? '') };
  const planar = isTriangulation(given) ? given : planarOf(points);
  const [rounds, stop] = (parts.get('at') ?? '').split('.');
  const names: readonly (string | undefined)[] = STOPS;
  const index = names.indexOf(stop) + 1;
  const edge = parts.get('edge')?.split('-').map(Number) as [number, number] | undefined;
  return { planar, phase: 4 * (Number(rounds) || 0) + index, isPlain: index === 0, edge };
}
