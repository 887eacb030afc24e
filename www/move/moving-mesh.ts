/** A mesh that moves, on either engine. */

import type { Counters } from 'edgeflip';
import type { IndexedMesh } from 'edgeflip/files';
import type { Step } from './motions.ts';
import type { MovingSurface } from './moving-surface.ts';

export interface MovingMesh {
  /** The engine and the adapter, for people. */
  readonly engine: string;
  readonly surface: MovingSurface;
  /** Moves the vertices by a frame, flips edges, and updates what is drawn. */
  frame(step: Step): Promise<void>;
  /** Resolves when the device has done all frames. */
  settled(): Promise<void>;
  /** Flips what the budgets of the frames have left. */
  finish(): Promise<void>;
  counters(): Promise<Counters>;
  /** The present mesh. */
  mesh(): Promise<IndexedMesh>;
  free(): void;
}

/** Seconds before the start: no edge has flipped since. */
export const LONG_AGO = -1000;
