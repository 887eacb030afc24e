/** Gives the page its turn: without it, a run on the CPU would let nothing else happen, not even an abort. */

/** Milliseconds that a run may take at a time: half a frame. */
const SLICE = 8;

/** Waits for the page, once the last wait is long enough ago. */
export class Turns {
  #since = performance.now();

  /** Ends at once, or after everything that was waiting for the thread. */
  async give(): Promise<void> {
    if (performance.now() - this.#since < SLICE) return;
    await turn();
    this.#since = performance.now();
  }
}

/** Ends after everything that was waiting. A message is a task of its own, and is not held back as a timer is. */
export function turn(): Promise<void> {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(undefined);
  });
}
