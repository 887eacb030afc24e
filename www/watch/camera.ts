/** The camera: it orbits a surface, and pans over the plane. The mesh fits into the part of the picture that is free. */

import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import {
  MOUSE,
  OrthographicCamera,
  PerspectiveCamera,
  Raycaster,
  TOUCH,
  Vector2,
  Vector3,
  type Ray,
} from 'three/webgpu';

/** Pixels at the sides of the picture that are covered. */
export interface Insets {
  left: number;
  right: number;
  top: number;
  bottom: number;
  /** At the top, with the title. A mesh in the plane fills its corners, and would lie under it. */
  title: number;
}

/** Vertical field of view, in degrees. */
const FIELD = 35;
const TANGENT = Math.tan((FIELD * Math.PI) / 360);
/** Room around the mesh. */
const ROOM = 1.05;
const FROM = new Vector3(1.4, 0.9, 3.1).normalize();

export class Camera {
  readonly #canvas: HTMLCanvasElement;
  readonly #insets: () => Insets;
  readonly #changed: () => void;
  #controls: OrbitControls | undefined;
  #positions = new Float32Array();
  #isFlat = false;
  /** Whether the camera is where `fit` has put it. */
  #isFitted = false;
  three: PerspectiveCamera | OrthographicCamera = new PerspectiveCamera();

  /** `changed` is called when the camera has moved. */
  constructor(canvas: HTMLCanvasElement, insets: () => Insets, changed: () => void) {
    this.#canvas = canvas;
    this.#insets = insets;
    this.#changed = changed;
  }

  /** The middle of the part of the picture that is free, in pixels. */
  get middle(): [x: number, y: number] {
    const { free } = this.#frame();
    return [free.x, free.y];
  }

  /** The part of the picture that is free, in pixels: its middle and its size. */
  get free(): { x: number; y: number; width: number; height: number } {
    return this.#frame().free;
  }

  /** Whether the camera has been set. */
  get isLooking(): boolean {
    return this.#controls !== undefined;
  }

