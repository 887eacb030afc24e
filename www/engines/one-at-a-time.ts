/** Lets one measurement run at a time. Two at once would slow each other down. */

export class OneAtATime {
  readonly #buttons: HTMLButtonElement[] = [];
  #running: AbortController | undefined;

  /** The button starts `work`; meanwhile it stops it, and the other buttons wait. Afterwards, it says `again`. */
  offer(button: HTMLButtonElement, again: string, work: (signal: AbortSignal) => Promise<void>): void {
    this.#buttons.push(button);
    button.addEventListener('click', async () => {
      if (this.#running) {
        this.#running.abort();
        return;
      }
      this.#running = new AbortController();
      button.textContent = 'Stop';
      for (const other of this.#buttons) other.disabled = other !== button;
      await work(this.#running.signal);
      this.#running = undefined;
      button.textContent = again;
      for (const other of this.#buttons) other.disabled = false;
    });
  }
}
