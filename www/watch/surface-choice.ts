/** The choice between the colours of the file and a plain surface. It is there if the file has colours. */

import { controls, element } from './controls.ts';
import type { FileColours } from './colour-format.ts';
import type { FileSurface } from './file-surface.ts';
import type { Opened } from './opening.ts';
import type { Scene } from './scene.ts';

export class SurfaceChoice {
  readonly #scene: () => Scene | undefined;
  #opened: Opened | undefined;
  /** The surface that is drawn, what it was made from, and where it is drawn. */
  #made: { surface: FileSurface; colours: FileColours; scene: Scene } | undefined;

  constructor(scene: () => Scene | undefined) {
    this.#scene = scene;
    controls.surface.addEventListener('change', () => this.#show());
  }

  /** Whether the surface has the colours of the file. */
  get isAsInFile(): boolean {
    return this.#made !== undefined && controls.surface.value === 'file';
  }

  /** Takes another mesh, or none, whose positions are set; `isOther`: whether its vertices are others than before. */
  begin(opened: Opened | undefined, isOther: boolean): void {
    this.#opened = opened;
    if (isOther) controls.surface.value = 'file';
    const scene = this.#scene();
    const isKept = this.#made && this.#made.colours === opened?.extras?.colours && this.#made.scene === scene;
    if (isKept) return this.#show();
    this.#made?.surface.dispose();
    this.#made = undefined;
    this.#show();
  }

  /** Finds the colours of the file, and shows them. */
  async find(): Promise<void> {
    const [opened, scene] = [this.#opened, this.#scene()];
    if (!opened?.extras || !scene) return;
    await opened.extras.find();
    const { colours } = opened.extras;
    if (!colours || this.#made) return;
    const module = await import('./file-surface.ts');
    if (opened !== this.#opened || scene !== this.#scene() || this.#made) return;
    this.#made = { surface: new module.FileSurface(colours), colours, scene };
    this.#show();
  }

  /** Chooses the other one, if there is a choice. */
  toggle(): void {
    if (!this.#made) return;
    controls.surface.value = this.isAsInFile ? 'plain' : 'file';
    this.#show();
  }

  #show(): void {
    element('surface-label').hidden = this.#made === undefined;
    document.body.dataset['surface'] = this.isAsInFile ? 'file' : 'plain';
    this.#scene()?.setFile(this.#made?.surface, this.isAsInFile);
  }
}
