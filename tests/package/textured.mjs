// Textured geometries from the installed packages: a model of @pmndrs/assets with its own texture coordinates, two with
// projected ones, and geometries of three.js. Some are mirrored, cut into an atlas, or tiled.

import { NodeIO } from '@gltf-transform/core';
import { KHRDracoMeshCompression } from '@gltf-transform/extensions';
import draco from 'draco3dgltf';
import * as THREE from 'three';
import { FontLoader } from 'three/examples/jsm/loaders/FontLoader.js';
import { RoundedBoxGeometry } from 'three/examples/jsm/geometries/RoundedBoxGeometry.js';
import { TeapotGeometry } from 'three/examples/jsm/geometries/TeapotGeometry.js';
import { TextGeometry } from 'three/examples/jsm/geometries/TextGeometry.js';

const io = new NodeIO()
  .registerExtensions([KHRDracoMeshCompression])
  .registerDependencies({ 'draco3d.decoder': await draco.createDecoderModule() });

/** A model of @pmndrs/assets: its first primitive. */
async function model(name) {
  const { default: uri } = await import(`@pmndrs/assets/models/${name}.glb.js`);
  const document = await io.readBinary(new Uint8Array(Buffer.from(uri.split(',')[1], 'base64')));
  const primitive = document.getRoot().listMeshes()[0].listPrimitives()[0];
  const geometry = new THREE.BufferGeometry();
  for (const [semantic, attribute] of [
    ['POSITION', 'position'],
    ['TEXCOORD_0', 'uv'],
  ]) {
    const accessor = primitive.getAttribute(semantic);
    if (!accessor) continue;
    const numbers = Array.from({ length: accessor.getCount() }, (_, i) => accessor.getElement(i, [])).flat();
    geometry.setAttribute(attribute, new THREE.Float32BufferAttribute(numbers, accessor.getElementSize()));
  }
  return geometry.setIndex([...primitive.getIndices().getArray()]);
}

/** Gives a geometry texture coordinates. `map` gets the position, from 0 to 1 on each axis of the bounding box. */
function mapped(geometry, map) {
  geometry.computeBoundingBox();
  const { min, max } = geometry.boundingBox;
  const { position } = geometry.attributes;
  const size = max.clone().sub(min);
  const uvs = Array.from({ length: position.count }, (_, i) => {
    const p = new THREE.Vector3().fromBufferAttribute(position, i).sub(min).divide(size);
    return map(p);
  });
  return geometry.setAttribute('uv', new THREE.Float32BufferAttribute(uvs.flat(), 2));
}

/** Changes the texture coordinates of a geometry. */
function remapped(geometry, map) {
  const { uv } = geometry.attributes;
  for (let i = 0; i < uv.count; i++) uv.setXY(i, ...map(uv.getX(i), uv.getY(i)));
  return geometry;
}

const mirrored = (u, v) => [Math.abs(2 * u - 1), v];
const tiled = (u, v) => [6 * u, 6 * v];
const shear = new THREE.Matrix4().makeShear(0.9, 0.3, 0, 0.8, 0.2, 0.7);
const sheared = (geometry) => geometry.applyMatrix4(shear);

/** Cuts a geometry into patches, each with its own part of the texture. */
function atlas(geometry, parts) {
  const soup = geometry.toNonIndexed();
  soup.deleteAttribute('normal');
  const { uv } = soup.attributes;
  for (let i = 0; i < uv.count; i += 3) {
    const [u, v] = [0, 1].map((k) => ([0, 1, 2].reduce((sum, j) => sum + uv.getComponent(i + j, k), 0) / 3) * parts);
    const [column, row] = [u, v].map((x) => Math.min(parts - 1, Math.floor(x)));
    // Each part is drawn from another place of the texture.
    const shift = [(column * 5 + row * 3) % parts, (column * 2 + row * 7) % parts].map((x) => x / parts);
    for (let j = i; j < i + 3; j++) uv.setXY(j, uv.getX(j) / 2 + shift[0], uv.getY(j) / 2 + shift[1]);
  }
  return soup;
}

const font = async () => {
  const { default: uri } = await import('@pmndrs/assets/fonts/inter_bold.json.js');
  return new FontLoader().parse(JSON.parse(Buffer.from(uri.split(',')[1], 'base64')));
};
const profile = Array.from({ length: 80 }, (_, i) => new THREE.Vector2(1 + 0.5 * Math.sin(i / 12), i / 16));
const path = new THREE.CatmullRomCurve3(
  [
    [0, 0, 0],
    [2, 1, 0],
    [3, -1, 1],
    [4, 0, -1],
  ].map((p) => new THREE.Vector3(...p)),
);

/** A landscape: its texture is seen from above. */
const terrain = () => {
  const geometry = new THREE.PlaneGeometry(4, 4, 160, 160).applyMatrix4(
    new THREE.Matrix4().makeShear(0, 0, 0.9, 0, 0, 0),
  );
  const { position } = geometry.attributes;
  for (let i = 0; i < position.count; i++) {
    const [x, y] = [position.getX(i), position.getY(i)];
    position.setZ(i, 0.1 * Math.sin(2 * x) * Math.cos(3 * y - x));
  }
  return geometry.rotateX(-0.6);
};

/** Each geometry, and whether its mapping is smooth: it bends by less than the tolerance at almost every edge. */
export const TEXTURED = {
  'pmndrs with its own mapping': [() => model('pmndrs'), true],
  'bunny, projected': [async () => mapped(await model('bunny'), ({ x, y, z }) => [x + 0.3 * z, y - 0.2 * z]), false],
  'bunny, projected and mirrored': [async () => mapped(await model('bunny'), ({ x, y }) => mirrored(x, y)), false],
  'suzi, bent': [
    async () =>
      mapped(await model('suzi'), ({ x, y, z }) => [x + 0.2 * Math.sin(3 * z), y + 0.1 * Math.cos(2 * x + z)]),
    false,
  ],
  teapot: [() => new TeapotGeometry(1, 16), false],
  'tiled torus knot': [() => remapped(sheared(new THREE.TorusKnotGeometry(1, 0.3, 400, 48)), tiled), false],
  'sheared lathe': [() => sheared(new THREE.LatheGeometry(profile, 160)), true],
  'atlas of a lathe': [() => atlas(sheared(new THREE.LatheGeometry(profile, 96)), 4), true],
  'mirrored sphere': [() => remapped(sheared(new THREE.SphereGeometry(1, 128, 96)), mirrored), false],
  'bent tube': [() => new THREE.TubeGeometry(path, 300, 0.5, 40), true],
  terrain: [terrain, true],
  'tiled letters': [
    async () => {
      const options = { font: await font(), size: 1, depth: 0.3, bevelEnabled: true, bevelSize: 0.02 };
      return remapped(sheared(new TextGeometry('Sq8', options)), (u, v) => [u / 2, v / 2]);
    },
    true,
  ],
  'sheared rounded box': [() => sheared(new RoundedBoxGeometry(1, 2, 3, 6, 0.2)), false],
};
