/** Charts that do not wait for the GPU. */

/**
 * Calls `make`; the 2D canvases that it asks for are in main memory. Else the page would stand still after it has drawn
 * a chart until a GPU that is busy with a large mesh has taken it.
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
