// Documents of glTF-Transform become Delaunay, and everything but the indices stays. The validator of the Khronos Group
// finds no error in the files. Also runs on the models of @pmndrs/assets (CC0), which are compressed with Draco. Uses
// the existing dist/.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Document, Logger, NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS, EXTMeshoptCompression, KHRMeshQuantization } from '@gltf-transform/extensions';
import draco3d from 'draco3dgltf';
import { EdgeflipError } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { delaunay } from 'edgeflip/gltf-transform';
import { MeshoptDecoder } from 'meshoptimizer/decoder';
import { MeshoptEncoder } from 'meshoptimizer/encoder';
import * as THREE from 'three';
import { faults, riggedGlb } from './gltf.mjs';
import { primitivesOf, surfaceOf } from './primitives.mjs';
import { badEdges, same, sameTexture } from './surfaces.mjs';

const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({
  'draco3d.decoder': await draco3d.createDecoderModule(),
  'meshopt.decoder': MeshoptDecoder,
  'meshopt.encoder': MeshoptEncoder,
});

/** Keeps the lines of a logger. */
function listen(document) {
  const lines = [];
  const keep = (level) => (line) => lines.push(`${level}: ${line}`);
  document.setLogger({ debug: () => {}, info: keep('info'), warn: keep('warn'), error: keep('error') });
  return lines;
}

/** Transforms the document and compares. Returns the line of the logger. */
async function transformed(document, options, { isFlat = false } = {}) {
  const before = primitivesOf(document).map(surfaceOf);
  const kinds = primitivesOf(document).map((primitive) => primitive.getIndices()?.getArray().constructor);
  const lines = listen(document);
  await document.transform(delaunay(options));
  for (const [i, primitive] of primitivesOf(document).entries()) {
    const after = surfaceOf(primitive);
    same(before[i], after);
    if (isFlat) sameTexture(before[i], after);
    if (kinds[i]) assert.equal(primitive.getIndices().getArray().constructor, kinds[i]);
  }
  return lines.join('\n');
}

const flipsIn = (line) => Number(/(\d+) flips/.exec(line)[1]);

/** The errors of the validator in the written document. */
async function errorsOf(document) {
  const messages = await faults(await io.writeBinary(document));
  return messages.filter(({ severity }) => severity === 0);
}

/** Adds a geometry of three.js as a mesh of one primitive on a node. */
function add(document, geometry, { Indices = Uint16Array, buffer = document.getRoot().listBuffers()[0] } = {}) {
  const accessor = (array, type, isNormalized = false) =>
    document.createAccessor('', buffer).setType(type).setArray(array).setNormalized(isNormalized);
  const { position, normal, uv } = geometry.attributes;
  const primitive = document
    .createPrimitive()
    .setAttribute('POSITION', accessor(position.array, 'VEC3', position.normalized))
    .setAttribute('TEXCOORD_0', accessor(uv.array, 'VEC2'))
    .setMaterial(document.createMaterial('grey'));
  if (!position.normalized) primitive.setAttribute('NORMAL', accessor(normal.array, 'VEC3'));
  if (geometry.index) primitive.setIndices(accessor(Indices.from(geometry.index.array), 'SCALAR'));
  const mesh = document.createMesh('thing').addPrimitive(primitive);
  const node = document.createNode().setMesh(mesh);
  document.getRoot().listScenes()[0].addChild(node);
  return { primitive, mesh, node };
}

function empty() {
  const document = new Document();
  document.createBuffer();
  document.createScene();
  return document;
}

const shear = new THREE.Matrix4().makeShear(0.9, 0.3, 0, 0.8, 0.2, 0.7);
const plane = (...size) =>
  new THREE.PlaneGeometry(...size).applyMatrix4(new THREE.Matrix4().makeShear(0, 0, 0.9, 0, 0, 0));
const box = () => {
  const geometry = new THREE.BoxGeometry(1, 2, 3, 3, 4, 5).applyMatrix4(shear);
  geometry.normalizeNormals();
  return geometry;
};

test('primitives with and without indices, and indices of each type', async () => {
  const document = empty();
  for (const Indices of [Uint8Array, Uint16Array, Uint32Array]) add(document, plane(3, 1, 9, 9), { Indices });
  add(document, box());
  const soup = box().toNonIndexed();
  const { primitive } = add(document, soup);
  const flat = add(document, new THREE.PlaneGeometry(1, 1).toNonIndexed()).primitive;
  const transform = delaunay();
  assert.equal(transform.name, 'delaunay');
  const line = await transformed(document, {}, { isFlat: true });
  assert.match(line, /^info: delaunay: \d+ flips in 5 of 6 primitives; edges that are still not Delaunay: locked \d+$/);
  assert.ok(flipsIn(line) > 300, line);
  assert.equal(primitive.getIndices().getArray().constructor, Uint16Array);
  assert.equal(primitive.getIndices().getBuffer(), document.getRoot().listBuffers()[0]);
  assert.equal(flat.getIndices(), null);
  assert.deepEqual(await errorsOf(document), []);
  assert.match(await transformed(document), /: 0 flips in 0 of 6 primitives/);
});

