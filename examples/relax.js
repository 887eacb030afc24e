// Points that relax towards an even mesh, drawn by three.js. In every frame a compute pass moves each interior point
// towards the mean of the circumcentres of its triangles, weighted by their areas. Then an update flips the edges, and
// three.js draws from the buffers that both have written: nothing travels to the CPU. `npm run examples`, then open
// relax.html.

import { FlipSession } from 'edgeflip';
import { generate } from 'edgeflip/files';
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  Mesh,
  MeshBasicNodeMaterial,
  OrthographicCamera,
  Scene,
  StorageBufferAttribute,
  WebGPURenderer,
} from 'three/webgpu';
import { color, float, Fn, fwidth, min, mix, mod, smoothstep, storage, varying, vec3, vertexIndex } from 'three/tsl';
import { play } from './move.js';

const output = document.querySelector('output');
const size = Number(new URLSearchParams(location.search).get('size') ?? 60);
const mesh = await generate(`random ${size}`);
const { positions, indices } = mesh;
const vertices = positions.length / 2;

// The square from -1 to 1, with most points near its middle.
for (let i = 0; i < positions.length; i++) {
  const x = 2 * positions[i] - 1;
  positions[i] = Math.max(-1, Math.min(1, x * (0.25 + 0.75 * Math.abs(x))));
}

const renderer = new WebGPURenderer({ canvas: document.querySelector('canvas'), antialias: true });
await renderer.init();
const { device } = renderer.backend;
const session = await FlipSession.create(mesh, { backend: 'webgpu', device });
const gpu = await session.gpu();

/** The vertices of edges with one triangle stay. */
const { v1, v2, tb } = await session.edges();
const fixed = new Uint32Array(vertices);
tb.forEach((other, edge) => {
  if (other === 0xffffffff) fixed[v1[edge]] = fixed[v2[edge]] = 1;
});

const buffer = (bytes, usage = 0) =>
  device.createBuffer({ size: bytes, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST | usage });
