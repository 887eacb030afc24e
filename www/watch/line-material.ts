/** The material of lines. */

import {
  CustomBlending,
  Line2NodeMaterial,
  NotEqualStencilFunc,
  OneFactor,
  OneMinusSrcAlphaFactor,
  ReplaceStencilOp,
  type Line2NodeMaterialParameters,
} from 'three/webgpu';

/** Marks of lines that may be faint. */
export const MARKS = { plain: 1, hot: 2 };

/**
 * A material for lines. If they may be faint, they have a `mark` in the stencil buffer: where lines of one mark meet or
 * cross, only the first is drawn, and so their ends are not darker.
 *
 * The GPU blends the lines. With `transparent`, three would blend them itself, with a copy of the picture: it would copy
 * each picture, and could lose the one after the canvas was resized, see
 * https://github.com/mrdoob/three.js/issues/34600.
 */
export function lineMaterial(parameters: Line2NodeMaterialParameters, mark = 0): Line2NodeMaterial {
  return new Line2NodeMaterial({
    ...parameters,
    blending: CustomBlending,
    blendSrcAlpha: OneFactor,
    blendDstAlpha: OneMinusSrcAlphaFactor,
    stencilWrite: mark > 0,
    stencilRef: mark,
    stencilFunc: NotEqualStencilFunc,
    stencilZPass: ReplaceStencilOp,
  });
}
