/** Draws the mesh with three.js. With WebGPU, it draws from the buffer that the flips write. */

import { EDGE_STATES } from 'edgeflip';
import {
  ColorManagement,
  Scene as ThreeScene,
  Vector2,
  Vector3,
  WebGPURenderer,
  type BufferAttribute,
  type Object3D,
} from 'three/webgpu';
import { Camera, type Insets } from './camera.ts';
import { BufferCorners, TextureCorners } from './corners.ts';
import { EdgeScale, type Seen } from './edge-scale.ts';
import type { FileSurface } from './file-surface.ts';
import { Layer } from './layer.ts';
import type { Drawn } from './run.ts';
import type { Palette } from './palette.ts';
import type { SlideDirection } from './flip-animation.ts';
import { Paint } from './surface.ts';

/** The part of three's backend that holds the GPU buffers of attributes. */
interface Backend {
  readonly isWebGPUBackend?: boolean;
  get(attribute: BufferAttribute): { buffer?: GPUBuffer };
}

/** The most pixels of a saved picture for a pixel of the style sheets. */
const MOST_SHARP = 3;

// Colours stay as style sheets give them. To convert them, three would draw each picture twice.
ColorManagement.enabled = false;

export class Scene {
  readonly #renderer: WebGPURenderer;
  readonly #device: GPUDevice | undefined;
  readonly #scene = new ThreeScene();
  readonly #paint = new Paint();
  readonly #now: Layer;
  /** The input, at the left of the cut. */
  readonly #before: Layer;
  readonly #scale = new EdgeScale();
  readonly #observer: ResizeObserver;
  readonly #drawn: () => void;
  readonly camera: Camera;
  #palette: Palette;
  #positions = new Float32Array();
  #dimension: 2 | 3 = 3;
  /** The share of the picture's width that shows the input; `undefined` if only one mesh is shown. */
  #cut: number | undefined;
  #frame = 0;
  #moving: Object3D | undefined;
  /** The colours of the mesh's file, and whether they are drawn. */
  #file: [surface: FileSurface | undefined, isShown: boolean] = [undefined, false];
  /** Called when the canvas has a size, and so can be seen. */
  #see = () => {};
  readonly #seen = new Promise<void>((done) => (this.#see = done));

