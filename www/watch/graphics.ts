/** The page's GPU device and the scene that is drawn on it. */

import { element } from './controls.ts';
import { openGpu, type Gpu } from './engines.ts';
import { palette } from './palette.ts';
import { Scene } from './scene.ts';

export class Graphics {
  readonly #lost: (reason: string) => void;
  #ready: Promise<void> = Promise.resolve();
  /** The device, or why there is none; `undefined` until the search has ended. */
  gpu: Gpu | string | undefined;
  /** `undefined` until the search for a device has ended, and if the browser cannot draw. */
  scene: Scene | undefined;

  /** `lost` is called with the reason when the device is lost. */
  constructor(lost: (reason: string) => void) {
    this.#lost = lost;
  }

  /** Settles when `gpu` and `scene` have their final values. */
  get ready(): Promise<void> {
    return this.#ready;
  }

  /** Opens a device and a scene, which replace the present ones. */
  open(): void {
    this.scene?.dispose();
    this.scene = undefined;
    this.gpu = undefined;
    this.#ready = this.#open();
  }

  async #open(): Promise<void> {
    const gpu = await openGpu();
    const device = typeof gpu === 'string' ? undefined : gpu.device;
    try {
      this.scene = await Scene.create(element('view'), device, palette());
    } catch {
      element('no-mesh').textContent =
        'This browser cannot draw the mesh: it has no WebGPU and no WebGL2. The numbers are still correct.';
      element('no-mesh').hidden = false;
    }
    this.gpu = device && !this.scene?.isOnWebGpu ? 'the page could not draw with WebGPU' : gpu;
    void device?.lost.then(({ message }) => this.#lost(message || 'no reason given'));
  }
}
