/** The engine and the limits that were last entered. Runs use these, and not a value that is still being typed. */

import { controls } from './controls.ts';
import type { Backend } from './run.ts';

/** The settings of a run. */
export interface Settings {
  readonly backend: Backend;
  /** β in degrees. */
  readonly maxNormalAngle: number;
  /** How far a flip may move the surface, in units of the mesh; `undefined` for no limit. */
  readonly maxDeviation: number | undefined;
  /** Edges at which the input bends by more than this angle are locked; `undefined` locks none. */
  readonly features: number | undefined;
  /** Whether edges between groups of triangles, such as materials, are locked. */
  readonly keepsGroups: boolean;
}

/** What a link says of the settings. */
export type Preference = { [key in keyof Omit<Settings, 'keepsGroups'>]: Settings[key] | undefined };

/** The controls that hold a number, and what may be entered. */
const FIELDS = [
  { input: controls.beta, isValid: isAngle, rule: 'β is an angle from 0 to 180 degrees.' },
  {
    input: controls.deviation,
    isValid: (value: number | undefined) => value === undefined || value >= 0,
    rule: 'Enter how far a flip may move the surface: 0 or more, in units of the mesh. Leave it empty for no limit.',
  },
  {
    input: controls.feature,
    isValid: (value: number | undefined) => value === undefined || isAngle(value),
    rule: 'Enter an angle from 0 to 180 degrees, over which an edge is sharp. Leave it empty to lock none.',
  },
];

export class Choices {
  #settings: Settings;
  /** The texts of the controls at the last entry. */
  #entered: string[] = [];
  #preferred: Pick<Preference, 'maxNormalAngle' | 'maxDeviation'> = {
    maxNormalAngle: undefined,
    maxDeviation: undefined,
  };
  /** Whether the user has chosen β. Else it follows the mesh. */
  #isOwn = false;

  /** Takes the values of the controls, because some browsers restore them when a page is reloaded. */
  constructor() {
    for (const { input, isValid } of FIELDS) if (!isValid(numberIn(input))) input.value = input.defaultValue;
    this.#settings = this.#take();
  }

  get settings(): Settings {
    return this.#settings;
  }

  /**
   * Takes the values of the controls.
   *
   * @throws if a number is not allowed; its control then shows the previous number.
   */
  enter(): void {
    FIELDS.forEach(({ input, isValid, rule }, i) => {
      if (!input.validity.badInput && isValid(numberIn(input))) return;
      input.value = this.#entered[i]!;
      throw new Error(rule);
    });
    this.#isOwn ||= controls.beta.value !== this.#entered[0];
    this.#settings = this.#take();
  }

  /** Sets what a link says, for the mesh that is opened next. */
  prefer({ backend, maxNormalAngle, maxDeviation, features }: Preference): void {
    this.#preferred = { maxNormalAngle, maxDeviation };
    this.set({ ...this.#settings, features, ...(backend ? { backend } : {}) });
  }

  /** Takes the β that suits a mesh, unless the user has chosen one or is typing it. No other limit suits another mesh. */
  suggest(beta: number): void {
    const { maxNormalAngle, maxDeviation } = this.#preferred;
    this.#preferred = { maxNormalAngle: undefined, maxDeviation: undefined };
    const isOwn = this.#isOwn || controls.beta.value !== this.#entered[0];
    const suits = maxNormalAngle ?? (isOwn ? this.#settings.maxNormalAngle : beta);
    this.set({ ...this.#settings, maxDeviation, maxNormalAngle: suits });
  }

  /** Changes the settings and shows them, but does not overwrite a number that the user is typing. */
  set(settings: Settings): void {
    const { backend, maxNormalAngle, maxDeviation, features, keepsGroups } = settings;
    this.#settings = settings;
    controls.backend.value = backend;
    controls.groups.checked = keepsGroups;
    [maxNormalAngle, maxDeviation, features].forEach((value, i) => {
      const { input } = FIELDS[i]!;
      const text = value === undefined ? '' : `${value}`;
      if (input.value === this.#entered[i]) input.value = text;
      this.#entered[i] = text;
    });
    controls.betaRange.value = `${maxNormalAngle}`;
  }

  #take(): Settings {
    this.#entered = FIELDS.map(({ input }) => input.value);
    controls.betaRange.value = controls.beta.value;
    return {
      backend: controls.backend.value as Backend,
      maxNormalAngle: controls.beta.valueAsNumber,
      maxDeviation: numberIn(controls.deviation),
      features: numberIn(controls.feature),
      keepsGroups: controls.groups.checked,
    };
  }
}

function numberIn(input: HTMLInputElement): number | undefined {
  return input.value === '' ? undefined : input.valueAsNumber;
}

function isAngle(degrees: number | undefined): boolean {
  return degrees !== undefined && degrees >= 0 && degrees <= 180;
}
