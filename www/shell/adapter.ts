/** What kind of GPU the browser offers. */

/**
 * Whether the browser emulates it in software. Older browsers have `isFallbackAdapter` on the adapter, newer ones on its
 * `info`.
 */
export function isSoftware(adapter: GPUAdapter & { isFallbackAdapter?: boolean }): boolean {
  const { isFallbackAdapter }: { isFallbackAdapter?: boolean } = adapter.info;
  return isFallbackAdapter ?? adapter.isFallbackAdapter ?? false;
}
