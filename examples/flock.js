// A flock in a box: each bird turns towards the directions of all birds within a radius. A compute pass finds them by
// walks over the Delaunay triangulation of the birds, with the buffers that the option `adjacency` gives; then an
// update flips the edges, and the frame is drawn from the same buffers. `npm run examples`, then open flock.html; with
// `?check`, it compares 5 frames with a search among all birds.

import { FlipSession } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { screen } from './draw.js';
import { play } from './move.js';
import neighbours from './neighbours.wgsl?raw';

const [canvas, output, button, result] = ['canvas', 'output', 'button', '#check'].map((name) =>
  document.querySelector(name),
);
const query = new URLSearchParams(location.search);
const size = Number(query.get('size') ?? 317);
const mesh = await generate(`grid ${size}`);
const { positions, indices } = mesh;
const vertices = positions.length / 2;
const session = await FlipSession.create(mesh, { backend: 'webgpu', adjacency: true });
await session.run();
const { device, ...gpu } = await session.gpu();
/** So many are enough for the motion of a frame, as a rule. */
const iterations = 12;

/** The mean distance of birds, and the width of the box. */
const spacing = 1 / size;
const width = 1 - spacing;
/** The vertices on the boundary are the wall of the box: their direction is 0. */
const { v1, v2, tb } = await session.edges();
const birds = Float32Array.from({ length: 4 * vertices }, (_, i) => positions[2 * (i >> 2) + (i & 1)]);
for (let i = 0; i < vertices; i++) {
  const angle = 2 * Math.PI * Math.random();
  birds.set([Math.cos(angle), Math.sin(angle)], 4 * i + 2);
}
tb.forEach((other, edge) => {
  if (other === 0xffffffff) for (const vertex of [v1[edge], v2[edge]]) birds.fill(0, 4 * vertex + 2, 4 * vertex + 4);
});

const buffer = (bytes, usage = GPUBufferUsage.STORAGE) =>
  device.createBuffer({ size: bytes, usage: usage | GPUBufferUsage.COPY_DST | GPUBufferUsage.COPY_SRC });
const [before, after, seen] = [16, 16, 8].map((bytes) => buffer(bytes * vertices));
const tally = buffer(16);
const uniform = buffer(32, GPUBufferUsage.UNIFORM);
device.queue.writeBuffer(before, 0, birds);

const module = device.createShaderModule({
  code: `
    struct Now {
      // Where the pointer is, and 1 if it is there.
      pointer: vec3f,
      frame: u32,
      // The first bird that a pass of \`compare\` looks at.
      first: u32,
    }
    @group(0) @binding(0) var<uniform> now: Now;
    @group(0) @binding(1) var<storage, read> indices: array<u32>;
    @group(0) @binding(2) var<storage, read> twins: array<u32>;
    @group(0) @binding(3) var<storage, read> half_edges: array<u32>;
    // The place of each bird, and its direction.
    @group(0) @binding(4) var<storage, read> before: array<vec4f>;
    @group(0) @binding(5) var<storage, read_write> after: array<vec4f>;
    // For each vertex the number of its neighbours, and the sum of their hashes.
    @group(0) @binding(6) var<storage, read_write> seen: array<vec2u>;
    // Searches that lost neighbours, vertices whose neighbours are wrong, neighbours.
    @group(0) @binding(7) var<storage, read_write> tally: array<atomic<u32>, 3>;
    const RADIUS = ${2 * spacing};
    const WIDTH = ${width};
    const SPEED = ${0.1 * spacing};
    ${neighbours}

    fn place(v: u32) -> vec2f {
      return before[v].xy;
    }

    fn hash(i: u32) -> u32 {
      var x = i * 0x9e3779b9u;
      x = (x ^ (x >> 16u)) * 0x7feb352du;
      return x ^ (x >> 15u);
    }

    // How far a vertex may move. If each vertex moves less than half of the smallest height of its triangles, no
    // triangle turns over, and no bird leaves the box.
    fn room(v: u32) -> f32 {
      var least = 1.0;
      let start = half_edges[v];
      var h = start;
      while h != NONE {
        let b = place(indices[next(h)]) - place(v);
        let c = place(indices[prev(h)]) - place(v);
        let longest = max(dot(c - b, c - b), max(dot(b, b), dot(c, c)));
        least = min(least, abs(b.x * c.y - b.y * c.x) * inverseSqrt(longest));
        h = twins[prev(h)];
        if h == start { break; }
      }
      return 0.4 * least;
    }

    @compute @workgroup_size(64)
    fn steer(@builtin(global_invocation_id) id: vec3u) {
      let i = id.x;
      if i >= arrayLength(&before) { return; }
      let own = before[i];
      let count = search(i);
      if count > MOST { atomicAdd(&tally[0], 1); }
      var sums = vec2u();
      var direction = own.zw;
      var away = vec2f();
      for (var k = 1u; k < min(count, MOST); k++) {
        let other = before[found[k]];
        let way = (other.xy - own.xy) / RADIUS;
        if !is_near(other.xy - own.xy) { continue; }
        sums += vec2u(1, hash(found[k]));
        direction += other.zw;
        away -= way * (1 / max(length(way), 0.05) - 1);
      }
      seen[i] = sums;
      if all(own.zw == vec2f()) {
        after[i] = own;
        return;
      }
      let wall = max(vec2f(), 1 - own.xy / (0.03 * WIDTH)) - max(vec2f(), 1 - (WIDTH - own.xy) / (0.03 * WIDTH));
      let arm = own.xy - now.pointer.xy;
      let fear = now.pointer.z * arm / (dot(arm, arm) + 1e-5) * 0.15 * exp(-60 * dot(arm, arm));
      let noise = (f32(hash(i ^ (now.frame << 17u)) >> 8u) / 16777216 - 0.5) * 0.7;
      let wish = direction / max(length(direction), 1e-6) + 0.12 * away + 0.6 * wall + fear;
      let turned = vec2f(wish.x * cos(noise) - wish.y * sin(noise), wish.x * sin(noise) + wish.y * cos(noise));
      let heading = turned / max(length(turned), 1e-6);
      after[i] = vec4f(own.xy + heading * min(SPEED, room(i)), heading);
    }

    // Looks at all birds, to check the neighbours that the walks have found.
    @compute @workgroup_size(64)
    fn compare(@builtin(global_invocation_id) id: vec3u) {
      let i = now.first + id.x;
      if i >= arrayLength(&before) { return; }
      var sums = vec2u();
      for (var j = 0u; j < arrayLength(&before); j++) {
        if j != i && is_near(before[j].xy - before[i].xy) { sums += vec2u(1, hash(j)); }
      }
      if any(sums != seen[i]) { atomicAdd(&tally[1], 1); }
      atomicAdd(&tally[2], sums.x);
    }`,
});
const layout = device.createBindGroupLayout({
  entries: ['uniform', ...Array(4).fill('read-only-storage'), ...Array(3).fill('storage')].map((type, binding) => ({
    binding,
    visibility: GPUShaderStage.COMPUTE,
    buffer: { type },
  })),
});
const pipelineLayout = device.createPipelineLayout({ bindGroupLayouts: [layout] });
const [steer, compare] = ['steer', 'compare'].map((entryPoint) =>
  device.createComputePipeline({ layout: pipelineLayout, compute: { module, entryPoint } }),
);
/** From one of the two buffers of birds to the other. */
const turns = [
  [before, after],
  [after, before],
].map(([from, to]) => ({
  to,
  bindings: device.createBindGroup({
    layout,
    entries: [uniform, gpu.indices, gpu.twins, gpu.vertexHalfEdges, from, to, seen, tally].map((buffer, binding) => ({
      binding,
      resource: { buffer },
    })),
  }),
}));

