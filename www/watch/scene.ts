/** Draws the mesh with three.js. With WebGPU, it draws from the buffer that the flips write. */

import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  HemisphereLight,
  LineBasicNodeMaterial,
  LineSegments,
  Mesh,
  MeshBasicNodeMaterial,
  MeshStandardNodeMaterial,
  MOUSE,
  OrthographicCamera,
  PerspectiveCamera,
  Scene as ThreeScene,
  Sphere,
  TOUCH,
  Vector3,
  WebGPURenderer,
} from 'three/webgpu';
import type { Drawn } from './run.ts';
import { EdgeLines } from './edge-lines.ts';
import type { Palette } from './palette.ts';

/** The part of three's backend that holds the GPU buffers of attributes. */
interface Backend {
  readonly isWebGPUBackend?: boolean;
  get(attribute: BufferAttribute): { buffer?: GPUBuffer };
}

export class Scene {
  readonly #renderer: WebGPURenderer;
  readonly #scene = new ThreeScene();
  readonly #surface = new Mesh<BufferGeometry, MeshBasicNodeMaterial | MeshStandardNodeMaterial>();
  readonly #wire = new LineSegments(
    new BufferGeometry(),
    new LineBasicNodeMaterial({ transparent: true, opacity: 0.55 }),
  );
  readonly #edges: EdgeLines;
  readonly #light = new DirectionalLight(0xffffff, 2.2);
  readonly #attributes = new WeakMap<Drawn, BufferAttribute>();
  /** Attributes whose buffers three must not destroy. */
  readonly #shared = new WeakSet<BufferAttribute>();
  readonly #observer: ResizeObserver;
  #camera: PerspectiveCamera | OrthographicCamera = new PerspectiveCamera();
  #controls: OrbitControls | undefined;
  #palette: Palette;
  #positions = new BufferAttribute(new Float32Array(), 3);
  #dimension: 2 | 3 = 3;
  /** Half of each side of the box around the mesh. */
  readonly #extent = new Vector3(1, 1, 1);
  #frame = 0;

  private constructor(renderer: WebGPURenderer, palette: Palette) {
    this.#renderer = renderer;
    this.#palette = palette;
    this.#edges = new EdgeLines();
    this.#scene.add(new HemisphereLight(0xffffff, 0x8090a0, 1.6), this.#surface, this.#wire, this.#edges.group);
    for (const object of [this.#surface, this.#wire]) Object.assign(object, { frustumCulled: false, visible: false });
    this.#observer = new ResizeObserver(() => this.#resize());
  }

  /** Draws into `view`: with WebGPU if `device` is given, else with WebGL2. */
  static async create(view: HTMLElement, device: GPUDevice | undefined, palette: Palette): Promise<Scene> {
    const renderer = new WebGPURenderer({ antialias: true, ...(device ? { device } : { forceWebGL: true }) });
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    await renderer.init();
    const scene = new Scene(renderer, palette);
    view.append(renderer.domElement);
    renderer.domElement.role = 'img';
    renderer.domElement.setAttribute('aria-label', 'The mesh; drag to turn or move it, scroll to zoom');
    scene.setPalette(palette);
    scene.#observer.observe(view);
    return scene;
  }

  /** Whether it draws with WebGPU, on the given device. */
  get isOnWebGpu(): boolean {
    return this.#backend.isWebGPUBackend === true;
  }

  /** Whether the camera has been set. */
  get isLooking(): boolean {
    return this.#controls !== undefined;
  }

  /** Sets the positions of a mesh: 3 numbers per vertex, inside the unit ball. */
  setMesh(positions: Float32Array, dimension: 2 | 3): void {
    this.clear();
    this.#positions = new BufferAttribute(positions, 3);
    new Box3().setFromBufferAttribute(this.#positions).getSize(this.#extent).divideScalar(2);
    this.#dimension = dimension;
    this.#surface.geometry = this.#geometry();
    this.#wire.geometry = this.#geometry();
    this.setPalette(this.#palette);
  }

  /** Draws these triangles, and the lines if there are any. */
  show(triangles: Drawn, count: number, lines: Drawn | undefined): void {
    this.#surface.geometry.setIndex(this.#index(triangles, count));
    this.#surface.visible = true;
    this.#wire.visible = lines !== undefined;
    if (lines) this.#wire.geometry.setIndex(this.#index(lines, 2 * count));
    this.redraw();
  }

  /** Draws the edges of a small mesh in colours; without arguments, none. */
  showEdges(indices: Uint32Array | undefined, states: Uint8Array | undefined): void {
    this.#edges.clear();
    if (indices && states) this.#edges.show(this.#positions.array as Float32Array, indices, states, this.#palette);
    this.redraw();
  }

  /** Releases all buffers of the run, which may then be destroyed. */
  clear(): void {
    this.#edges.clear();
    for (const object of [this.#surface, this.#wire]) {
      object.visible = false;
      const { index } = object.geometry;
      if (index && this.#shared.has(index)) object.geometry.index = null;
      object.geometry.dispose();
      object.geometry = new BufferGeometry();
    }
    this.redraw();
  }

  setPalette(palette: Palette): void {
    this.#palette = palette;
    this.#scene.background = new Color(palette.ground);
    this.#surface.material.dispose();
    const common = {
      color: palette.surface,
      side: DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    };
    this.#surface.material =
      this.#dimension === 2
        ? new MeshBasicNodeMaterial(common)
        : new MeshStandardNodeMaterial({ ...common, flatShading: true, roughness: 0.85 });
    this.#wire.material.color.set(palette.line);
    this.redraw();
  }

  /** Draws again in the next frame of the page. */
  redraw(): void {
    this.#frame ||= requestAnimationFrame(() => {
      this.#frame = 0;
      this.#light.position.copy(this.#camera.position);
      this.#renderer.render(this.#scene, this.#camera);
    });
  }

  /** Removes the canvas. The buffers of the run stay. */
  dispose(): void {
    cancelAnimationFrame(this.#frame);
    this.#frame = -1;
    this.#observer.disconnect();
    this.#controls?.dispose();
    this.#renderer.domElement.remove();
    this.#renderer.dispose();
  }

  #geometry(): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.#positions);
    geometry.boundingSphere = new Sphere(new Vector3(), 1);
    return geometry;
  }

  /** The attribute for these indices. It uses a buffer directly, and copies an array to the GPU at each call. */
  #index(drawn: Drawn, count: number): BufferAttribute {
    let attribute = this.#attributes.get(drawn);
    if (!attribute) {
      if (drawn instanceof Uint32Array) {
        attribute = new BufferAttribute(drawn, 1);
      } else {
        attribute = Object.assign(new BufferAttribute(new Uint32Array(), 1), { count });
        this.#backend.get(attribute).buffer = drawn;
        this.#shared.add(attribute);
      }
      this.#attributes.set(drawn, attribute);
    } else if (!this.#shared.has(attribute)) {
      attribute.needsUpdate = true;
    }
    return attribute;
  }

  get #backend(): Backend {
    return this.#renderer.backend as unknown as Backend;
  }

  /** Sets a new camera that shows the whole mesh: it orbits a surface, and pans over the plane. */
  lookAtAll(): void {
    const flat = this.#dimension === 2;
    this.#controls?.dispose();
    this.#scene.remove(this.#light);
    if (flat) {
      this.#camera = new OrthographicCamera(-1, 1, 1, -1, 0.1, 10);
      this.#camera.position.set(0, 0, 3);
    } else {
      this.#camera = new PerspectiveCamera(35, 1, 0.01, 20);
      this.#camera.position.set(1.4, 1.1, 3.1);
      this.#scene.add(this.#light);
    }
    const controls = new OrbitControls(this.#camera, this.#renderer.domElement);
    controls.enableRotate = !flat;
    controls.zoomToCursor = true;
    if (flat) {
      controls.mouseButtons = { LEFT: MOUSE.PAN, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
      controls.touches = { ONE: TOUCH.PAN, TWO: TOUCH.DOLLY_PAN };
    }
    controls.addEventListener('change', () => this.redraw());
    this.#controls = controls;
    this.#resize();
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.#renderer.domElement.parentElement ?? document.body;
    if (width === 0 || height === 0) return;
    this.#renderer.setSize(width, height, false);
    const aspect = width / height;
    if (this.#camera instanceof PerspectiveCamera) {
      this.#camera.aspect = aspect;
      // The mesh fits the narrower side.
      this.#camera.fov = aspect >= 1 ? 35 : (2 * Math.atan(Math.tan((35 * Math.PI) / 360) / aspect) * 180) / Math.PI;
    } else {
      // The box around the mesh fits both sides.
      const { x, y } = this.#extent;
      const half = 1.08 * Math.max(y, x / aspect);
      Object.assign(this.#camera, { left: -half * aspect, right: half * aspect, top: half, bottom: -half });
    }
    this.#camera.updateProjectionMatrix();
    this.redraw();
  }
}
