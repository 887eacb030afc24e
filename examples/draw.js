// Draws a mesh from the buffers of a session, without a copy: each corner reads its triangle from them. Thin triangles
// are warm, those of equal angles are cool.

const SHADER = `
  override DIMENSION: u32 = 2;
  struct View { matrix: mat4x4f, dark: f32 }
  @group(0) @binding(0) var<uniform> view: View;
  @group(0) @binding(1) var<storage, read> positions: array<f32>;
  @group(0) @binding(2) var<storage, read> indices: array<u32>;

  struct Corner {
    @builtin(position) at: vec4f,
    // How far the corner is from each side, from 0 to 1.
    @location(0) distances: vec3f,
    @location(1) @interpolate(flat) color: vec3f,
  }

  fn point(i: u32) -> vec3f {
    let at = DIMENSION * indices[i];
    return vec3f(positions[at], positions[at + 1], select(0.0, positions[at + DIMENSION - 1], DIMENSION == 3));
  }

  // The cosine of the angle at a.
  fn cosine(a: vec3f, b: vec3f, c: vec3f) -> f32 {
    return dot(normalize(b - a), normalize(c - a));
  }

  @vertex
  fn corner(@builtin(vertex_index) i: u32) -> Corner {
    let t = i - i % 3;
    let points = array(point(t), point(t + 1), point(t + 2));
    let cosines = vec3f(
      cosine(points[0], points[1], points[2]),
      cosine(points[1], points[2], points[0]),
      cosine(points[2], points[0], points[1]),
    );
    // The smallest angle: 0 to 60 degrees.
    let quality = acos(clamp(max(cosines.x, max(cosines.y, cosines.z)), -1, 1)) / 1.0472;
    let thin = mix(vec3f(0.93, 0.42, 0.22), vec3f(0.98, 0.5, 0.25), view.dark);
    let even = mix(vec3f(0.8, 0.9, 0.95), vec3f(0.12, 0.3, 0.4), view.dark);
    let normal = normalize(cross(points[1] - points[0], points[2] - points[0]));
    let light = select(1.0, 0.55 + 0.45 * abs(dot(normal, normalize(vec3f(1, -2, 2)))), DIMENSION == 3);
    let distances = vec3f(vec3u(i % 3) == vec3u(0, 1, 2));
    return Corner(view.matrix * vec4f(points[i % 3], 1), distances, mix(thin, even, smoothstep(0.05, 0.5, quality)) * light);
  }

  @fragment
  fn inside(corner: Corner) -> @location(0) vec4f {
    let pixels = corner.distances / fwidth(corner.distances);
    let line = 1 - smoothstep(0.3, 1.1, min(pixels.x, min(pixels.y, pixels.z)));
    let ink = mix(vec3f(0.1, 0.16, 0.22), vec3f(0.85, 0.93, 0.97), view.dark);
    return vec4f(mix(corner.color, ink, 0.55 * line), 1);
  }`;

/**
 * Returns a function that shows a frame: it calls `record` with a render pass, and with 1 if the page is dark, else 0.
 * `format` and `state` are what the pipelines need.
 */
export function screen(canvas, device) {
  const context = canvas.getContext('webgpu');
  const format = navigator.gpu.getPreferredCanvasFormat();
  context.configure({ device, format });
  const dark = matchMedia('(prefers-color-scheme: dark)');
  let textures = [];
  const show = (record) => {
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((n) => Math.max(1, n * devicePixelRatio));
    if (textures[0]?.width !== Math.floor(width) || textures[0].height !== Math.floor(height)) {
      [canvas.width, canvas.height] = [width, height];
      for (const texture of textures) texture.destroy();
      const usage = GPUTextureUsage.RENDER_ATTACHMENT;
      textures = [format, 'depth24plus'].map((format) =>
        device.createTexture({ size: [canvas.width, canvas.height], format, usage, sampleCount: 4 }),
      );
    }
    const background = dark.matches ? [0.07, 0.09, 0.11, 1] : [0.97, 0.98, 0.98, 1];
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginRenderPass({
      colorAttachments: [
        {
          view: textures[0].createView(),
          resolveTarget: context.getCurrentTexture().createView(),
          clearValue: background,
          loadOp: 'clear',
          storeOp: 'discard',
        },
      ],
      depthStencilAttachment: {
        view: textures[1].createView(),
        depthClearValue: 1,
        depthLoadOp: 'clear',
        depthStoreOp: 'discard',
      },
    });
    record(pass, Number(dark.matches));
    pass.end();
    device.queue.submit([encoder.finish()]);
  };
  const depthStencil = { format: 'depth24plus', depthCompare: 'less-equal', depthWriteEnabled: true };
  return Object.assign(show, { format, state: { depthStencil, multisample: { count: 4 } } });
}

/** Returns a function that draws a frame; it takes a matrix of 16 numbers, column by column. */
export function drawer(canvas, { device, positions, indices }, dimension, triangles) {
  const show = screen(canvas, device);
  const module = device.createShaderModule({ code: SHADER });
  const pipeline = device.createRenderPipeline({
    layout: 'auto',
    vertex: { module, constants: { DIMENSION: dimension } },
    fragment: { module, targets: [{ format: show.format }] },
    ...show.state,
  });
  const view = device.createBuffer({ size: 80, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
  const entries = [view, positions, indices].map((buffer, binding) => ({ binding, resource: { buffer } }));
  const bindings = device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries });
  return (matrix) =>
    show((pass, isDark) => {
      device.queue.writeBuffer(view, 0, new Float32Array([...matrix, isDark, 0, 0, 0]));
      pass.setPipeline(pipeline);
      pass.setBindGroup(0, bindings);
      pass.draw(3 * triangles);
    });
}