  private constructor(
    renderer: WebGPURenderer,
    device: GPUDevice | undefined,
    palette: Palette,
    insets: () => Insets,
    drawn: () => void,
  ) {
    this.#renderer = renderer;
    this.#device = device;
    this.#palette = palette;
    this.#drawn = drawn;
    const share = this.share.bind(this);
    const onGpu = this.isOnWebGpu ? device : undefined;
    const layer = () => new Layer(onGpu ? new BufferCorners(onGpu, share) : new TextureCorners(), this.#paint);
    [this.#now, this.#before] = [layer(), layer()];
    this.camera = new Camera(renderer.domElement, insets, () => this.redraw());
    this.#scene.add(this.#before.group, this.#now.group);
    this.#before.group.visible = false;
    this.#observer = new ResizeObserver(() => this.#resize());
  }

  /**
   * Draws into `view`: with WebGPU if `device` is given, else with WebGL2. `insets` are the parts that are covered;
   * `drawn` is called after each picture.
   */
  static async create(
    view: HTMLElement,
    device: GPUDevice | undefined,
    palette: Palette,
    insets: () => Insets,
    drawn: () => void,
  ): Promise<Scene> {
    const options = { antialias: true, alpha: true, stencil: true };
    const renderer = new WebGPURenderer({ ...options, ...(device ? { device } : { forceWebGL: true }) });
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setClearColor(0, 0);
    renderer.outputColorSpace = ColorManagement.workingColorSpace;
    await renderer.init();
    const scene = new Scene(renderer, device, palette, insets, drawn);
    view.append(renderer.domElement);
    renderer.domElement.role = 'img';
    renderer.domElement.setAttribute('aria-label', 'The mesh; drag to turn or move it, scroll to zoom');
    scene.setPalette(palette);
    scene.#observer.observe(view);
    scene.#prepare();
    return scene;
  }

  /** Draws a triangle that is a point, so that the browser compiles the shaders before the first mesh is there. */
  #prepare(): void {
    const corners = Uint32Array.of(0, 1, 2);
    this.setMesh(new Float32Array(9), 3);
    this.show(corners, corners.length, false, undefined);
    // Edges of the second state are dashed.
    this.showEdges(corners, Uint8Array.of(EDGE_STATES.indexOf('flips'), EDGE_STATES.indexOf('waits'), 0));
  }

  get canvas(): HTMLCanvasElement {
    return this.#renderer.domElement;
  }

  /** Whether it draws with WebGPU, on the given device. */
  get isOnWebGpu(): boolean {
    return this.#backend.isWebGPUBackend === true;
  }

  /** Sets the positions of a mesh: 3 numbers per vertex, inside the unit ball. */
  setMesh(positions: Float32Array, dimension: 2 | 3): void {
    this.clear();
    this.#positions = positions as Float32Array<ArrayBuffer>;
    this.#dimension = dimension;
    this.#now.surface.setPositions(positions, dimension);
  }

  /** Takes the colours of the file of the mesh, or none, and draws them if `isShown`. */
  setFile(surface: FileSurface | undefined, isShown: boolean): void {
    this.#file = [surface, isShown];
    this.#now.surface.setFile(surface, isShown);
    // Without a surface, the one before is released.
    if (this.#cut !== undefined || !surface) this.#before.surface.setFile(surface, isShown);
    this.redraw();
  }

  /** Shows an object alone, which changes from frame to frame; `bounds` are points, 3 numbers each, that fit around it. */
  showMoving(object: Object3D, bounds: Float32Array, dimension: 2 | 3): void {
    this.setMesh(bounds, dimension);
    this.#moving = object;
    this.#scene.add(object);
    this.lookAtAll();
  }

  lookAtAll(): void {
    this.camera.lookAt(this.#positions, this.#dimension);
  }

  /** Takes the triangles whose edges tell what is seen of edges. */
  measureEdges(indices: Uint32Array): void {
    this.#scale.sample(this.#positions, indices);
  }

  /** What is seen of edges now, if they are drawn. Where they are too short, triangles are tinted. */
  get edgesSeen(): Seen {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    return this.#scale.seen(this.camera.three, width, height);
  }

  /**
   * Draws these triangles. `isLined`: whether with their edges, or with tints where edges are too short. `sides` has the
   * states of their sides, if they are known.
   */
  show(triangles: Drawn, count: number, isLined: boolean, sides: Drawn | undefined): void {
    this.#now.surface.show(triangles, count, isLined, sides);
    this.redraw();
  }

  /** Draws the edges of a small mesh in colours; without arguments, none. */
  showEdges(indices: Uint32Array | undefined, states: Uint8Array | undefined): void {
    this.#now.edges.clear();
    if (indices && states) this.#now.edges.show(this.#positions, indices, states, this.#palette);
    this.redraw();
  }

  /** Shows how edges have flipped, see `flipsBetween`; with an empty list, nothing. */
  animateFlips(flips: Uint32Array, way: SlideDirection): void {
    this.#now.flipAnimation.show(this.#positions, flips, this.#palette.states.flips, way);
    this.redraw();
  }

  /** Shows the input at the left of the cut. */
  compareWith(input: Uint32Array): void {
    this.#before.surface.setPositions(this.#positions, this.#dimension);
    this.#before.surface.setFile(...this.#file);
    this.#before.surface.show(input, input.length, true, undefined);
  }

  /** Moves the cut; `undefined` shows one mesh only. */
  set cut(share: number | undefined) {
    this.#cut = share;
    this.redraw();
  }

  /** Releases all buffers of the run, which may then be destroyed. */
  clear(): void {
    for (const layer of [this.#now, this.#before]) layer.clear();
    if (this.#moving) this.#scene.remove(this.#moving);
    this.#moving = undefined;
    this.#cut = undefined;
    this.redraw();
  }

  setPalette(palette: Palette): void {
    this.#palette = palette;
    this.#paint.setPalette(palette);
    this.redraw();
  }

  /** Draws now, in a frame of the page. */
  draw(): void {
    const isHot = this.#now.flipAnimation.advance();
    this.#draw();
    // The next picture waits until this one is done. On a slow GPU, flips would wait behind several pictures.
    if (isHot) void this.#finished().then(() => this.redraw());
    this.#drawn();
  }

  /** Draws again in the next frame of the page. */
  redraw(): void {
    this.#frame ||= requestAnimationFrame(() => {
      this.#frame = 0;
      this.draw();
    });
  }

  /** Waits for the next picture, if one is due. */
  async painted(): Promise<void> {
    // It comes in the same frame, before this.
    if (this.#frame) await new Promise(requestAnimationFrame);
  }

  /** Waits until the screen has the present picture, in the present size. */
  async shown(): Promise<void> {
    this.#resize();
    await this.painted();
    await this.#finished();
  }

  /** The same, but a canvas that is still hidden has to be shown first. */
  async seen(): Promise<void> {
    await this.#seen;
    await this.shown();
  }

  /** Waits until the GPU has done everything. */
  async #finished(): Promise<void> {
    await this.#device?.queue.onSubmittedWorkDone().catch(() => {});
  }

  /** A picture of what is shown, on the page's ground. */
  async picture(ground: string): Promise<Blob> {
    const { width, height } = this.canvas;
    const canvas = new OffscreenCanvas(width, height);
    const context = canvas.getContext('2d')!;
    context.fillStyle = ground;
    context.fillRect(0, 0, width, height);
    // A canvas can be read only until the browser has shown it.
    this.#draw();
    context.drawImage(this.canvas, 0, 0);
    return canvas.convertToBlob();
  }

  /** The part of the picture that nothing covers, at rest and without a cut, at least `least` pixels wide. */
  freePicture(least: number): OffscreenCanvas {
    const { x, y, width, height } = this.camera.free;
    const [before, cut] = [this.#renderer.getPixelRatio(), this.#cut];
    const ratio = Math.min(MOST_SHARP, Math.max(before, least / width));
    this.#cut = undefined;
    this.animateFlips(new Uint32Array(), 'not');
    this.#renderer.setPixelRatio(ratio);
    const canvas = new OffscreenCanvas(Math.round(ratio * width), Math.round(ratio * height));
    // A canvas can be read only until the browser has shown it.
    this.#draw();
    canvas.getContext('2d')?.drawImage(this.canvas, -ratio * (x - width / 2), -ratio * (y - height / 2));
    this.#renderer.setPixelRatio(before);
    this.#cut = cut;
    this.redraw();
    return canvas;
  }

  /** The half-edge nearest to a point of the picture, in pixels; `undefined` beside the mesh. */
  pick(x: number, y: number, indices: Uint32Array): number | undefined {
    const ray = this.camera.rayAt(x, y);
    const corners = [new Vector3(), new Vector3(), new Vector3()] as const;
    const load = (t: number) => corners.forEach((corner, k) => corner.fromArray(this.#positions, 3 * indices[t + k]!));
    const hit = new Vector3();
    let [nearest, found] = [Infinity, -1];
    for (let t = 0; t < indices.length; t += 3) {
      load(t);
      if (!ray.intersectTriangle(corners[0], corners[1], corners[2], false, hit)) continue;
      const distance = hit.distanceToSquared(ray.origin);
      if (distance < nearest) [nearest, found] = [distance, t];
    }
    if (found < 0) return undefined;
    const ends = [found, found + 1, found + 2].map((h) => indices[h]!).map(this.projector());
    const distances = [0, 1, 2].map((k) => distanceTo([x, y], ends[k]!, ends[(k + 1) % 3]!));
    return found + distances.indexOf(Math.min(...distances));
  }

  /** Returns a function that says where a vertex is in the picture, in pixels. */
  projector(): (vertex: number) => [x: number, y: number] {
    const project = this.camera.projector();
    return (vertex) => project(new Vector3().fromArray(this.#positions, 3 * vertex));
  }

  /** Removes the canvas. The buffers of the run stay. */
  dispose(): void {
    cancelAnimationFrame(this.#frame);
    this.#frame = -1;
    this.#observer.disconnect();
    this.camera.dispose();
    this.#renderer.domElement.remove();
    this.#renderer.dispose();
  }

  #draw(): void {
    const renderer = this.#renderer;
    this.#now.edges.setPixel(this.camera.pixel);
    this.#paint.ratio.value = renderer.getPixelRatio();
    if (this.#cut === undefined) {
      renderer.render(this.#scene, this.camera.three);
      return;
    }
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const x = Math.round(this.#cut * width);
    renderer.setScissorTest(true);
    for (const [layer, left, right] of [
      [this.#before, 0, x],
      [this.#now, x, width],
    ] as const) {
      this.#before.group.visible = layer === this.#before;
      this.#now.group.visible = layer === this.#now;
      renderer.setScissor(left, 0, right - left, height);
      if (right <= left) continue;
      renderer.render(this.#scene, this.camera.three);
      // The second half is drawn beside the first.
      renderer.autoClear = false;
    }
    renderer.autoClear = true;
    renderer.setScissorTest(false);
    this.#before.group.visible = false;
    this.#now.group.visible = true;
  }

  /** Lets an attribute use a buffer directly. */
  share<A extends BufferAttribute>(attribute: A, buffer: GPUBuffer, count: number): A {
    this.#backend.get(attribute).buffer = buffer;
    return Object.assign(attribute, { count });
  }

  get #backend(): Backend {
    return this.#renderer.backend as unknown as Backend;
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.#renderer.domElement.parentElement ?? document.body;
    const size = this.#renderer.getSize(new Vector2());
    if (width === 0 || height === 0 || (size.x === width && size.y === height)) return;
    this.#renderer.setSize(width, height, false);
    this.camera.resize();
    this.redraw();
    this.#see();
  }
}

/** The distance of a point from a line segment. */
function distanceTo([x, y]: [number, number], [ax, ay]: [number, number], [bx, by]: [number, number]): number {
  const [dx, dy] = [bx - ax, by - ay];
  const t = Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
  return Math.hypot(x - ax - t * dx, y - ay - t * dy);
}
