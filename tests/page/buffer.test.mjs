// The demo page draws from the buffer that the flips write. The test records the calls of WebGPU in Chromium.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { expected, meshFile, sharedPage } from './page.mjs';

/** Runs in the page: records the calls on its buffers until `unwatch` is called. Each object has its own number. */
function watchBuffers() {
  const numbers = new Map();
  const idOf = (object) => {
    if (!numbers.has(object)) numbers.set(object, numbers.size);
    return numbers.get(object);
  };
  const seen = { events: [], buffers: {}, devices: new Set() };
  window.seen = () => ({ ...seen, devices: seen.devices.size });
  const undo = [];
  window.unwatch = () => undo.forEach((restore) => restore());
  const note = (what, more) => seen.events.push({ what, state: document.body.dataset.state, ...more });
  /** Calls `look` with the result of a method, its object and its arguments. */
  const watch = ({ prototype }, method, look) => {
    const original = prototype[method];
    undo.unshift(() => (prototype[method] = original));
    prototype[method] = function (...args) {
      const result = original.apply(this, args);
      look(result, this, args);
      return result;
    };
  };
  const ofEncoder = new Map(); // the device of each encoder and pass, by its number
  const inherit = (object, from) => ofEncoder.set(idOf(object), ofEncoder.get(idOf(from)));

  watch(GPUDevice, 'createBuffer', (buffer, device, [{ label = '', size, usage, mappedAtCreation = false }]) => {
    seen.devices.add(device);
    seen.buffers[idOf(buffer)] = { label, size, usage, mappedAtCreation, device: idOf(device) };
    note('create', { buffer: idOf(buffer) });
  });
  const bound = new Map();
  watch(GPUDevice, 'createBindGroup', (group, _, [{ entries }]) => {
    const buffers = [...entries].map(({ resource }) => (resource instanceof GPUBuffer ? resource : resource.buffer));
    bound.set(group, buffers.filter((buffer) => buffer).map(idOf));
  });
  watch(GPUComputePassEncoder, 'setBindGroup', (_, pass, [, group]) => {
    if (group) note('compute', { buffers: bound.get(group), device: ofEncoder.get(idOf(pass)) });
  });
  watch(GPUDevice, 'createCommandEncoder', (encoder, device) => ofEncoder.set(idOf(encoder), idOf(device)));
  watch(GPUDevice, 'createRenderBundleEncoder', (encoder, device) => ofEncoder.set(idOf(encoder), idOf(device)));
  watch(GPUCommandEncoder, 'beginRenderPass', inherit);
  watch(GPUCommandEncoder, 'beginComputePass', inherit);
  const groups = new Map();
  for (const encoder of [GPURenderPassEncoder, GPURenderBundleEncoder]) {
    watch(encoder, 'setBindGroup', (_, pass, [index, group]) => {
      if (!groups.has(pass)) groups.set(pass, []);
      groups.get(pass)[index] = group;
    });
    watch(encoder, 'draw', (_, pass, [count]) => {
      const buffers = groups.get(pass).flatMap((group) => bound.get(group));
      note('draw', { buffers, count, device: ofEncoder.get(idOf(pass)) });
    });
  }
  watch(GPUCommandEncoder, 'copyBufferToBuffer', (_, __, args) => {
    const target = args.find((arg, i) => i > 0 && arg instanceof GPUBuffer);
    note('copy', { from: idOf(args[0]), to: idOf(target), size: args.at(-1) });
  });
  watch(GPUQueue, 'writeBuffer', (_, __, [buffer, , data]) =>
    note('write', { buffer: idOf(buffer), size: data.byteLength }),
  );
  // A reused buffer may be larger than the data that is read.
  watch(GPUBuffer, 'mapAsync', (_, buffer, [, first = 0, size = buffer.size - first]) =>
    note('map', { buffer: idOf(buffer), size }),
  );
}

/** The most bytes of small reads, such as counters. */
const SMALL = 8192;

