/** The light on surfaces. */

import { Vector3 } from 'three/webgpu';
import { normalFlat, vec3 } from 'three/tsl';

/** Towards the light, as seen from the camera. */
const LIGHT = new Vector3(-0.35, 0.62, 0.7).normalize();

/** How much light falls on a triangle, whichever way it faces: from 0 to 1. */
export function light() {
  // Towards the camera.
  const normal = normalFlat.mul(normalFlat.z.sign());
  return normal
    .dot(vec3(LIGHT.x, LIGHT.y, LIGHT.z))
    .mul(0.9)
    .add(0.08)
    .clamp(0, 1);
}
