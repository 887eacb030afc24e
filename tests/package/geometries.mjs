// Geometries of three.js for several tests, and the number of flips in one.

import { delaunayGeometry } from 'edgeflip/three';
import * as THREE from 'three';

const shear = new THREE.Matrix4().makeShear(0.9, 0.3, 0, 0.8, 0.2, 0.7);
export const sheared = (geometry) => geometry.applyMatrix4(shear);

/** A square in two triangles, split along the wrong diagonal 0-2. Without an index, each triangle has its vertices. */
export function square(isIndexed = true) {
  const points = [0, 0, 0, 0.9, 0.2, 0, 1, 1, 0, 0, 1, 0];
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  return isIndexed ? geometry : geometry.toNonIndexed();
}

export const flips = async (geometry, options) => (await delaunayGeometry(geometry, options)).flips;