function submit(pipeline, bindings, count) {
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, bindings);
  pass.dispatchWorkgroups(Math.ceil(count / 64));
  pass.end();
  device.queue.submit([encoder.finish()]);
}

/** The numbers of the tally, which begin again at 0. */
async function tallied() {
  const staging = device.createBuffer({ size: 16, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  const encoder = device.createCommandEncoder();
  encoder.copyBufferToBuffer(tally, 0, staging, 0, 16);
  encoder.clearBuffer(tally);
  device.queue.submit([encoder.finish()]);
  await staging.mapAsync(GPUMapMode.READ);
  const [lost, wrong, found] = new Uint32Array(staging.getMappedRange());
  staging.destroy();
  return { lost, wrong, found };
}

/** Compares the neighbours of the last frame with those that a search among all birds finds. */
function compared() {
  // A pass with all birds would hold up the GPU for too long.
  for (let first = 0; first < vertices; first += 8192) {
    device.queue.writeBuffer(uniform, 16, new Uint32Array([first]));
    submit(compare, turns[(frames + 1) % 2].bindings, Math.min(8192, vertices - first));
  }
  return tallied();
}

const show = screen(canvas, device);
const drawing = device.createShaderModule({
  code: `
    // The place of clip coordinate 0, their scale, half the length of a bird, and 1 if the page is dark.
    struct View { middle: f32, scale: vec2f, length: f32, dark: f32 }
    @group(0) @binding(0) var<uniform> view: View;
    @group(0) @binding(1) var<storage, read> birds: array<vec4f>;
    @group(0) @binding(2) var<storage, read> indices: array<u32>;

    struct Corner {
      @builtin(position) at: vec4f,
      @location(0) direction: vec2f,
      // How far the corner is from each side of its triangle, from 0 to 1.
      @location(1) distances: vec3f,
    }

    fn clip(place: vec2f) -> vec4f {
      return vec4f((place - view.middle) * view.scale, 0.5, 1);
    }

    fn colour(direction: vec2f) -> vec3f {
      let angle = atan2(direction.y, direction.x);
      return mix(0.42, 0.55, view.dark) + mix(0.36, 0.42, view.dark) * cos(angle + vec3f(0, 2.1, 4.2));
    }

    @vertex
    fn triangle(@builtin(vertex_index) i: u32) -> Corner {
      let bird = birds[indices[i]];
      return Corner(clip(bird.xy), bird.zw, vec3f(vec3u(i % 3) == vec3u(0, 1, 2)));
    }

    @fragment
    fn inside(corner: Corner) -> @location(0) vec4f {
      let width = fwidth(corner.distances);
      let pixels = corner.distances / width;
      // Lines only where a triangle is large enough to see them.
      let line = 1 - smoothstep(0.2, 1.0, min(pixels.x, min(pixels.y, pixels.z)));
      let large = 1 - smoothstep(0.03, 0.15, max(width.x, max(width.y, width.z)));
      return vec4f(colour(corner.direction), min(1, 0.3 * length(corner.direction) + 0.3 * line * large));
    }

    @vertex
    fn bird(@builtin(vertex_index) k: u32, @builtin(instance_index) i: u32) -> Corner {
      let bird = birds[i];
      let side = vec2f(-bird.w, bird.z);
      let corners = array(1.2 * bird.zw, -0.8 * bird.zw + 0.6 * side, -0.8 * bird.zw - 0.6 * side);
      return Corner(clip(bird.xy + view.length * corners[k]), bird.zw, vec3f(1));
    }

    @fragment
    fn whole(corner: Corner) -> @location(0) vec4f {
      return vec4f(colour(corner.direction), 1);
    }`,
});
const view = buffer(32, GPUBufferUsage.UNIFORM);
const drawLayout = device.createBindGroupLayout({
  entries: ['uniform', 'read-only-storage', 'read-only-storage'].map((type, binding) => ({
    binding,
    visibility: GPUShaderStage.VERTEX | GPUShaderStage.FRAGMENT,
    buffer: { type },
  })),
});
const blend = { srcFactor: 'src-alpha', dstFactor: 'one-minus-src-alpha' };
const [field, darts] = [
  ['triangle', 'inside'],
  ['bird', 'whole'],
].map(([vertex, fragment]) =>
  device.createRenderPipeline({
    layout: device.createPipelineLayout({ bindGroupLayouts: [drawLayout] }),
    vertex: { module: drawing, entryPoint: vertex },
    fragment: {
      module: drawing,
      entryPoint: fragment,
      targets: [{ format: show.format, blend: { color: blend, alpha: blend } }],
    },
    ...show.state,
  }),
);
const drawBindings = turns.map(({ to }) =>
  device.createBindGroup({
    layout: drawLayout,
    entries: [view, to, gpu.indices].map((buffer, binding) => ({ binding, resource: { buffer } })),
  }),
);

/** From places in the box to clip coordinates. */
const scales = () => {
  const { clientWidth, clientHeight } = canvas;
  const pixels = 0.96 * Math.min(clientWidth, clientHeight);
  return [pixels / clientWidth, pixels / clientHeight].map((part) => (2 * part) / width);
};
const pointer = [0, 0, 0];
canvas.onpointermove = ({ clientX, clientY }) => {
  const [x, y] = scales();
  const at = [(2 * clientX) / innerWidth - 1, 1 - (2 * clientY) / innerHeight];
  pointer.splice(0, 3, width / 2 + at[0] / x, width / 2 + at[1] / y, 1);
};
canvas.onpointerleave = () => (pointer[2] = 0);

let frames = 0;
function frame() {
  const numbers = new Float32Array([...pointer, 0]);
  new Uint32Array(numbers.buffer)[3] = frames;
  device.queue.writeBuffer(uniform, 0, numbers);
  const { to, bindings } = turns[frames % 2];
  submit(steer, bindings, vertices);
  session.update({ buffer: to, stride: 4, iterations });
  const [x, y] = scales();
  // No bird is smaller than a pixel.
  const length = Math.max(0.4 * spacing, 1 / (x * canvas.clientWidth * devicePixelRatio));
  show((pass, isDark) => {
    device.queue.writeBuffer(view, 0, new Float32Array([width / 2, 0, x, y, length, isDark, 0, 0]));
    pass.setBindGroup(0, drawBindings[frames % 2]);
    pass.setPipeline(field);
    pass.draw(indices.length);
    pass.setPipeline(darts);
    pass.draw(3, vertices);
  });
  frames++;
}

/** Draws frames and checks them, and tells the result. */
async function check(count) {
  button.disabled = true;
  const sums = { lost: 0, wrong: 0, found: 0 };
  for (let i = 0; i < count; i++) {
    await new Promise((resolve) => requestAnimationFrame(resolve));
    await tallied();
    frame();
    for (const [name, number] of Object.entries(await compared())) sums[name] += number;
  }
  const [found, wrong] = [sums.found, sums.wrong].map((number) => number.toLocaleString('en'));
  result.textContent = sums.wrong
    ? `${wrong} birds have other neighbours than a search among all birds finds`
    : `${found} neighbours are those that a search among all birds finds`;
  button.disabled = false;
  return sums;
}
button.onclick = () => check(1);

// For the tests: `?paused` draws no frame by itself.
globalThis.example = { session, mesh, frame, iterations, check };
if (query.has('check')) await check(5);
if (!query.has('paused')) {
  play(session, output, frame, async ({ inverted }) => {
    const { lost } = await tallied();
    return `, ${inverted} triangles turned over, ${lost} searches not complete`;
  });
}