test('indices of other primitives stay', async () => {
  const document = empty();
  const { primitive, mesh } = add(document, plane(3, 1, 9, 9));
  // The same triangles with other positions, which are Delaunay already, and the same surface in another material.
  const other = add(document, new THREE.PlaneGeometry(3, 1, 9, 9)).primitive;
  other.getIndices().dispose();
  other.setIndices(primitive.getIndices());
  const twin = document
    .createPrimitive()
    .setIndices(primitive.getIndices())
    .setMaterial(document.createMaterial('red'));
  for (const name of primitive.listSemantics()) twin.setAttribute(name, primitive.getAttribute(name));
  mesh.addPrimitive(twin);
  const shared = primitive.getIndices();
  const old = [...shared.getArray()];
  assert.match(await transformed(document, {}, { isFlat: true }), /in 1 of 2 primitives/);
  assert.deepEqual([other.getIndices() === shared, [...shared.getArray()]], [true, old]);
  assert.equal(primitive.getIndices(), twin.getIndices());
  assert.notEqual(primitive.getIndices(), shared);
  assert.equal(document.getRoot().listAccessors().length, 8);
  assert.deepEqual(await errorsOf(document), []);
  // Now only these two have the accessor, which therefore stays.
  const ours = primitive.getIndices();
  ours.setArray(Uint16Array.from(old));
  await transformed(document);
  assert.equal(primitive.getIndices(), ours);
});

test('quantized positions', async () => {
  for (const Integers of [Int16Array, Uint16Array, Int8Array, Uint8Array]) {
    for (const isNormalized of [true, false]) {
      const document = empty();
      document.createExtension(KHRMeshQuantization).setRequired(true);
      const geometry = plane(1, 1, 7, 7);
      const { array } = geometry.attributes.position;
      const [low, high] = [-1, 1].map((sign) => sign * Math.max(...array.map(Math.abs)));
      const most = 2 ** (8 * Integers.BYTES_PER_ELEMENT - 1) - 1;
      const integers = Integers.from(array, (x) => Math.round(((x - low) / (high - low)) * most));
      geometry.setAttribute('position', new THREE.BufferAttribute(integers, 3, isNormalized));
      const { primitive } = add(document, geometry);
      // Rows of 3 integers are padded to 4 bytes by the writer.
      const isFine = Integers.BYTES_PER_ELEMENT > 1;
      // With positions of 8 bits, the texture is bent by several texels at every vertex.
      const options = isFine ? {} : { maxAttributeShift: Infinity };
      const line = await transformed(document, options, { isFlat: isFine });
      assert.ok(flipsIn(line) > 20, line);
      assert.equal(badEdges(surfaceOf(primitive)), 0);
      assert.deepEqual(await errorsOf(document), []);
    }
  }
});

test('a rigged GLB with morph targets', async () => {
  for (const isIndexed of [true, false]) {
    const document = await io.readBinary(new Uint8Array(riggedGlb({ isIndexed }).bytes));
    const line = await transformed(document);
    assert.ok(flipsIn(line) > 20, line);
    assert.deepEqual(await errorsOf(document), []);
  }
});

test('coordinates that a node scales unevenly', async () => {
  const square = () => {
    const geometry = new THREE.PlaneGeometry(1, 1);
    geometry.attributes.position.array.set([0, 0, 0, 0.9, 0.2, 0, 1, 1, 0, 0, 1, 0]);
    return geometry.setIndex([0, 1, 2, 0, 2, 3]);
  };
  const run = async (place, options) => {
    const document = empty();
    place(add(document, square()), document);
    // The texture of the square is that of another one.
    return flipsIn(await transformed(document, { maxAttributeShift: Infinity, ...options }));
  };
  assert.equal(await run(() => {}), 1);
  assert.equal(await run(({ node }) => node.setScale([3, 3, 3]).setRotation([0, 0.6, 0, 0.8])), 1);
  const squeeze = ({ node }, document) => {
    const parent = document.createNode().setRotation([0, 0, Math.SQRT1_2, Math.SQRT1_2]).setScale([3, 1, 1]);
    document
      .getRoot()
      .listScenes()[0]
      .addChild(parent.addChild(node.setRotation([0, 0, 0.38268343, 0.92387953])));
  };
  assert.equal(await run(squeeze), 0);
  assert.equal(
    await run((made, document) => {
      squeeze(made, document);
      made.node.setSkin(document.createSkin());
    }),
    1,
  );
});

const MODELS = ['bunny', 'suzi', 'pmndrs'];

