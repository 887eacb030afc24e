// Writes the meshes that the page offers and that no family generates, from packages with free licences.

import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import suzi from '@pmndrs/assets/models/suzi.glb.js';
import bunny from 'bunny';
import draco from 'draco3dgltf';
import initManifold from 'manifold-3d';
import { MeshoptSimplifier } from 'meshoptimizer';
import { createNoise2D } from 'simplex-noise';
import { generate, readMesh, writeMesh } from '../../dist/files.js';
import { makeDelaunay } from '../../dist/index.js';
import { triangulate } from '../../dist/points.js';
import { MOVING, SAMPLES, sunflower } from './samples.js';
import { scrambled } from './scramble.js';
import { wireframe } from './wireframe.js';

/** The scan of a rabbit: package `bunny`, public domain, from the Stanford 3D Scanning Repository. */
function rabbit() {
  const mesh = { positions: Float32Array.from(bunny.positions.flat()), indices: bunny.cells.flat(), dimension: 3 };
  return writeMesh({ ...mesh, indices: scrambled(mesh, 2500, 25, 3) }, 'bunny.ply');
}

/** A part made by cutting solids, with a material for each: package `manifold-3d`, Apache-2.0. */
async function flange() {
  const manifold = await initManifold();
  manifold.setup();
  const { Manifold } = manifold;
  const rod = (height, radius, sides) => Manifold.cylinder(height, radius, radius, sides, true);
  const solids = { disc: rod(0.24, 1, 72), neck: rod(0.9, 0.52, 64), bore: rod(3, 0.36, 56), bolt: rod(1, 0.11, 24) };
  const bolts = Array.from({ length: 8 }, (_, i) => {
    const angle = (2 * Math.PI * (i + 0.5)) / 8;
    return solids.bolt.translate([0.77 * Math.cos(angle), 0.77 * Math.sin(angle), 0]);
  });
  const body = solids.disc.add(solids.neck.translate([0, 0, 0.4]));
  const part = [solids.bore, ...bolts].reduce((solid, hole) => solid.subtract(hole), body);
  // The axis points up.
  const { vertProperties, triVerts, numProp, runIndex, runOriginalID } = part.rotate([-90, 0, 0]).getMesh();
  const lines = [];
  for (let at = 0; at < vertProperties.length; at += numProp) {
    lines.push(`v ${vertProperties.slice(at, at + 3).join(' ')}`);
  }
  for (const [name, solid] of Object.entries(solids)) {
    lines.push(`usemtl ${name}`);
    for (const run of runOriginalID.keys()) {
      if (runOriginalID[run] !== solid.originalID()) continue;
      for (let at = runIndex[run]; at < runIndex[run + 1]; at += 3) {
        lines.push(
          `f ${triVerts
            .slice(at, at + 3)
            .map((v) => v + 1)
            .join(' ')}`,
        );
      }
    }
  }
  return Buffer.from(`${lines.join('\n')}\n`);
}

