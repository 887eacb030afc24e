/** How many threads work. */

/**
 * The most threads, and the fewest triangles of a mesh on several threads, and of each thread. A test in
 * `src/system/threads.rs` compares them with the limits of the modules.
 */
export const MOST_THREADS = 256;
export const FEWEST_TRIANGLES = 65_536;
export const FEWEST_EACH = 4096;

/** The workers of Node. A bundler would replace `process` without `globalThis` by a package. */
export const node = globalThis.process?.getBuiltinModule?.('node:worker_threads');

/** Whether workers can share memory. */
const isShared = typeof SharedArrayBuffer !== 'undefined' && (globalThis.crossOriginIsolated ?? node !== undefined);

/** The largest number of threads that the caller wants. */
interface Wanted {
  threads?: number | undefined;
}

/** The number of threads for so many triangles. */
export function threadCount(triangles: number, { threads }: Wanted): number {
  if (!isShared || triangles < FEWEST_TRIANGLES) return 1;
  return Math.max(1, Math.min(threads ?? coreCount(), MOST_THREADS, Math.floor(triangles / FEWEST_EACH)));
}

function coreCount(): number {
  return (
    globalThis.navigator?.hardwareConcurrency ??
    (node ? globalThis.process.getBuiltinModule('node:os').availableParallelism() : 1)
  );
}

/** Why so many triangles have one thread, if they could use more. */
export function whyOneThread(triangles: number, { threads }: Wanted): string | undefined {
  if (isShared || triangles < FEWEST_TRIANGLES || threads === 1) return undefined;
  return 'workers cannot share memory here; make the page cross-origin isolated, by the headers COOP and COEP';
}
