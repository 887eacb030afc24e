/** The buffers of all arrays in a value, so that a message can transfer them instead of copying. */
export function buffersOf(value: unknown): ArrayBuffer[] {
  if (ArrayBuffer.isView(value)) return value.buffer instanceof ArrayBuffer ? [value.buffer] : [];
  if (typeof value !== 'object' || value === null || value instanceof WebAssembly.Memory) return [];
  return Object.values(value).flatMap(buffersOf);
}
