/** Keeps charts in main memory, so that they do not wait for the GPU. */

/**
 * Calls `make`; the 2D canvases that it creates are in main memory. With canvases on the GPU, the page would block
 * after it draws a chart while the GPU is busy with a large mesh.
 */
export function inMainMemory<T>(make: () => T): T {
  const { prototype } = HTMLCanvasElement;
  const { getContext } = prototype;
  prototype.getContext = function (this: HTMLCanvasElement, kind: string, options?: object) {
    return Reflect.apply(getContext, this, [kind, { ...options, willReadFrequently: true }]);
  } as typeof getContext;
  try {
    return make();
  } finally {
    prototype.getContext = getContext;
  }
}
