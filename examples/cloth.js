// A cloth that hangs in the wind: particles, and a spring along each edge of a mesh. In every frame a compute pass
// walks around each particle for the forces of its springs, with the buffers that the option `adjacency` gives. Then an
// update flips edges, so the springs are always between particles that are close. `npm run examples`, then open
// cloth.html.

import { FlipSession } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { Matrix4, PerspectiveCamera } from 'three';
import { drawer } from './draw.js';
import { play } from './move.js';

const [canvas, output] = ['canvas', 'output'].map((name) => document.querySelector(name));
const size = Number(new URLSearchParams(location.search).get('size') ?? 81);
const sheet = await generate(`grid ${size}`);
const vertices = sheet.positions.length / 2;
const width = 1 - 1 / size;

/** Where each particle is on the cloth: from -1 to 1, and from -2 at the hem to 0 at the rod. */
const places = sheet.positions.map((x, i) => (2 * x) / width - (i % 2 ? 2 : 1));
/** Each particle: its place and its speed, three numbers and a zero each. The cloth falls from a slant. */
const particles = new Float32Array(8 * vertices);
const mesh = { positions: new Float32Array(3 * vertices), indices: sheet.indices, dimension: 3 };
for (let i = 0; i < vertices; i++) {
  const [x, z] = places.subarray(2 * i, 2 * i + 2);
  const place = [x - 0.3 * z, 0.3 * z, 0.9 * z];
  particles.set(place, 8 * i);
  mesh.positions.set(place, 3 * i);
}

const session = await FlipSession.create(mesh, { backend: 'webgpu', maxNormalAngle: 30, adjacency: true });
await session.run();
const { device, ...gpu } = await session.gpu();
const buffer = (bytes, usage = GPUBufferUsage.STORAGE) =>
  device.createBuffer({ size: bytes, usage: usage | GPUBufferUsage.COPY_DST });
const [before, after] = [buffer(particles.byteLength), buffer(particles.byteLength)];
const onCloth = buffer(places.byteLength);
const wind = buffer(16, GPUBufferUsage.UNIFORM);
device.queue.writeBuffer(before, 0, particles);
device.queue.writeBuffer(onCloth, 0, places);

/** Steps of the motion in a frame: an even number, so that the particles are in the first buffer again. */
const STEPS = 8;
const module = device.createShaderModule({
  code: `
    struct Particle { place: vec3f, speed: vec3f }
    @group(0) @binding(0) var<uniform> wind: vec4f;
    @group(0) @binding(1) var<storage, read> indices: array<u32>;
    @group(0) @binding(2) var<storage, read> twins: array<u32>;
    @group(0) @binding(3) var<storage, read> half_edges: array<u32>;
    @group(0) @binding(4) var<storage, read> on_cloth: array<vec2f>;
    @group(0) @binding(5) var<storage, read> before: array<Particle>;
    @group(0) @binding(6) var<storage, read_write> after: array<Particle>;
    const NONE = 0xffffffffu;
    const TIME = ${1 / 60 / STEPS};

    fn next(h: u32) -> u32 {
      return select(h + 1, h - 2, h % 3 == 2);
    }

    fn prev(h: u32) -> u32 {
      return select(h - 1, h + 2, h % 3 == 0);
    }

    // The force of the spring from particle i to particle j. Its length at rest is that on the cloth.
    fn pull(i: u32, j: u32) -> vec3f {
      let way = before[j].place - before[i].place;
      let length = max(length(way), 1e-6);
      let speed = dot(before[j].speed - before[i].speed, way) / length;
      return (6000 * (length - distance(on_cloth[i], on_cloth[j])) + 3 * speed) * way / length;
    }

    // A number close to zero would span many bits beside the others.
    fn rounded(place: vec3f) -> vec3f {
      return round(place * 4194304) / 4194304;
    }

    @compute @workgroup_size(64)
    fn swing(@builtin(global_invocation_id) id: vec3u) {
      let i = id.x;
      if i >= arrayLength(&before) { return; }
      let own = before[i];
      // The rod holds the first row.
      if on_cloth[i].y > -0.001 {
        after[i] = own;
        return;
      }
      var force = vec3f(0, 0, -1.5);
      var normal = vec3f();
      let start = half_edges[i];
      var h = start;
      while h != NONE {
        let last = prev(h);
        let neighbour = indices[next(h)];
        force += pull(i, neighbour);
        normal += cross(before[neighbour].place - own.place, before[indices[last]].place - own.place);
        h = twins[last];
        if h == NONE { force += pull(i, indices[last]); }
        if h == start { break; }
      }
      normal /= max(length(normal), 1e-9);
      force += 2 * dot(wind.xyz - own.speed, normal) * normal - 0.3 * own.speed;
      let speed = own.speed + TIME * force;
      after[i] = Particle(rounded(own.place + TIME * speed), speed);
    }`,
});
const pipeline = device.createComputePipeline({ layout: 'auto', compute: { module } });
const turns = [
  [before, after],
  [after, before],
].map((pair) =>
  device.createBindGroup({
    layout: pipeline.getBindGroupLayout(0),
    entries: [wind, gpu.indices, gpu.twins, gpu.vertexHalfEdges, onCloth, ...pair].map((buffer, binding) => ({
      binding,
      resource: { buffer },
    })),
  }),
);
const draw = drawer(canvas, { device, ...gpu }, 3, mesh.indices.length / 3);

// From clip coordinates of WebGL to those of WebGPU.
const depth = new Matrix4().set(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5, 0.5, 0, 0, 0, 1);
const camera = new PerspectiveCamera(40, 1, 0.1, 20);
camera.up.set(0, 0, 1);
/** The wind that the pointer asks for. */
let wanted;
canvas.onpointermove = ({ clientX, clientY }) => {
  wanted = [(8 * clientX) / innerWidth - 4, 4 - (6 * clientY) / innerHeight];
};

function frame(time) {
  const [across, along] = wanted ?? [2 * Math.sin(0.5 * time), 0.6 + 1.6 * Math.sin(0.8 * time)];
  device.queue.writeBuffer(wind, 0, new Float32Array([across, along, 0.3 * Math.sin(2.3 * time), 0]));
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  for (let step = 0; step < STEPS; step++) {
    pass.setBindGroup(0, turns[step % 2]);
    pass.dispatchWorkgroups(Math.ceil(vertices / 64));
  }
  pass.end();
  device.queue.submit([encoder.finish()]);
  session.update({ buffer: before, stride: 8 });
  camera.aspect = canvas.clientWidth / canvas.clientHeight;
  camera.position.set(1.2, -4.2, -0.6).multiplyScalar(Math.max(1, 0.95 / camera.aspect));
  camera.lookAt(0, 0, -1);
  camera.updateMatrixWorld();
  camera.updateProjectionMatrix();
  draw(new Matrix4().multiplyMatrices(depth, camera.projectionMatrix).multiply(camera.matrixWorldInverse).elements);
}

// For the tests: `?paused` draws no frame by itself.
globalThis.example = { session, mesh, frame };
if (!location.search.includes('paused')) play(session, output, frame);
