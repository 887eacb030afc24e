// A geometry becomes Delaunay on the device of the renderer that draws it: `npm run examples`, then open three.html.

import { delaunayGeometry } from 'edgeflip/three';
import {
  BufferAttribute,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshNormalMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  WebGPURenderer,
  WireframeGeometry,
} from 'three/webgpu';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const [button, state] = ['flip', 'state'].map((id) => document.getElementById(id));

// A sheet that is sheared and bent, so that its triangles are thin.
const geometry = new PlaneGeometry(2, 2, 40, 40);
const { position } = geometry.attributes;
for (let i = 0; i < position.count; i++) {
  const [x, y] = [position.getX(i), position.getY(i)];
  position.setXYZ(i, x + 1.5 * y, y, 0.3 * Math.sin(3 * x) * Math.cos(2 * y));
}

const scene = new Scene();
const material = new MeshNormalMaterial({ flatShading: true, polygonOffset: true, polygonOffsetFactor: 1 });
// The edges are lines over the sheet.
const edges = new LineSegments(new WireframeGeometry(geometry), new LineBasicMaterial({ color: 0x15171c }));
scene.add(new Mesh(geometry, material), edges);
const camera = new PerspectiveCamera(40, 1, 0.1, 100);
camera.position.set(0, -2, 5);
const renderer = new WebGPURenderer({ antialias: true });
document.body.append(renderer.domElement);
const controls = new OrbitControls(camera, renderer.domElement);
const draw = () => renderer.render(scene, camera);
const resize = () => {
  camera.aspect = innerWidth / innerHeight;
  camera.updateProjectionMatrix();
  renderer.setSize(innerWidth, innerHeight);
  draw();
};
await renderer.init();
controls.addEventListener('change', draw);
addEventListener('resize', resize);
resize();

button.onclick = async () => {
  button.disabled = true;
  const { flips, backend, session } = await delaunayGeometry(geometry, { renderer, maxNormalAngle: 40 });
  // The triangles of a session are on the GPU.
  const flipped = geometry.clone();
  if (session) flipped.setIndex(new BufferAttribute(await session.triangles(), 1));
  edges.geometry = new WireframeGeometry(flipped);
  draw();
  state.value = `${flips} flips on ${backend}`;
};
button.disabled = false;
