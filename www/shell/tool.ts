/** Loads the tool: while the browser is idle, when the visitor is about to ask for it, or when it is shown. */

import type { Tool } from '../watch/main.ts';

/** Milliseconds after which the tool is loaded even if the browser is not idle: the first view moves all the time. */
const LATEST = 100;

let loading: Promise<Tool> | undefined;
let started: Tool | undefined;

/** The tool, once it has been started. */
export const startedTool = () => started;

/** Starts the tool at the first call. It opens its first mesh, also while it is not shown. */
export function loadTool(): Promise<Tool> {
  loading ??= load().catch((error: unknown) => {
    // The next call tries again.
    loading = undefined;
    throw error;
  });
  return loading;
}

async function load(): Promise<Tool> {
  const [{ start }] = await Promise.all([
    import('../watch/main.ts'),
    import('../watch/ahead.ts').then(({ startAhead }) => startAhead()),
  ]);
  return (started = start());
}

/** Loads the tool before it is asked for, unless the visitor wants to save data. */
export async function loadToolAhead(): Promise<void> {
  const { connection }: { connection?: { saveData?: boolean } } = navigator as object;
  // If it fails, it is loaded again when it is shown.
  if (!connection?.saveData)
    await loadTool().then(
      (tool) => tool.drawn(),
      () => {},
    );
}

/** Loads the tool ahead when the browser is idle. */
export async function loadToolWhenIdle(): Promise<void> {
  await new Promise((done) => {
    // Safari has no idle callbacks.
    if ('requestIdleCallback' in window) requestIdleCallback(done, { timeout: LATEST });
    else setTimeout(done, LATEST);
  });
  await loadToolAhead();
}
