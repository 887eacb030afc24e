/** Reads a mesh from buffers of a device. */

import { EdgeflipError } from './error.js';
import { isWhole, objectOf, read, shown } from './given.js';
import { checkDimension, MESH, widthOf } from './mesh.js';
import { checkSpelling, namesOf } from './names.js';
import type { DeviceMesh, GpuBuffer, GpuDevice, Mesh } from './types.js';

const DEVICE_MESH = [...MESH, ...namesOf<Omit<DeviceMesh, keyof Mesh>>({ vertices: true, triangles: true })];

/** A part of a buffer, in bytes. */
interface Part {
  buffer: GpuBuffer;
  size: number;
}

/**
 * Reads both buffers once. Submits the copies before it returns its promise.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `device-failed`.
 */
export async function readDeviceMesh(given: DeviceMesh, device: GpuDevice): Promise<Mesh<Uint32Array>> {
  const { parts, rest } = partsOf(given);
  device.pushErrorScope('validation');
  const usage = GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST;
  const stagings = parts.map(({ size }) => device.createBuffer({ label: 'edgeflip mesh', size, usage }));
  const encoder = device.createCommandEncoder();
  parts.forEach(({ buffer, size }, i) => encoder.copyBufferToBuffer(buffer, 0, stagings[i]!, 0, size));
  device.queue.submit([encoder.finish()]);
  const fault = device.popErrorScope();
  try {
    const error = await fault;
    if (error) throw new EdgeflipError('invalid-input', `the buffers of the mesh cannot be read: ${error.message}`);
    await Promise.all(stagings.map((staging) => staging.mapAsync(GPUMapMode.READ)));
    const [positions, indices] = stagings.map((staging) => staging.getMappedRange().slice(0));
    return { ...rest, positions: new Float32Array(positions!), indices: new Uint32Array(indices!) };
  } catch (cause) {
    if (cause instanceof EdgeflipError) throw cause;
    throw new EdgeflipError('device-failed', `the buffers of the mesh cannot be read: ${String(cause)}`, { cause });
  } finally {
    for (const staging of stagings) staging.destroy();
  }
}

/** @throws {@link EdgeflipError} `invalid-input`. */
function partsOf(given: DeviceMesh): {
  parts: [Part, Part];
  rest: Pick<Mesh, 'dimension' | 'plane' | 'stride' | 'offset'>;
} {
  return read('the mesh', () => {
    const { positions, indices, dimension, plane, stride, offset, vertices, triangles } = objectOf(
      given,
      'mesh',
    ) as unknown as DeviceMesh;
    checkSpelling(given, DEVICE_MESH, 'mesh');
    checkDimension(dimension, plane);
    const width = widthOf({ dimension, plane });
    const step = stride ?? width;
    const numbers = vertices === undefined || vertices === 0 ? vertices : (offset ?? 0) + (vertices - 1) * step + width;
    return {
      parts: [
        partOf(positions, 'positions', vertices, numbers),
        partOf(indices, 'indices', triangles, triangles === undefined ? undefined : 3 * triangles),
      ],
      rest: { dimension, plane, stride, offset },
    };
  });
}

/** The first `words` words of a buffer, or all of it. */
function partOf(buffer: GpuBuffer, what: string, count: unknown, words: number | undefined): Part {
  if (count !== undefined && !isWhole(count)) {
    throw new EdgeflipError('invalid-input', `${what}: ${shown(count)} is not a number of them`);
  }
  const whole = sizeOf(buffer);
  if (whole === undefined) {
    throw new EdgeflipError('invalid-input', `${what}: ${shown(buffer)} is not a GPUBuffer of this page`);
  }
  const size = words === undefined ? whole - (whole % 4) : 4 * words;
  if (size <= whole) return { buffer, size };
  throw new EdgeflipError('invalid-input', `${what}: the buffer has ${whole} bytes, and the mesh needs ${size}`);
}

/** The size of a buffer of this window or worker: the getter of its `GPUBuffer` throws for other objects. */
export function sizeOf(buffer: unknown): number | undefined {
  try {
    return Object.getOwnPropertyDescriptor(GPUBuffer.prototype, 'size')!.get!.call(buffer) as number;
  } catch {
    return undefined;
  }
}
