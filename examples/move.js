// A compute pass that moves the vertices of a session, and the loop that calls it in every frame.

/**
 * Returns a function that submits the pass with numbers for its uniform. `code` defines
 * `moved(rest: vec3f, numbers: vec4f) -> vec3f`.
 */
export function mover({ device, positions }, mesh, code) {
  const { dimension } = mesh;
  const module = device.createShaderModule({
    code: `
      @group(0) @binding(0) var<uniform> numbers: vec4f;
      @group(0) @binding(1) var<storage, read> rest: array<f32>;
      @group(0) @binding(2) var<storage, read_write> positions: array<f32>;
      ${code}
      @compute @workgroup_size(256)
      fn move_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
        for (var at = id.x * ${dimension}; at < ${mesh.positions.length}; at += groups.x * 256 * ${dimension}) {
          let point = moved(vec3f(rest[at], rest[at + 1], ${dimension === 3 ? 'rest[at + 2]' : '0'}), numbers);
          positions[at] = point.x;
          positions[at + 1] = point.y;
          ${dimension === 3 ? 'positions[at + 2] = point.z;' : ''}
        }
      }`,
  });
  const pipeline = device.createComputePipeline({ layout: 'auto', compute: { module } });
  const uniform = device.createBuffer({ size: 16, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
  const rest = device.createBuffer({
    size: mesh.positions.byteLength,
    usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST,
  });
  device.queue.writeBuffer(rest, 0, mesh.positions);
  const entries = [uniform, rest, positions].map((buffer, binding) => ({ binding, resource: { buffer } }));
  const bindings = device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries });
  return (numbers) => {
    device.queue.writeBuffer(uniform, 0, new Float32Array(numbers));
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, bindings);
    pass.dispatchWorkgroups(Math.min(Math.ceil(mesh.positions.length / dimension / 256), 65535));
    pass.end();
    device.queue.submit([encoder.finish()]);
  };
}

/**
 * Calls `frame` with the seconds since the start until the page is closed, and shows the counters once a second. `more`
 * may add to their text.
 */
export function play(session, output, frame, more = () => '') {
  const start = performance.now();
  let [frames, last, flipped, isAsked] = [0, start, 0, false];
  const show = async (count, seconds) => {
    const counters = await session.counters();
    const each = Math.round((counters.flips - flipped) / count);
    flipped = counters.flips;
    const left = counters.remaining.stopped ?? 0;
    const added = await more(counters);
    output.value = `${(count / seconds).toFixed(0)} frames a second, ${each} flips a frame, ${left} edges left${added}`;
    isAsked = false;
  };
  const next = (now) => {
    frame((now - start) / 1000);
    frames++;
    if (now - last > 1000 && !isAsked) {
      isAsked = true;
      show(frames, (now - last) / 1000).catch((error) => (output.value = error.message));
      [frames, last] = [0, now];
    }
    requestAnimationFrame(next);
  };
  requestAnimationFrame(next);
}
