/** Measures the triangles that the page shows. */

import { BINS, type Opened } from './opening.ts';
import type { Panel } from './panel.ts';
import type { Run } from './run.ts';

/** Measures `indices`, the shown triangles of `run`, and shows the numbers unless they are outdated by then. */
export async function measure(
  panel: Panel,
  { mesh, client, before: measureInput }: Opened,
  run: Run,
  indices: Uint32Array,
  isOutdated: () => boolean,
): Promise<void> {
  const before = await measureInput();
  const now = run.at === 0 ? before : await client.call((worker) => worker.measure({ ...mesh, indices }, BINS));
  if (isOutdated()) return;
  panel.showQuality(before, now);
  if (!run.isOver) return;
  const change = await client.call((worker) => worker.compare(mesh, indices));
  if (!isOutdated()) panel.showQuality(before, now, change);
}