const [isFixed, sums] = [buffer(fixed.byteLength), buffer(12 * vertices)];
const pointer = device.createBuffer({ size: 16, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
device.queue.writeBuffer(isFixed, 0, fixed);
const module = device.createShaderModule({
  code: `
    @group(0) @binding(0) var<storage, read_write> positions: array<vec2f>;
    @group(0) @binding(1) var<storage, read> indices: array<u32>;
    @group(0) @binding(2) var<storage, read> fixed: array<u32>;
    // For each vertex: the sum of the ways to the circumcentres, each times the area of its triangle, and the sum of
    // the areas. The sums are integers, so that they do not depend on the order.
    @group(0) @binding(3) var<storage, read_write> sums: array<atomic<i32>>;
    // Where the pointer is, and how strongly it pushes.
    @group(0) @binding(4) var<uniform> pointer: vec4f;
    const LENGTH = ${Math.sqrt(8 / (indices.length / 3))};
    const UNIT = 4194304.0;

    fn whole(x: f32) -> i32 {
      return i32(clamp(x * UNIT, -67108864.0, 67108864.0));
    }

    @compute @workgroup_size(256)
    fn add(@builtin(global_invocation_id) id: vec3u) {
      if 3 * id.x >= arrayLength(&indices) { return; }
      let corners = array(indices[3 * id.x], indices[3 * id.x + 1], indices[3 * id.x + 2]);
      let a = positions[corners[0]];
      let b = (positions[corners[1]] - a) / LENGTH;
      let c = (positions[corners[2]] - a) / LENGTH;
      let area = b.x * c.y - b.y * c.x;
      if area <= 0 { return; }
      // The way from a to the circumcentre, times the area.
      let way = 0.5 * vec2f(c.y * dot(b, b) - b.y * dot(c, c), b.x * dot(c, c) - c.x * dot(b, b));
      let starts = array(vec2f(0), b, c);
      for (var k = 0; k < 3; k++) {
        let own = way - area * starts[k];
        atomicAdd(&sums[3 * corners[k]], whole(own.x));
        atomicAdd(&sums[3 * corners[k] + 1], whole(own.y));
        atomicAdd(&sums[3 * corners[k] + 2], whole(area));
      }
    }

    @compute @workgroup_size(256)
    fn relax(@builtin(global_invocation_id) id: vec3u) {
      if id.x >= arrayLength(&fixed) { return; }
      let way = vec2f(f32(atomicExchange(&sums[3 * id.x], 0)), f32(atomicExchange(&sums[3 * id.x + 1], 0)));
      let area = f32(atomicExchange(&sums[3 * id.x + 2], 0));
      if fixed[id.x] == 0 && area > 0 {
        let step = 0.5 * LENGTH * way / area;
        let arm = positions[id.x] - pointer.xy;
        let push = pointer.z * arm * exp(-30 * dot(arm, arm));
        // A longer step would turn triangles over.
        positions[id.x] += step * min(1, 0.2 * LENGTH / max(length(step), 1e-9)) + push;
      }
    }`,
});
const layout = device.createBindGroupLayout({
  entries: ['storage', 'read-only-storage', 'read-only-storage', 'storage', 'uniform'].map((type, binding) => ({
    binding,
    visibility: GPUShaderStage.COMPUTE,
    buffer: { type },
  })),
});
const bindings = device.createBindGroup({
  layout,
  entries: [gpu.positions, gpu.indices, isFixed, sums, pointer].map((buffer, binding) => ({
    binding,
    resource: { buffer },
  })),
});
const [add, relax] = ['add', 'relax'].map((entryPoint) =>
  device.createComputePipeline({
    layout: device.createPipelineLayout({ bindGroupLayouts: [layout] }),
    compute: { module, entryPoint },
  }),
);

// three.js makes no buffer for an attribute that has one.
const shared = (array, itemSize, buffer) => {
  const attribute = new StorageBufferAttribute(array, itemSize);
  renderer.backend.get(attribute).buffer = buffer;
  return attribute;
};
const points = storage(shared(positions, 2, gpu.positions), 'vec2', vertices).toReadOnly();
const corners = storage(shared(indices, 1, gpu.indices), 'uint', indices.length).toReadOnly();
const isDark = matchMedia('(prefers-color-scheme: dark)').matches;
const material = new MeshBasicNodeMaterial({ side: DoubleSide });
material.positionNode = vec3(points.element(corners.element(vertexIndex)), 0);
material.colorNode = Fn(() => {
  const corner = mod(vertexIndex.toFloat(), 3);
  const distances = varying(
    vec3(
      corner.lessThan(0.5).toFloat(),
      corner.sub(1).abs().lessThan(0.5).toFloat(),
      corner.greaterThan(1.5).toFloat(),
    ),
  );
  const pixels = distances.div(fwidth(distances));
  const line = float(1).sub(smoothstep(0.3, 1.1, min(pixels.x, min(pixels.y, pixels.z))));
  return mix(color(isDark ? 0x1b3440 : 0xdcebf2), color(isDark ? 0xcfe0e8 : 0x24343f), line.mul(0.7));
})();
const geometry = new BufferGeometry();
// Four bytes for each corner, which tell three.js only how many there are.
geometry.setAttribute('position', new BufferAttribute(new Uint8Array(4 * indices.length), 4, true));
const drawn = new Mesh(geometry, material);
drawn.frustumCulled = false;
const scene = new Scene();
scene.background = new Color(isDark ? 0x12171c : 0xf7f9fa);
scene.add(drawn);
const camera = new OrthographicCamera();
const resize = () => {
  const ratio = innerWidth / innerHeight;
  const [x, y] = ratio > 1 ? [1.1 * ratio, 1.1] : [1.1, 1.1 / ratio];
  Object.assign(camera, { left: -x, right: x, top: y, bottom: -y, near: -1, far: 1 });
  camera.updateProjectionMatrix();
  renderer.setPixelRatio(devicePixelRatio);
  renderer.setSize(innerWidth, innerHeight, false);
};
addEventListener('resize', resize);
resize();

/** Pushes while the pointer moves over the square. */
let push = [0, 0, 0, 0];
renderer.domElement.onpointermove = ({ clientX, clientY }) => {
  const [x, y] = [(2 * clientX) / innerWidth - 1, 1 - (2 * clientY) / innerHeight];
  push = [x * camera.right, y * camera.top, 0.05, 0];
};

// The circumcentres of a mesh that is not Delaunay are far from its vertices.
await session.run();

function frame() {
  device.queue.writeBuffer(pointer, 0, new Float32Array(push));
  push[2] *= 0.9;
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginComputePass();
  pass.setBindGroup(0, bindings);
  for (const [pipeline, count] of [
    [add, indices.length / 3],
    [relax, vertices],
  ]) {
    pass.setPipeline(pipeline);
    pass.dispatchWorkgroups(Math.ceil(count / 256));
  }
  pass.end();
  device.queue.submit([encoder.finish()]);
  session.update();
  renderer.render(scene, camera);
}

// For the tests: `?paused` draws no frame by itself.
globalThis.example = { session, mesh, frame };
if (!location.search.includes('paused')) play(session, output, frame);
