/** The engine and β that were last entered. Runs use these, and not a value that the user is still typing. */

import { controls } from './controls.ts';
import type { Backend } from './run.ts';

/** The settings of a run, as options of the package. */
export interface Settings {
  readonly backend: Backend;
  readonly maxNormalAngle: number;
}

export class Choices {
  #settings: Settings;
  /** The text of β's control at the last entry. */
  #beta: string;
  /** Whether the user has chosen β. Else it follows the mesh. */
  #isOwn = false;

  /** Takes the values of the controls, because some browsers restore them when a page is reloaded. */
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
   * Takes the values of the controls.
   *
   * @throws if β is not an angle; its control then shows the previous value.
   */
  enter(): void {
    if (!isAngle(controls.beta.valueAsNumber)) {
      controls.beta.value = this.#beta;
      throw new Error('β is an angle from 0 to 180 degrees.');
    }
    this.#isOwn ||= controls.beta.value !== this.#beta;
    this.#settings = settingsNow();
    this.#beta = controls.beta.value;
  }

  /** Takes the β that suits a mesh, unless the user has chosen one or is typing it. */
  suggest(beta: number): void {
    if (this.#isOwn || controls.beta.value !== this.#beta) return;
    this.set({ ...this.#settings, maxNormalAngle: beta });
  }

  /** Changes the settings and shows them, but does not overwrite a β that the user is typing. */
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
