/** Before and now: a line across the picture; the input is at its left. */

import { controls, element } from './controls.ts';
import type { Scene } from './scene.ts';

/** Half of the grip, in pixels. The line ends so far from the sides, so that the whole grip is on the page. */
const HALF = 22;

export class Comparison {
  readonly #scene: () => Scene | undefined;
  /** The input of the open mesh. */
  #input: Uint32Array | undefined;

  constructor(scene: () => Scene | undefined) {
    this.#scene = scene;
    controls.cut.addEventListener('input', () => this.#cut());
    new ResizeObserver(() => this.isShown && this.#cut()).observe(element('halves'));
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
      controls.cut.valueAsNumber = (1000 * (scene.camera.middle[0] - HALF)) / (scene.canvas.clientWidth - 2 * HALF);
    }
    element('halves').hidden = !isShown;
    controls.compare.ariaPressed = `${isShown}`;
    if (isShown) this.#cut();
    else if (scene) scene.cut = undefined;
  }

  #cut(): void {
    const scene = this.#scene();
    if (!scene) return;
    const { clientWidth: width } = scene.canvas;
    const x = HALF + (controls.cut.valueAsNumber / 1000) * (width - 2 * HALF);
    element('halves').style.setProperty('--cut', `${x}px`);
    scene.cut = x / width;
  }
}
