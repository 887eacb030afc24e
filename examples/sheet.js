// A sheet that the pointer twists and shears. A compute pass moves the vertices, an update flips the edges, and the
// frame is drawn from the same buffers: nothing travels to the CPU. `npm run examples`, then open sheet.html.

import { FlipSession } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { drawer } from './draw.js';
import { mover, play } from './move.js';

const [canvas, output] = ['canvas', 'output'].map((name) => document.querySelector(name));
const size = Number(new URLSearchParams(location.search).get('size') ?? 101);
const mesh = await generate(`random ${size}`);
const session = await FlipSession.create(mesh, { backend: 'webgpu' });
await session.run();
const gpu = await session.gpu();

const move = mover(
  gpu,
  mesh,
  `fn moved(rest: vec3f, numbers: vec4f) -> vec3f {
    let arm = rest.xy - 0.5;
    let angle = numbers.x * exp(-16 * dot(arm, arm));
    let turned = vec2f(cos(angle) * arm.x - sin(angle) * arm.y, sin(angle) * arm.x + cos(angle) * arm.y);
    return vec3f(turned.x + numbers.y * turned.y, turned.y, 0);
  }`,
);
const draw = drawer(canvas, gpu, 2, mesh.indices.length / 3);

/** The angle and the shear that the pointer asks for, and those of the sheet, which follow. */
let wanted;
const now = [0, 0];
canvas.onpointermove = ({ clientX, clientY }) => {
  wanted = [(6 * clientX) / innerWidth - 3, (2 * clientY) / innerHeight - 1];
};

function frame(time) {
  const [angle, shear] = wanted ?? [2.5 * Math.sin(0.7 * time), 0.6 * Math.sin(0.45 * time)];
  now[0] += 0.1 * (angle - now[0]);
  now[1] += 0.1 * (shear - now[1]);
  move([...now, 0, 0]);
  session.update();
  const scale = 1.3;
  const [x, y] =
    canvas.clientWidth > canvas.clientHeight
      ? [canvas.clientHeight / canvas.clientWidth, 1]
      : [1, canvas.clientWidth / canvas.clientHeight];
  draw([scale * x, 0, 0, 0, 0, scale * y, 0, 0, 0, 0, 1, 0, 0, 0, 0.5, 1]);
}

// For the tests: `?paused` draws no frame by itself.
globalThis.example = { session, mesh, frame };
if (!location.search.includes('paused')) play(session, output, frame);