/** Numbers from 0 to 1 that are the same in each build. */
function dice(seed) {
  let state = seed;
  return () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

/** The colours of a terrain by height, from 0 to 1: meadows, rock, and snow. */
const TINTS = [
  [0, [0.62, 0.74, 0.56]],
  [0.35, [0.8, 0.79, 0.62]],
  [0.7, [0.76, 0.72, 0.68]],
  [1, [0.97, 0.97, 0.97]],
];
const WATER = [0.42, 0.65, 0.86];

/**
 * A ridge and a river on a grid that is bent along both: noise of the package `simplex-noise`, MIT. The sides of the
 * ridge, the river and the plain are materials, so their borders are locked. The other edges are scrambled.
 */
async function terrain() {
  const noise = createNoise2D(dice(7));
  const random = dice(3);
  const [side, crest, [bank, shore], width] = [52, 17, [36, 38], 0.085];
  // Where the crest and the middle of the river are, from left to right.
  const ridgeAt = (x) => -0.4 + 0.12 * Math.sin(2.4 * x + 0.7) + 0.04 * Math.sin(6 * x);
  const riverAt = (x) => 0.4 + 0.15 * Math.sin(2.9 * x - 0.4) + 0.04 * Math.sin(8 * x);
  const distances = (x, z) => [Math.abs(z - ridgeAt(x)), Math.max(0, Math.abs(z - riverAt(x)) - width / 2)];
  // The rows of the grid that follow a line, and the lines; the others lie evenly between these.
  const lines = [
    [0, () => -1],
    [crest, ridgeAt],
    [bank, (x) => riverAt(x) - width / 2],
    [shore, (x) => riverAt(x) + width / 2],
    [side, () => 1],
  ];
  const depthAt = (row, x) => {
    const k = Math.max(
      1,
      lines.findIndex(([last]) => row <= last),
    );
    const [[from, start], [to, end]] = [lines[k - 1], lines[k]];
    return start(x) + ((row - from) / (to - from)) * (end(x) - start(x));
  };
  const heightAt = (x, z) => {
    const [far, dry] = distances(x, z);
    const top = 0.5 + 0.14 * noise(1.7 * x, 9) + 0.04 * noise(7 * x, 5);
    const spurs = 0.3 * (0.5 - Math.abs(noise(2.3 * x, 1.1 * z))) * far * Math.exp(-far / 0.35);
    const hills = 0.1 * (1 + noise(1.5 * x + 4, 1.5 * z)) + 0.015 * noise(5 * x, 5 * z);
    const valley = Math.min(1, dry / 0.55);
    return -0.02 * x + 0.03 * (1 - Math.exp(-dry / 0.03)) + valley * (top * Math.exp(-far / 0.27) + 3 * spurs + hills);
  };
  const [text, plan] = [[], []];
  for (let j = 0; j <= side; j++) {
    const isLine = lines.some(([row]) => row === j);
    for (let i = 0; i <= side; i++) {
      const away = () => 0.7 * (random() - 0.5);
      const x = (2 * (i + (i % side === 0 ? 0 : away()))) / side - 1;
      const z = depthAt(j + (isLine ? 0 : away()), x);
      const y = heightAt(x, z);
      const colour = j >= bank && j <= shore ? WATER : tintAt(y / 0.62);
      text.push(
        `v ${[x, y, z].map((at) => at.toFixed(4)).join(' ')} ${colour.map((part) => part.toFixed(2)).join(' ')}`,
      );
      plan.push(z, x);
    }
  }
  const materials = ['north', 'south', 'river', 'plain'];
  const [indices, groups] = [[], []];
  for (let j = 0; j < side; j++) {
    for (let i = 0; i < side; i++) {
      const [a, c] = [j * (side + 1) + i, (j + 1) * (side + 1) + i];
      indices.push(a, c, c + 1, a, c + 1, a + 1);
      const group = [crest, bank, shore].filter((row) => row <= j).length;
      groups.push(group, group);
    }
  }
  const mesh = { positions: plan, indices, dimension: 2 };
  const { indices: best } = await makeDelaunay(mesh, { groups, backend: 'cpu' });
  const triangles = scrambled({ ...mesh, indices: best, groups }, 1200, 10, 3);
  for (const [group, name] of materials.entries()) {
    text.push(`usemtl ${name}`);
    for (const [t, its] of groups.entries()) {
      if (its === group) text.push(`f ${[...triangles.slice(3 * t, 3 * t + 3)].map((v) => v + 1).join(' ')}`);
    }
  }
  return Buffer.from(`${text.join('\n')}\n`);
}

/** The colour at a height from 0 to 1, between those of {@link TINTS}. */
function tintAt(height) {
  const at = Math.min(1, Math.max(0, height));
  const k = Math.max(
    1,
    TINTS.findIndex(([least]) => at <= least),
  );
  const [[from, low], [to, high]] = [TINTS[k - 1], TINTS[k]];
  return low.map((part, channel) => part + ((at - from) / (to - from)) * (high[channel] - part));
}

/** A head by the Blender project, subdivided: package `@pmndrs/assets`, CC0. Without compression, as edgeflip reads it. */
async function head() {
  const io = new NodeIO()
    .registerExtensions(ALL_EXTENSIONS)
    .registerDependencies({ 'draco3d.decoder': await draco.createDecoderModule() });
  const file = await io.readBinary(Buffer.from(suzi.split(',')[1], 'base64'));
  for (const extension of file.getRoot().listExtensionsUsed()) extension.dispose();
  const [primitive] = file.getRoot().listMeshes()[0].listPrimitives();
  const [positions, indices] = [primitive.getAttribute('POSITION').getArray(), primitive.getIndices().getArray()];
  primitive.getIndices().setArray(scrambled({ positions, indices }, 6000, 12, 5));
  return io.writeBinary(file);
}

/** The most triangles of a surface in a thumbnail; those of a terrain are all seen, from further above. */
const [DRAWN, FEW, ABOVE] = [1200, 420, 0.62];

const FILES = { 'bunny.ply': rabbit, 'flange.obj': flange, 'terrain.obj': terrain, 'suzi.glb': head };

/** Writes the files into `models/` and the thumbnails of all samples into `thumbs/`. */
export async function writeModels(folder) {
  for (const name of ['models', 'thumbs']) mkdirSync(join(folder, name), { recursive: true });
  const meshes = new Map();
  for (const [name, make] of Object.entries(FILES)) {
    const bytes = await make();
    writeFileSync(join(folder, 'models', name), bytes);
    meshes.set(`models/${name}`, await readMesh(bytes, name));
  }
  for (const { spec, thumb, drawn = spec, plane } of SAMPLES) {
    const mesh = meshes.get(drawn) ?? (await generate(drawn));
    const picture = plane ? wireframe(await coarse(mesh, FEW), ABOVE) : wireframe(await coarse(mesh));
    writeFileSync(join(folder, thumb), picture);
  }
  for (const { thumb, drawn, warp } of MOVING) {
    const mesh = drawn ? warped(await generate(drawn), warp) : await seeds();
    writeFileSync(join(folder, thumb), wireframe(mesh));
  }
}

/** The points that move freely, fewer of them. */
async function seeds() {
  const positions = sunflower(70);
  return { positions, indices: (await triangulate(positions)).triangles, dimension: 2 };
}

function warped({ positions, indices, dimension }, warp) {
  const vertices = Array.from({ length: positions.length / dimension }, (_, v) =>
    warp([...positions.slice(dimension * v, dimension * (v + 1))]),
  );
  return { positions: vertices.flat(), indices, dimension };
}

/** The mesh with few enough triangles for a thumbnail. */
async function coarse(mesh, most = DRAWN) {
  if (mesh.dimension === 2 || mesh.indices.length <= 3 * most) return mesh;
  await MeshoptSimplifier.ready;
  const [indices] = MeshoptSimplifier.simplify(mesh.indices, Float32Array.from(mesh.positions), 3, 3 * most, 1);
  return { ...mesh, indices };
}