for (const name of MODELS) {
  test(`the model ${name} from @pmndrs/assets`, async () => {
    const { default: uri } = await import(`@pmndrs/assets/models/${name}.glb.js`);
    const bytes = new Uint8Array(Buffer.from(uri.split(',')[1], 'base64'));
    const document = await io.readBinary(bytes);
    const materials = primitivesOf(document).map((primitive) => primitive.getMaterial());
    const line = await transformed(document, { maxNormalAngle: 30 });
    assert.ok(flipsIn(line) > 50, line);
    assert.deepEqual(
      primitivesOf(document).map((primitive) => primitive.getMaterial()),
      materials,
    );
    document.disposeExtension('KHR_draco_mesh_compression');
    assert.deepEqual(await errorsOf(document), []);
    // Quantized, compressed with meshopt, and read again.
    document.createExtension(KHRMeshQuantization).setRequired(true);
    for (const primitive of primitivesOf(document)) {
      const position = primitive.getAttribute('POSITION');
      const largest = Math.max(...position.getArray().map(Math.abs));
      const integers = Int16Array.from(position.getArray(), (x) => Math.round((32767 * x) / largest));
      position.setArray(integers).setNormalized(true);
    }
    document
      .createExtension(EXTMeshoptCompression)
      .setRequired(true)
      .setEncoderOptions({ method: EXTMeshoptCompression.EncoderMethod.QUANTIZE });
    await MeshoptEncoder.ready;
    const again = await io.readBinary(await io.writeBinary(document));
    assert.ok(primitivesOf(again)[0].getAttribute('POSITION').getArray() instanceof Int16Array);
    await transformed(again, { maxNormalAngle: 30 });
    assert.deepEqual(await errorsOf(again), []);
  });
}

test('strips and fans stay, with a warning; lines and points stay', async () => {
  const document = empty();
  const { primitive, mesh } = add(document, plane(3, 1, 9, 9));
  const old = [...primitive.getIndices().getArray()];
  for (const mode of [0, 1, 5, 6]) {
    primitive.setMode(mode);
    const lines = listen(document);
    await document.transform(delaunay());
    const warning = { 5: 'strip', 6: 'fan' }[mode];
    const expected = warning
      ? [`warn: delaunay: mesh 0 ('thing'), primitive 0: a triangle ${warning} stays as it is`]
      : [];
    assert.deepEqual(lines, [...expected, 'info: delaunay: 0 flips in 0 of 0 primitives; every edge is Delaunay']);
    assert.deepEqual([...primitive.getIndices().getArray()], old);
  }
  mesh.addPrimitive(document.createPrimitive());
  document.setLogger(new Logger(Logger.Verbosity.SILENT));
  await document.transform(delaunay());
});

const refused = (code, pattern) => (error) => {
  assert.ok(error instanceof EdgeflipError, String(error));
  assert.equal(error.code, code, error.message);
  assert.match(error.message, pattern);
  return true;
};

test('options and errors', async () => {
  const run = async (options, change = () => {}) => {
    const document = empty();
    const { positions, indices } = await generate('random 9');
    const geometry = new THREE.PlaneGeometry().setIndex([...indices]).toNonIndexed();
    const points = Array.from(geometry.attributes.position.array).map(() => 0);
    indices.forEach((vertex, i) => points.splice(3 * i, 2, positions[2 * vertex], positions[2 * vertex + 1]));
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
    // Texture coordinates differ at each corner.
    for (const [name, width] of [
      ['uv', 2],
      ['normal', 3],
    ]) {
      const numbers = Float32Array.from({ length: width * indices.length }, (_, i) =>
        name === 'uv' ? i : Number(i % 3 === 2),
      );
      geometry.setAttribute(name, new THREE.BufferAttribute(numbers, width));
    }
    change(add(document, geometry).primitive);
    const lines = listen(document);
    await document.transform(delaunay(options));
    return lines[0];
  };
  assert.match(await run(), /: 0 flips in 0 of 1 primitives; .*locked \d+/);
  assert.match(await run({ weld: true }), /: \d\d+ flips in 1 of 1 primitives; every edge is Delaunay/);
  assert.match(await run({ weld: false }), /: 0 flips in 0 of 1 primitives; every edge is Delaunay/);
  assert.match(await run({ weld: true, maxIterations: 1 }), /: \d+ flips .*stopped \d+/);
  assert.match(await run({ signal: AbortSignal.abort() }), /: 0 flips in 0 of 1 primitives; stopped after 0/);
  assert.throws(() => delaunay({ lockedEdges: [] }), refused('invalid-option', /lockedEdges is not an option/));
  assert.throws(() => delaunay(3), refused('invalid-input', /options: 3 is not an object/));
  await assert.rejects(
    run({ backend: 'gpu' }),
    refused('invalid-option', /mesh 0 \('thing'\), primitive 0: .*backend/),
  );
  await assert.rejects(
    run({}, (primitive) => primitive.getAttribute('POSITION').setElement(1, [NaN, 0, 0])),
    refused('non-finite', /mesh 0 \('thing'\), primitive 0: .*vertex 1/),
  );
  await assert.rejects(
    run({}, (primitive) => primitive.getAttribute('NORMAL').setArray(new Float32Array(3))),
    refused('invalid-input', /primitive 0: an attribute has 1 vertices/),
  );
});
