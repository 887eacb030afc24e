// A terrain from a survey: a river and the shore of a lake become edges, judged from above: `npm run examples`, then open
// terrain.html. y is up, as in all of three.js, so the plane is xz.

import { regions } from 'edgeflip/files';
import { triangulate } from 'edgeflip/points';
import { delaunayGeometry } from 'edgeflip/three';
import {
  BufferAttribute,
  BufferGeometry,
  DirectionalLight,
  HemisphereLight,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  Scene,
  WebGPURenderer,
  WireframeGeometry,
} from 'three/webgpu';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const [button, state] = ['bring', 'state'].map((id) => document.getElementById(id));

const LAKE = { x: -0.3, z: 0.25, radius: 0.42, height: 0.05 };
const RIVER = 12;
const SHORE = 22;

/** Where the river is, from the lake to the border. */
const riverAt = (x) => LAKE.z + 0.15 * Math.sin(4 * (x - LAKE.x - LAKE.radius));

/** Hills that slope down to the water. */
function heightAt(x, z) {
  const toLake = Math.hypot(x - LAKE.x, z - LAKE.z) - LAKE.radius;
  const toRiver = x > LAKE.x ? Math.abs(z - riverAt(x)) : Infinity;
  const slope = Math.min(1, Math.max(0, Math.min(toLake, toRiver) / 0.5));
  const hills = 0.34 + 0.2 * Math.sin(3 * x + 1) * Math.cos(2.3 * z) + 0.04 * Math.sin(9 * x - 7 * z);
  return LAKE.height + slope ** 0.7 * (hills - LAKE.height);
}

// Scattered points, those of the border, and then those of the shore and of the river.
const points = [];
for (let i = 0; i < 1200; i++) {
  const [x, z] = [0.754877666, 0.569840296].map((step) => 2.4 * ((i * step) % 1) - 1.2);
  points.push([x, heightAt(x, z), z]);
}
for (let i = -1.2; i < 1.2; i += 0.1) {
  for (const [x, z] of [
    [i, -1.2],
    [1.2, i],
    [-i, 1.2],
    [-1.2, -i],
  ])
    points.push([x, heightAt(x, z), z]);
}
const shore = Array.from({ length: SHORE }, (_, i) => points.length + i);
for (let i = 0; i < SHORE; i++) {
  const angle = (2 * Math.PI * i) / SHORE;
  points.push([LAKE.x + LAKE.radius * Math.cos(angle), LAKE.height, LAKE.z + LAKE.radius * Math.sin(angle)]);
}
const river = Array.from({ length: RIVER }, (_, i) => points.length + i);
for (let i = 0; i < RIVER; i++) {
  const x = LAKE.x + LAKE.radius + ((1.2 - LAKE.x - LAKE.radius) * (i + 1)) / RIVER;
  points.push([x, LAKE.height, riverAt(x)]);
}
const lines = [
  ...shore.flatMap((vertex, i) => [vertex, shore[(i + 1) % SHORE]]),
  ...[shore[0], ...river].slice(1).flatMap((vertex, i) => [[shore[0], ...river][i], vertex]),
];

const geometry = new BufferGeometry();
geometry.setAttribute('position', new BufferAttribute(Float32Array.from(points.flat()), 3));
const { triangles } = await triangulate(points, { x: ([, , z]) => z, y: ([x]) => x });
geometry.setIndex(new BufferAttribute(triangles, 1));
geometry.computeVertexNormals();

const scene = new Scene();
const [land, water] = [0xb9b49a, 0x4a86b8].map(
  (color) =>
    new MeshStandardMaterial({ color, flatShading: true, polygonOffset: true, polygonOffsetFactor: 1, roughness: 1 }),
);
const edges = new LineSegments(new WireframeGeometry(geometry), new LineBasicMaterial({ color: 0x15171c }));
const waterLines = new BufferGeometry().setAttribute('position', geometry.attributes.position).setIndex(lines);
const banks = new LineSegments(waterLines, new LineBasicMaterial({ color: 0x2f8fff }));
banks.position.y = 0.004;
banks.visible = false;
const sun = new DirectionalLight(0xffffff, 3);
sun.position.set(-2, 1.2, 1);
scene.add(new Mesh(geometry, [land, water]), edges, banks, sun, new HemisphereLight(0xcfe3ff, 0x5a4a32, 1));
geometry.addGroup(0, Infinity, 0);

const camera = new PerspectiveCamera(40, 1, 0.1, 100);
camera.position.set(0.6, 1.9, 2.4);
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
  geometry.clearGroups();
  const { crossedEdges, flips } = await delaunayGeometry(geometry, { plane: 'xz', constraints: lines });
  // The triangles of the lake come last, and have a group of their own.
  const { array } = geometry.index;
  const mesh = { positions: geometry.attributes.position.array, indices: array, dimension: 2, plane: 'xz' };
  const { inside } = await regions(mesh, lines.slice(0, 2 * SHORE));
  const part = (isLake) => Array.from(array).filter((_, i) => Boolean(inside[Math.floor(i / 3)]) === isLake);
  const [dry, wet] = [part(false), part(true)];
  geometry.setIndex([...dry, ...wet]);
  geometry.addGroup(0, dry.length, 0);
  geometry.addGroup(dry.length, wet.length, 1);
  edges.geometry = new WireframeGeometry(geometry);
  banks.visible = true;
  draw();
  state.value = `${crossedEdges} edges made way for the water, ${flips} flips made the rest Delaunay; the lake has ${wet.length / 3} triangles`;
};
button.disabled = false;
