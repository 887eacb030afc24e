/** The engine and β as they were last entered: what runs are begun with, unlike what is still being typed. */

import { controls } from './controls.ts';
import type { Backend } from './run.ts';

/** What a run is begun with, as options of the package. */
export interface Settings {
  readonly backend: Backend;
  readonly maxNormalAngle: number;
}

export class Choices {
  #settings: Settings;
  /** β as its control had it then. */
  #beta: string;

  /** Takes what the controls say: some browsers restore it where a page is loaded again. */
  constructor() {
    const { beta } = controls;
    if (!isAngle(beta.valueAsNumber)) beta.value = beta.defaultValue;
    this.#settings = settingsNow();
    this.#beta = beta.value;
  }

  get settings(): Settings {
    return this.#settings;
  }

  /**
   * Takes what the controls say.
   *
   * @throws where β is no angle; it gives way to the one before.
   */
  enter(): void {
    if (!isAngle(controls.beta.valueAsNumber)) {
      controls.beta.value = this.#beta;
      throw new Error('β is an angle from 0 to 180 degrees.');
    }
    this.#settings = settingsNow();
    this.#beta = controls.beta.value;
  }

  /** Goes over to other settings and shows them, but for a β that is being typed. */
  set(settings: Settings): void {
    const isTyping = controls.beta.value !== this.#beta;
    this.#settings = settings;
    this.#beta = `${settings.maxNormalAngle}`;
    controls.backend.value = settings.backend;
    if (!isTyping) controls.beta.value = this.#beta;
  }
}

function settingsNow(): Settings {
  return { backend: controls.backend.value as Backend, maxNormalAngle: controls.beta.valueAsNumber };
}

function isAngle(degrees: number): boolean {
  return degrees >= 0 && degrees <= 180;
}
