/** The triangles of a run on the GPU. They are copied to main memory only to be downloaded or measured. */

import { EdgeflipError } from 'edgeflip';
import source from './gpu-track.wgsl?raw';
import { SIDE_FROM, type Moment } from './change.ts';
import type { Step, Track } from './run.ts';

/** The most workgroups, of 256 threads each. They keep a GPU busy; each thread loops over further items. */
const MOST_WORKGROUPS = 4096;

type Kernel = 'record' | 'apply' | 'mark';

export class GpuTrack implements Track {
  readonly #device: GPUDevice;
  /** The session's buffer, which the flips write. */
  readonly #newest: GPUBuffer;
  readonly #length: number;
  /** The triangles of the shown iteration. */
  readonly #shown: GPUBuffer;
  readonly #count: GPUBuffer;
  readonly #changes: GPUBuffer[] = [];
  #sides: GPUBuffer | undefined;
  #isFreed = false;
  readonly #layout: GPUBindGroupLayout;
  readonly #pipelines: Record<Kernel, GPUComputePipeline>;

  private constructor(device: GPUDevice, newest: GPUBuffer, length: number) {
    this.#device = device;
    this.#newest = newest;
    this.#length = length;
    this.#shown = device.createBuffer({
      label: 'shown triangles',
      size: newest.size,
      usage: GPUBufferUsage.STORAGE | GPUBufferUsage.INDEX | GPUBufferUsage.COPY_SRC | GPUBufferUsage.COPY_DST,
    });
    this.#count = device.createBuffer({ size: 4, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST });
    const types: GPUBufferBindingType[] = ['read-only-storage', 'storage', 'storage', 'storage'];
    this.#layout = device.createBindGroupLayout({
      entries: types.map((type, binding) => ({ binding, visibility: GPUShaderStage.COMPUTE, buffer: { type } })),
    });
    const layout = device.createPipelineLayout({ bindGroupLayouts: [this.#layout] });
    const module = device.createShaderModule({ code: source });
    const pipeline = (entryPoint: Kernel) => device.createComputePipeline({ layout, compute: { module, entryPoint } });
    this.#pipelines = { record: pipeline('record'), apply: pipeline('apply'), mark: pipeline('mark') };
    const encoder = device.createCommandEncoder();
    encoder.copyBufferToBuffer(newest, 0, this.#shown, 0, newest.size);
    device.queue.submit([encoder.finish()]);
  }

  /**
   * `length` is the number of indices; a buffer of a small mesh is larger.
   *
   * @throws {@link EdgeflipError} `backend-limit` if memory runs out.
   */
  static create(device: GPUDevice, newest: GPUBuffer, length: number): Promise<GpuTrack> {
    return withMemory(device, () => new GpuTrack(device, newest, length));
  }

  async record({ iteration }: Step): Promise<void> {
    // A flip changes two of the six indices of its triangles.
    const size = 16 * iteration.flips;
    const changes = await withMemory(this.#device, () =>
      this.#device.createBuffer({
        label: `changes of iteration ${iteration.index}`,
        size,
        usage: GPUBufferUsage.STORAGE,
      }),
    );
    if (this.#isFreed) return changes.destroy();
    this.#changes.push(changes);
    this.#device.queue.writeBuffer(this.#count, 0, new Uint32Array(1));
    this.#run('record', changes, this.#shown, this.#newest.size / 4);
  }

  apply(index: number): void {
    const changes = this.#changes[index]!;
    this.#run('apply', changes, this.#shown, changes.size / 8);
  }

  drawn(isNewest: boolean): GPUBuffer {
    return isNewest ? this.#newest : this.#shown;
  }

  flipping(index: number, moment: Moment): GPUBuffer {
    this.#sides ??= this.#device.createBuffer({
      label: 'sides that flip',
      size: (4 * this.#length) / 3,
      usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST,
    });
    const encoder = this.#device.createCommandEncoder();
    encoder.clearBuffer(this.#sides);
    this.#device.queue.submit([encoder.finish()]);
    this.#device.queue.writeBuffer(this.#count, 0, new Uint32Array([SIDE_FROM[moment]]));
    const changes = this.#changes[index]!;
    this.#run('mark', changes, this.#sides, changes.size / 8);
    return this.#sides;
  }

  async triangles(): Promise<Uint32Array> {
    const { size } = this.#shown;
    const copy = this.#device.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    try {
      const encoder = this.#device.createCommandEncoder();
      encoder.copyBufferToBuffer(this.#shown, 0, copy, 0, size);
      this.#device.queue.submit([encoder.finish()]);
      await copy.mapAsync(GPUMapMode.READ);
      return new Uint32Array(copy.getMappedRange().slice(0, 4 * this.#length));
    } finally {
      copy.destroy();
    }
  }

  free(): void {
    this.#isFreed = true;
    for (const buffer of [this.#shown, this.#count, this.#sides, ...this.#changes]) buffer?.destroy();
  }

  /** Runs a kernel, which writes to `written`. */
  #run(kernel: Kernel, changes: GPUBuffer, written: GPUBuffer, items: number): void {
    const buffers = [this.#newest, written, changes, this.#count];
    const bindings = this.#device.createBindGroup({
      layout: this.#layout,
      entries: buffers.map((buffer, binding) => ({ binding, resource: { buffer } })),
    });
    const encoder = this.#device.createCommandEncoder();
    const pass = encoder.beginComputePass();
    pass.setPipeline(this.#pipelines[kernel]);
    pass.setBindGroup(0, bindings);
    pass.dispatchWorkgroups(Math.min(Math.ceil(items / 256), MOST_WORKGROUPS));
    pass.end();
    this.#device.queue.submit([encoder.finish()]);
  }
}

/** Calls `make`, which allocates GPU memory, and waits until the device confirms that there was enough. */
async function withMemory<T>(device: GPUDevice, make: () => T): Promise<T> {
  device.pushErrorScope('out-of-memory');
  const made = make();
  const error = await device.popErrorScope();
  if (error) throw new EdgeflipError('backend-limit', 'the GPU has no memory left to keep every iteration');
  return made;
}
