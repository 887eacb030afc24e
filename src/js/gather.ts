/** Copies positions from a buffer of the page to that of a session, on their device. */

import { sizeOf } from './device-mesh.js';
import { EdgeflipError } from './error.js';
import { isWhole, shown } from './given.js';
import { type AllPlaces, widthOf } from './mesh.js';
import type { GpuBuffer, GpuDevice, UpdateOptions } from './types.js';

/** Where the positions of all vertices are. */
export interface Source {
  buffer: GpuBuffer;
  /** The count of numbers before the first vertex. */
  offset: number;
  /** The count of numbers from a vertex to the next. */
  stride: number;
}

/** Copies number by number, for positions with gaps. `axes` has two bits for each number of a vertex. */
const SHADER = `
  struct Places { offset: u32, stride: u32, width: u32, numbers: u32, axes: u32 }
  @group(0) @binding(0) var<uniform> places: Places;
  @group(0) @binding(1) var<storage, read> source: array<u32>;
  @group(0) @binding(2) var<storage, read_write> positions: array<u32>;
  @compute @workgroup_size(256)
  fn gather(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < places.numbers; i += groups.x * 256u) {
      let axis = (places.axes >> (2u * (i % places.width))) & 3u;
      positions[i] = source[places.offset + i / places.width * places.stride + axis];
    }
  }`;

const MOST_WORKGROUPS = 65_535;

/** At a multiple of this count of numbers, a binding may begin on every device. */
const ALIGNMENT = 64;

/** The pipeline of each device. */
const pipelines = new WeakMap<object, GPUComputePipeline>();

/**
 * Reads where the positions are.
 *
 * @throws {@link EdgeflipError} `invalid-option`, `position-count`.
 */
export function sourceOf(options: UpdateOptions, places: AllPlaces): Source {
  const { vertices } = places;
  const width = widthOf(places);
  const { buffer, offset = 0, stride = width } = options;
  const wrong = (name: string, value: unknown, what: string) =>
    new EdgeflipError('invalid-option', `option ${name}: ${shown(value)} is not ${what}`);
  if (!isWhole(offset)) throw wrong('offset', offset, 'a whole number of 32 bits');
  if (!isWhole(stride) || stride < width) throw wrong('stride', stride, `a whole number of at least ${width}`);
  const size = sizeOf(buffer);
  if (size === undefined) throw wrong('buffer', buffer, 'a GPUBuffer of this page');
  const needed = vertices === 0 ? 0 : 4 * (offset + (vertices - 1) * stride + width);
  if (size < needed) {
    const message = `option buffer: it has ${size} bytes; ${vertices} vertices end at byte ${needed}`;
    throw new EdgeflipError('position-count', message);
  }
  return { buffer: buffer!, offset, stride };
}

/**
 * Submits the copy of these numbers of each vertex. Errors are those of the device: a buffer of another device, or
 * without the usage.
 */
export function copyTo(
  device: GpuDevice,
  { buffer, offset, stride }: Source,
  positions: GpuBuffer,
  axes: readonly number[],
  vertices: number,
): void {
  const width = axes.length;
  const numbers = vertices * width;
  if (numbers === 0) return;
  const { queue } = device;
  const encoder = device.createCommandEncoder();
  // A plane leaves a number out of three, so its stride is larger.
  if (stride === width) {
    encoder.copyBufferToBuffer(buffer, 4 * offset, positions, 0, 4 * numbers);
    queue.submit([encoder.finish()]);
    return;
  }
  let pipeline = pipelines.get(device);
  if (!pipeline) {
    const module = device.createShaderModule({ label: 'edgeflip gather', code: SHADER });
    pipeline = device.createComputePipeline({ layout: 'auto', compute: { module } });
    pipelines.set(device, pipeline);
  }
  const usage = GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST;
  const places = device.createBuffer({ label: 'edgeflip gather', size: 32, usage });
  // Binds only what the positions span: a binding has a limit, and a buffer may be larger.
  const first = offset - (offset % ALIGNMENT);
  const size = 4 * (offset - first + (vertices - 1) * stride + Math.max(...axes) + 1);
  const packed = axes.reduce((all, axis, i) => all | (axis << (2 * i)), 0);
  queue.writeBuffer(places, 0, new Uint32Array([offset - first, stride, width, numbers, packed]));
  const resources = [{ buffer: places }, { buffer, offset: 4 * first, size }, { buffer: positions }];
  const entries = resources.map((resource, binding) => ({ binding, resource }));
  const layout = pipeline.getBindGroupLayout(0);
  const pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, device.createBindGroup({ layout, entries }));
  pass.dispatchWorkgroups(Math.min(Math.ceil(numbers / 256), MOST_WORKGROUPS));
  pass.end();
  queue.submit([encoder.finish()]);
  places.destroy();
}
