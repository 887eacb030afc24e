/** What `auto` does, as src/session/cost.rs and docs/engines.md have it. */

import { made } from '../shell/elements.ts';
import { recordedCrossover } from './recorded.ts';

/** The sizes from which on a GPU that is ready saves more than 2.5 ms, by the estimates of the package. */
const RULES = [
  'Up to about 28,000 triangles in space, or 34,000 in the plane: the CPU.',
  'Larger meshes: WebGPU, as soon as the GPU is ready and has flipped a test mesh correctly.',
  'While the GPU gets ready: the CPU. Only a mesh of many million triangles waits for the GPU.',
  'Never WebGL2, and never a software GPU: the CPU is faster.',
];
const NOTE = `In the recorded run, the GPU was first in the plane from ${recordedCrossover()} triangles on; “auto” takes it from where it saves 2.5 ms. Its sizes are fixed estimates: what you measure here does not change them.`;

export function autoRules(): HTMLElement[] {
  const rules = made('ol', 'engines-rules', ...RULES.map((rule) => made('li', '', rule)));
  return [made('h3', 'engines-title', 'Which one does “auto” take?'), rules, made('p', 'engines-note', NOTE)];
}
