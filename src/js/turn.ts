/** Lets the page handle events during a run on the CPU; without this, not even an abort would be noticed. */

/** Milliseconds that a run may block the page: half a frame. */
const SLICE = 8;

/** Yields to the page at intervals. */
export class Turns {
  #since = performance.now();

  /** Yields if the last time is at least `SLICE` ago. */
  async give(): Promise<void> {
    if (performance.now() - this.#since < SLICE) return;
    await turn();
    this.#since = performance.now();
  }
}

/** Resolves after the tasks that are already queued. A message is a task, and is not throttled as a timer is. */
function turn(): Promise<void> {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(undefined);
  });
}
