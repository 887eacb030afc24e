// A sphere whose rings swell and shrink. A compute pass moves the vertices, an update flips the edges, and the frame is
// drawn from the same buffers: nothing travels to the CPU. `npm run examples`, then open waves.html.

import { FlipSession } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { Matrix4, PerspectiveCamera, Vector3 } from 'three';
import { drawer } from './draw.js';
import { mover, play } from './move.js';

const [canvas, output] = ['canvas', 'output'].map((name) => document.querySelector(name));
const size = Number(new URLSearchParams(location.search).get('size') ?? 100);
const mesh = await generate(`uvsphere ${size}`);
const session = await FlipSession.create(mesh, { backend: 'webgpu', maxNormalAngle: 30 });
await session.run();
const gpu = await session.gpu();
const move = mover(
  gpu,
  mesh,
  `fn moved(rest: vec3f, numbers: vec4f) -> vec3f {
    let wave = 0.25 * sin(6 * rest.z + numbers.x) * (1 - rest.z * rest.z);
    return vec3f(rest.xy * (1 + wave), rest.z * (1 + 0.1 * sin(0.5 * numbers.x)));
  }`,
);
const draw = drawer(canvas, gpu, 3, mesh.indices.length / 3);

// From clip coordinates of WebGL to those of WebGPU.
const depth = new Matrix4().set(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5, 0.5, 0, 0, 0, 1);
const camera = new PerspectiveCamera(40, 1, 0.1, 20);
camera.up = new Vector3(0, 0, 1);
let [turn, lift] = [0.6, 0.5];
canvas.onpointermove = ({ buttons, movementX, movementY }) => {
  if (buttons === 0) return;
  turn -= movementX / 200;
  lift = Math.max(-1.4, Math.min(1.4, lift + movementY / 200));
};

function frame(time) {
  move([2 * time, 0, 0, 0]);
  session.update();
  camera.aspect = canvas.clientWidth / canvas.clientHeight;
  camera.position.set(Math.cos(turn) * Math.cos(lift), Math.sin(turn) * Math.cos(lift), Math.sin(lift));
  camera.position.multiplyScalar(4 * Math.max(1, 1 / camera.aspect));
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  camera.updateProjectionMatrix();
  draw(new Matrix4().multiplyMatrices(depth, camera.projectionMatrix).multiply(camera.matrixWorldInverse).elements);
}

// For the tests: `?paused` draws no frame by itself.
globalThis.example = { session, mesh, frame };
if (!location.search.includes('paused')) play(session, output, frame);