test('while it plays on WebGPU, the page draws from the session’s own buffer, every iteration, and reads no triangle back', async (t) => {
  const path = await meshFile('uvsphere 110', 'sphere.off');
  const { mesh, rows, facts } = await expected(path);
  const bytes = 4 * mesh.indices.length;
  assert.ok(mesh.indices.length > 3 * 20_000, 'large enough that no edge is coloured');
  const page = await sharedPage();
  await page.page.evaluate(watchBuffers);
  await page.open(path);
  await page.chooseEngine('webgpu');
  const end = await page.playToEnd(120);
  assert.deepEqual(
    end.rows.map((row) => row.slice(0, 4)),
    rows,
  );
  assert.equal(end.facts.Fingerprint, facts.Fingerprint);

  const { events, buffers, devices } = await page.page.evaluate(() => {
    window.unwatch();
    return window.seen();
  });
  const { MAP_READ, COPY_DST, INDEX, STORAGE } = await page.page.evaluate(() => {
    const { MAP_READ, COPY_DST, INDEX, STORAGE } = GPUBufferUsage;
    return { MAP_READ, COPY_DST, INDEX, STORAGE };
  });
  assert.equal(devices, 1, 'devices with buffers');
  const playing = events.filter(({ state }) => state === 'playing');

  // The session's buffer: the module creates it once, before the page creates its own.
  const sessions = Object.entries(buffers).filter(([, { label, size }]) => label === 'triangles' && size === bytes);
  assert.equal(sessions.length, 1, 'buffers of that size with the label triangles');
  const [[key, triangles]] = sessions;
  const id = Number(key);
  assert.equal(triangles.usage & (INDEX | STORAGE), INDEX | STORAGE);
  const passes = playing.filter(({ what, buffers: bound }) => what === 'compute' && bound.includes(id));
  assert.ok(passes.length >= rows.length, `${passes.length} compute passes bind the triangles`);

  const draws = playing.filter(({ what, count }) => what === 'draw' && count === mesh.indices.length);
  // A shader reads the triangles. It also reads positions and states, and no other copy of the triangles.
  const ofTriangles = (of) => of?.size === bytes && of.label !== 'copied positions';
  const drawn = draws.flatMap((draw) => draw.buffers).filter((buffer) => ofTriangles(buffers[buffer]));
  assert.deepEqual([...new Set(drawn)], [id], 'buffers that are drawn');
  assert.deepEqual([...new Set([...draws, ...passes].map(({ device }) => device))], [triangles.device]);

  // The page records the change of each iteration, and draws before it records the next. It knows the first one before
  // it plays, so that it can show the edges that flip.
  const kept = events.flatMap(({ what, buffer }, at) =>
    what === 'create' && /^changes of/.test(buffers[buffer].label) ? [at] : [],
  );
  assert.equal(kept.length, rows.length, 'iterations');
  assert.equal(events[kept[0]].state, 'ready');
  kept.forEach((from, i) => {
    const until = kept[i + 1] ?? events.length;
    const drawn = events
      .slice(from, until)
      .filter(({ what, count }) => what === 'draw' && count === mesh.indices.length).length;
    assert.ok(drawn >= 1, `${drawn} draws after iteration ${i}`);
  });

  const maps = playing.filter(({ what }) => what === 'map');
  assert.ok(maps.length > 0, 'the counters are read');
  const largest = Math.max(...maps.map(({ size }) => size));
  assert.ok(largest <= SMALL, `${largest} bytes are mapped`);
  const read = playing.filter(
    ({ what, from, to, size }) => what === 'copy' && (from === id || size >= bytes) && buffers[to].usage & MAP_READ,
  );
  assert.deepEqual(read, [], 'copies to where the page can read');
  // Buffers of the mesh before are not known.
  const toIndex = ({ buffer }) => (buffers[buffer]?.usage ?? 0) & INDEX;
  const written = playing.filter((event) => event.what === 'write' && (toIndex(event) || event.size > SMALL));
  assert.deepEqual(written, [], 'writes of an index buffer');
  const prefilled = playing.filter(
    (event) =>
      event.what === 'create' &&
      toIndex(event) &&
      (buffers[event.buffer].mappedAtCreation || buffers[event.buffer].usage & COPY_DST),
  );
  assert.deepEqual(prefilled, [], 'new index buffers that could be filled');
  t.diagnostic(
    `${draws.length} draws of ${rows.length} iterations, ${passes.length} compute passes, ${maps.length} reads of at most ${largest} bytes`,
  );

  // The recording also notices read-backs: at rest the page reads the triangles once, for the fingerprint.
  assert.ok(events.some(({ what, size, state }) => what === 'map' && state !== 'playing' && size >= bytes));
  await page.close();
});