  /** Sets a new camera that shows all these positions. */
  lookAt(positions: Float32Array, dimension: 2 | 3): void {
    this.#positions = positions as Float32Array<ArrayBuffer>;
    this.#isFlat = dimension === 2;
    this.#controls?.dispose();
    this.three = this.#isFlat
      ? new OrthographicCamera(-1, 1, 1, -1, 0.1, 10)
      : new PerspectiveCamera(FIELD, 1, 0.01, 20);
    this.three.position.copy(this.#isFlat ? new Vector3(0, 0, 3) : FROM);
    const controls = new OrbitControls(this.three, this.#canvas);
    controls.enableRotate = !this.#isFlat;
    controls.zoomToCursor = true;
    if (this.#isFlat) {
      controls.mouseButtons = { LEFT: MOUSE.PAN, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
      controls.touches = { ONE: TOUCH.PAN, TWO: TOUCH.DOLLY_PAN };
    }
    controls.addEventListener('start', () => (this.#isFitted = false));
    controls.addEventListener('change', this.#changed);
    this.#controls = controls;
    this.fit();
  }

  /** Whether the pointer turns or moves the camera. */
  set isFree(isFree: boolean) {
    if (this.#controls) this.#controls.enabled = isFree;
  }

  /** Looks at the whole mesh, in the present direction. */
  fit(): void {
    const { width, height, free } = this.#frame();
    if (!this.#controls || width === 0 || height === 0) return;
    const back = this.three.position.clone().sub(this.#controls.target).normalize();
    const right = new Vector3(0, 1, 0).cross(back).normalize();
    const up = back.clone().cross(right);
    const low = new Vector3(Infinity, Infinity, Infinity);
    const high = low.clone().negate();
    const seen = (visit: (x: number, y: number, z: number) => void) => {
      const point = new Vector3();
      for (let i = 0; i < this.#positions.length; i += 3) {
        point.fromArray(this.#positions, i);
        if (Number.isFinite(point.x + point.y + point.z)) visit(point.dot(right), point.dot(up), point.dot(back));
      }
    };
    seen((x, y, z) => {
      low.set(Math.min(low.x, x), Math.min(low.y, y), Math.min(low.z, z));
      high.set(Math.max(high.x, x), Math.max(high.y, y), Math.max(high.z, z));
    });
    const [mx, my] = [(low.x + high.x) / 2, (low.y + high.y) / 2];
    const target = right.clone().multiplyScalar(mx).addScaledVector(up, my);
    if (this.three instanceof OrthographicCamera) {
      const unit = ROOM * Math.max((high.x - low.x) / free.width, (high.y - low.y) / free.height, 1e-6);
      const [x, y] = [(unit * width) / 2, (unit * height) / 2];
      Object.assign(this.three, { left: -x, right: x, top: y, bottom: -y, zoom: 1 });
      this.three.position.copy(target).setZ(3);
    } else {
      const [tx, ty] = [(TANGENT * free.width) / height, (TANGENT * free.height) / height];
      let far = 0.1;
      seen((x, y, z) => (far = Math.max(far, z + (ROOM * Math.abs(x - mx)) / tx, z + (ROOM * Math.abs(y - my)) / ty)));
      this.three.position.copy(target).addScaledVector(back, far);
    }
    this.#controls.target.copy(target);
    this.resize(false);
    this.#controls.update();
    this.#isFitted = true;
    this.#changed();
  }

  /** Takes the present size of the picture. A camera that nobody has moved fits the mesh again. */
  resize(mayFit = true): void {
    const { width, height, free } = this.#frame();
    if (width === 0 || height === 0) return;
    if (mayFit && this.#isFitted) return this.fit();
    if (this.three instanceof PerspectiveCamera) this.three.aspect = width / height;
    else {
      const half = (this.three.top * width) / height;
      Object.assign(this.three, { left: -half, right: half });
    }
    this.three.setViewOffset(width, height, width / 2 - free.x, height / 2 - free.y, width, height);
    this.three.updateProjectionMatrix();
    this.#changed();
  }

  /** Where the camera is and what it looks at, for a link. */
  get pose(): number[] | undefined {
    if (!this.#controls || this.#isFitted) return undefined;
    return [...this.three.position.toArray(), ...this.#controls.target.toArray(), this.three.zoom];
  }

  set pose(numbers: readonly number[]) {
    if (!this.#controls || numbers.length !== 7 || !numbers.every(Number.isFinite)) return;
    this.three.position.fromArray(numbers, 0);
    this.#controls.target.fromArray(numbers, 3);
    this.three.zoom = numbers[6]!;
    this.three.updateProjectionMatrix();
    this.#controls.update();
    this.#isFitted = false;
  }

  /** The ray through a point of the picture, in pixels. */
  rayAt(x: number, y: number): Ray {
    const { width, height } = this.#frame();
    const caster = new Raycaster();
    this.three.updateMatrixWorld();
    caster.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.three);
    return caster.ray;
  }

  /** The size of a pixel in the scene, at the distance that the camera looks at. */
  get pixel(): number {
    const { height } = this.#frame();
    const { three: camera } = this;
    if (camera instanceof OrthographicCamera) return (camera.top - camera.bottom) / camera.zoom / height;
    const distance = camera.position.distanceTo(this.#controls?.target ?? new Vector3());
    return (2 * TANGENT * distance) / height;
  }

  /** Returns a function that says where a point of the scene is in the picture, in pixels. It changes the point. */
  projector(): (point: Vector3) => [x: number, y: number] {
    const { width, height } = this.#frame();
    this.three.updateMatrixWorld();
    return (point) => {
      const { x, y } = point.project(this.three);
      return [((x + 1) / 2) * width, ((1 - y) / 2) * height];
    };
  }

  dispose(): void {
    this.#controls?.dispose();
  }

  #frame() {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    const { left, right, bottom, ...insets } = this.#insets();
    const top = this.#isFlat ? insets.title : insets.top;
    const free = {
      width: Math.max(40, width - left - right),
      height: Math.max(40, height - top - bottom),
      x: (left + width - right) / 2,
      y: (top + height - bottom) / 2,
    };
    return { width, height, free };
  }
}
