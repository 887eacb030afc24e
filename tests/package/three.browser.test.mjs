// `edgeflip/three` with a live WebGPURenderer in Chromium: a model becomes Delaunay on the renderer's device, the
// renderer draws the buffer that the flips wrote, and no triangle travels to the CPU. Uses the existing dist/.

import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { NodeIO } from '@gltf-transform/core';
import { KHRDracoMeshCompression } from '@gltf-transform/extensions';
import draco from 'draco3dgltf';
import { closeAll, openPage, serve, startChromium } from '../browsers.mjs';

const repository = fileURLToPath(new URL('../..', import.meta.url));
mkdirSync(join(repository, 'target'), { recursive: true });
const folder = mkdtempSync(join(repository, 'target/three-'));
after(async () => {
  await closeAll();
  rmSync(folder, { recursive: true, force: true });
});

/** The bunny of @pmndrs/assets, unpacked. */
async function bunny() {
  const { default: uri } = await import('@pmndrs/assets/models/bunny.glb.js');
  const io = new NodeIO()
    .registerExtensions([KHRDracoMeshCompression])
    .registerDependencies({ 'draco3d.decoder': await draco.createDecoderModule() });
  const document = await io.readBinary(new Uint8Array(Buffer.from(uri.split(',')[1], 'base64')));
  document.disposeExtension('KHR_draco_mesh_compression');
  return io.writeBinary(document);
}

const html = `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>edgeflip</title>
<link rel="icon" href="data:,">
<script type="importmap">
{ "imports": {
  "three": "/node_modules/three/build/three.webgpu.js",
  "three/webgpu": "/node_modules/three/build/three.webgpu.js",
  "three/tsl": "/node_modules/three/build/three.tsl.js",
  "three/addons/": "/node_modules/three/examples/jsm/",
  "edgeflip": "/dist/index.js",
  "edgeflip/three": "/dist/three.js"
} }
</script>
<script type="module">
  import * as THREE from 'three/webgpu';
  import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
  import { FlipSession, makeDelaunay } from 'edgeflip';
  import { delaunayGeometry } from 'edgeflip/three';

  /** The bytes that were read from the GPU. */
  let read = 0;
  const readable = new WeakSet();
  const { mapAsync, getMappedRange } = GPUBuffer.prototype;
  GPUBuffer.prototype.mapAsync = function (mode, ...range) {
    if (mode === GPUMapMode.READ) readable.add(this);
    return mapAsync.call(this, mode, ...range);
  };
  GPUBuffer.prototype.getMappedRange = function (...range) {
    const bytes = getMappedRange.apply(this, range);
    if (readable.has(this)) read += bytes.byteLength;
    return bytes;
  };

  const renderer = new THREE.WebGPURenderer();
  renderer.setSize(300, 300);
  document.body.append(renderer.domElement);
  const { scene: model } = await new GLTFLoader().loadAsync('./bunny.glb');
  let mesh;
  model.traverse((object) => (mesh ??= object.isMesh ? object : undefined));
  const { geometry } = mesh;
  mesh.material = new THREE.MeshNormalMaterial({ flatShading: true });
  geometry.computeBoundingSphere();
  const { center, radius } = geometry.boundingSphere;
  const scene = new THREE.Scene();
  scene.add(new THREE.Mesh(geometry, mesh.material));
  const camera = new THREE.PerspectiveCamera(30, 1, radius / 100, radius * 10);
  camera.position.copy(center).add(new THREE.Vector3(radius, radius, 4 * radius));
  camera.lookAt(center);
  const draw = () => {
    renderer.render(scene, camera);
    return renderer.domElement.toDataURL();
  };
  await renderer.init();

  window.run = async (options) => {
    const before = draw();
    const { index } = geometry;
    const triangles = Array.from(index.array);
    const { position } = geometry.attributes;
    const positions = Float32Array.from({ length: 3 * position.count }, (_, i) =>
      position.getComponent(Math.floor(i / 3), i % 3),
    );
    const wanted = await makeDelaunay({ positions, indices: index.array, dimension: 3 }, { ...options, backend: 'cpu' });
    read = 0;
    const { session, flips, backend } = await delaunayGeometry(geometry, { renderer, ...options });
    const after = draw();
    const bytes = read;
    const isSame = (indices) => indices.every((vertex, i) => vertex === wanted.indices[i]);
    const gpu = await session?.gpu();
    return {
      backend,
      flips: flips - wanted.flips,
      isChanged: before !== after,
      isDrawn: renderer.backend.get(geometry.index).buffer === gpu?.indices && renderer.backend.device === gpu?.device,
      isOld: triangles.every((vertex, i) => vertex === geometry.index.array[i]),
      isRead: bytes >= 4 * triangles.length,
      isSame: isSame(session ? await session.triangles() : geometry.index.array),
      isClean: !session || (await session.verify()).clean,
      isMany: flips > 100,
    };
  };
  window.dispose = async () => {
    geometry.dispose();
    await new Promise((resolve) => setTimeout(resolve, 100));
  };
  window.isReady = true;
</script>
`;

test('a GLB becomes Delaunay on the device of the renderer, which draws the result', async () => {
  writeFileSync(join(folder, 'bunny.glb'), await bunny());
  writeFileSync(join(folder, 'index.html'), html);
  const chromium = await startChromium();
  const { page, problems } = await openPage(
    chromium,
    `${await serve(repository)}target/${basename(folder)}/index.html`,
  );
  await page.waitForFunction('window.isReady', undefined, { timeout: 60_000 });
  const shared = {
    backend: 'webgpu',
    flips: 0,
    isChanged: true,
    isDrawn: true,
    isOld: true,
    isRead: false,
    isSame: true,
    isClean: true,
    isMany: true,
  };
  const run = (options) => page.evaluate((options) => window.run(options), options);
  assert.deepEqual(await run({ backend: 'webgpu', maxNormalAngle: 30 }), shared);
  // Again, from the old triangles, which the index on the CPU still has.
  assert.deepEqual(await run({ backend: 'webgpu', maxNormalAngle: 30 }), { ...shared, isChanged: false });
  // The index on the CPU has the old triangles, so the CPU engine writes the result into it.
  const written = { ...shared, backend: 'cpu', isDrawn: false, isOld: false, isChanged: false };
  assert.deepEqual(await run({ backend: 'cpu', maxNormalAngle: 30 }), written);
  await page.evaluate(() => window.dispose());
  assert.deepEqual(problems, []);
});
