/** A mesh that moves, on either engine, or points. */

import type { Counters } from 'edgeflip';
import type { IndexedMesh } from 'edgeflip/files';
import type { Object3D } from 'three/webgpu';
import type { Palette } from '../watch/palette.ts';
import type { Drag, Step } from './motions.ts';

/** What is drawn. */
export interface MovingPicture {
  readonly object: Object3D;
  setPalette(palette: Palette): void;
}

export interface MovingMesh {
  /** The engine and the adapter, for people. */
  readonly engine: string;
  readonly surface: MovingPicture;
  /** Moves the vertices by a frame, flips edges, and updates what is drawn. */
  frame(step: Step): Promise<void>;
  /** Resolves when the device has done all frames. */
  settled(): Promise<void>;
  /** Flips what the budgets of the frames have left. */
  finish(): Promise<void>;
  counters(): Promise<Pick<Counters, 'flips' | 'updates' | 'remaining' | 'inverted' | 'flat'>>;
  /** The present mesh. */
  mesh(): Promise<IndexedMesh>;
  free(): void;
}

/** The pointer, as it takes hold of a mesh. */
export interface Grip {
  readonly isHeld: boolean;
  /** Whether the mesh is not yet where the pointer has dragged it. */
  readonly isBehind: boolean;
  /** What the pointer has done since the last call. */
  take(): Drag | undefined;
  dispose(): void;
}

/** Seconds before the start: no edge has flipped since. */
export const LONG_AGO = -1000;
