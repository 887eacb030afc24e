/** How a worker becomes a thread of a pool. */

/** The exports of a module whose instances share their memory. */
interface Exports {
  initSync(given: { module: WebAssembly.Module; memory?: WebAssembly.Memory }): unknown;
  startThreads(count: number): WebAssembly.Memory;
  work(): void;
}

/** The first calls of each worker. */
export const begin = ({ initSync, startThreads, work }: Exports) => ({
  /** Makes this worker the first of `count` threads, and returns the memory that all share. */
  start(module: WebAssembly.Module, count: number): WebAssembly.Memory {
    initSync({ module });
    return startThreads(count);
  },
  /** Makes this worker one of the other threads. Never returns. */
  work(module: WebAssembly.Module, memory: WebAssembly.Memory): void {
    // If another thread grows the memory while this one receives it, V8 may keep the old size here, and a write beyond
    // it is a trap: seen in Node 20.20.2, 24.21.0 and 25.9.0. To grow by 0 fetches the size.
    memory.grow(0);
    initSync({ module, memory });
    work();
  },
});
