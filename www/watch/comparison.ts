/** Before and now: a line across the picture; the input is at its left. */

import { controls, element } from './controls.ts';
import type { Scene } from './scene.ts';

export class Comparison {
  readonly #scene: () => Scene | undefined;
  /** The input of the open mesh. */
  #input: Uint32Array | undefined;

  constructor(scene: () => Scene | undefined) {
    this.#scene = scene;
    controls.cut.addEventListener('input', () => this.#cut());
  }

  get isShown(): boolean {
    return !element('halves').hidden;
  }

  /** Takes the input of another mesh, and shows one mesh only. */
  begin(input: Uint32Array): void {
    this.#input = input;
    this.show(false);
  }

  show(isShown: boolean): void {
    const scene = this.#scene();
    if (isShown && this.#input && scene) {
      scene.compareWith(this.#input);
      // Through the middle of the mesh, which is not that of the picture.
      controls.cut.valueAsNumber = (1000 * scene.camera.middle[0]) / scene.canvas.clientWidth;
    }
    element('halves').hidden = !isShown;
    controls.compare.ariaPressed = `${isShown}`;
    if (isShown) this.#cut();
    else if (scene) scene.cut = undefined;
  }

  #cut(): void {
    const share = controls.cut.valueAsNumber / 1000;
    element('halves').style.setProperty('--cut', `${100 * share}%`);
    const scene = this.#scene();
    if (scene) scene.cut = share;
  }
}
