/** The page's GPU device and the scene that is drawn on it. */

import { element } from './controls.ts';
import { isLecture } from './lecture.ts';
import { openGpu, type Gpu } from './engines.ts';
import type { Insets } from './camera.ts';
import { palette } from './palette.ts';
import { Scene } from './scene.ts';

export class Graphics {
  readonly #lost: (reason: string) => void;
  readonly #drawn: () => void;
  #ready: Promise<void> = Promise.resolve();
  /** The device, or why there is none; `undefined` until the search has ended. */
  gpu: Gpu | string | undefined;
  /** `undefined` until the search for a device has ended, and if the browser cannot draw. */
  scene: Scene | undefined;

  /** `lost` is called with the reason when the device is lost, and `drawn` after each picture. */
  constructor(lost: (reason: string) => void, drawn: () => void) {
    this.#lost = lost;
    this.#drawn = drawn;
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
      this.scene = await Scene.create(element('view'), device, palette(), coveredBy, this.#drawn);
    } catch {
      element('no-mesh').textContent =
        'This browser cannot draw the mesh: it has no WebGPU and no WebGL2. The numbers are still correct.';
      element('no-mesh').hidden = false;
    }
    this.gpu = device && !this.scene?.isOnWebGpu ? 'the page could not draw with WebGPU' : gpu;
    void device?.lost.then(({ message }) => this.#lost(message.replace(/\.$/, '') || 'no reason given'));
  }
}

/** What lies on the picture, and covers its sides. */
function coveredBy(): Insets {
  const box = (id: string) => element(id).getBoundingClientRect();
  const [stage, status] = [box('stage'), box('status')];
  const isWide = status.top < stage.bottom;
  const title = box('about').bottom - stage.top + 12;
  if (!isWide) {
    const top = box('choose').bottom - stage.top + 8;
    return { left: 16, right: 16, top, bottom: 16, title: top };
  }
  const right = stage.right - (document.querySelector('#watch .side')?.getBoundingClientRect().left ?? stage.right);
  const left = box('gallery').right - stage.left + 16;
  return { left, right, top: isLecture() ? title : 72, bottom: stage.bottom - status.bottom + 48, title };
}
