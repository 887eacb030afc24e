/** What is shown. */

import type { Settings } from './choices.ts';
import type { Opened } from './opening.ts';
import type { Run } from './run.ts';

/** An open mesh, its run and the settings of that run. */
export interface Shown {
  opened: Opened;
  run: Run;
  settings: Settings;
}
