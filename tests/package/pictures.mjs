// Draws textured surfaces in Node: a rasterizer with perspective, a depth buffer, and a bilinear texture without light.
// Compares two pictures where the surface does not end.

/** Pixels of a row of a picture. Each is the mean of four samples. */
const SIZE = 384;
const SAMPLES = 2 * SIZE;

/** Texels of a row of a texture. */
const TEXELS = 1024;

/** A hash of whole numbers, from 0 to 1. */
const random = (x, y, seed) => {
  const hash = Math.imul(Math.imul(x, 374761393) ^ Math.imul(y, 668265263) ^ Math.imul(seed, 974711), 1274126177);
  return ((hash ^ (hash >>> 15)) >>> 0) / 2 ** 32;
};

/** Smooth noise that repeats: a random number in each cell of `size` texels, and smooth between their centres. */
function noise(x, y, size, seed) {
  const cells = TEXELS / size;
  const [left, top] = [Math.floor(x / size), Math.floor(y / size)];
  const [s, t] = [x / size - left, y / size - top].map((share) => share * share * (3 - 2 * share));
  const at = (dx, dy) => random((left + dx) % cells, (top + dy) % cells, seed);
  return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
}

/** A texture that repeats, in levels: noise of several sizes, and dark lines every 64 texels with soft borders. */
export function texture(seed = 1) {
  const texels = new Float32Array(3 * TEXELS * TEXELS);
  const line = (x) => Math.exp(-(((x % 64) - 32) ** 2) / 18);
  for (let y = 0; y < TEXELS; y++) {
    for (let x = 0; x < TEXELS; x++) {
      const dark = 80 * Math.max(line(x), line(y));
      for (let k = 0; k < 3; k++) {
        const [wide, narrow] = [128, 32].map((size) => noise(x, y, size, seed + size + k));
        texels[3 * (TEXELS * y + x) + k] = 85 + 110 * wide + 60 * narrow - dark;
      }
    }
  }
  return levelsOf(texels);
}

function sample(texels, size, u, v, to, at) {
  const [x, y] = [u * size - 0.5, v * size - 0.5];
  const [left, top] = [Math.floor(x), Math.floor(y)];
  const [s, t] = [x - left, y - top];
  const wrap = (i) => i & (size - 1);
  for (let k = 0; k < 3; k++) {
    const texel = (dx, dy) => texels[3 * (size * wrap(top + dy) + wrap(left + dx)) + k];
    to[at + k] = (1 - t) * ((1 - s) * texel(0, 0) + s * texel(1, 0)) + t * ((1 - s) * texel(0, 1) + s * texel(1, 1));
  }
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
const unit = (a) => a.map((x) => x / Math.sqrt(dot(a, a)));

/** Where a camera outside sees the vertices: x and y in samples, and the depth, 3 numbers per vertex. */
function seen(positions, direction) {
  const [low, high] = [Math.min, Math.max].map((of) =>
    [0, 1, 2].map((axis) => {
      let end = positions[axis];
      for (let i = axis; i < positions.length; i += 3) end = of(end, positions[i]);
      return end;
    }),
  );
  const centre = low.map((x, axis) => (x + high[axis]) / 2);
  const radius = Math.hypot(...low.map((x, axis) => high[axis] - x)) / 2;
  const back = unit(direction);
  const right = unit(cross([0, 1, 0.001], back));
  const up = cross(back, right);
  const distance = 4 * radius;
  const places = new Float64Array(positions.length);
  for (let i = 0; i < positions.length; i += 3) {
    const p = [0, 1, 2].map((axis) => positions[i + axis] - centre[axis]);
    const depth = distance - dot(p, back);
    places.set([dot(p, right) / depth, -dot(p, up) / depth, depth], i);
  }
  // The surface fills the picture.
  const ends = [0, 1].map((axis) => {
    const all = places.filter((_, i) => i % 3 === axis);
    return [all.reduce((x, y) => Math.min(x, y)), all.reduce((x, y) => Math.max(x, y))];
  });
  const scale = (0.94 * SAMPLES) / Math.max(...ends.map(([low, high]) => high - low));
  for (let i = 0; i < places.length; i++) {
    if (i % 3 < 2) places[i] = SAMPLES / 2 + scale * (places[i] - (ends[i % 3][0] + ends[i % 3][1]) / 2);
  }
  return { places, radius };
}

/** The levels of a texture: each has half as many texels in a row as the one before. */
function levelsOf(texels) {
  const levels = [texels];
  for (let size = TEXELS / 2; size >= 8; size /= 2) {
    const last = levels.at(-1);
    levels.push(
      Float32Array.from({ length: 3 * size * size }, (_, i) => {
        const [x, y, k] = [Math.floor(i / 3) % size, Math.floor(i / 3 / size), i % 3];
        const at = (dx, dy) => last[3 * (2 * size * (2 * y + dy) + 2 * x + dx) + k];
        return (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4;
      }),
    );
  }
  return levels;
}

/** The level whose texels are as large as the samples, for most of the triangles: as a GPU chooses it for each pixel. */
function levelOf({ uvs, indices }, places) {
  const area = (array, step, i) => {
    const [[ax, ay], [bx, by], [cx, cy]] = [0, 1, 2].map((k) =>
      [0, 1].map((axis) => array[step * indices[i + k] + axis]),
    );
    return Math.abs((bx - ax) * (cy - ay) - (cx - ax) * (by - ay));
  };
  const ratios = [];
  for (let i = 0; i < indices.length; i += 3) {
    const [texels, samples] = [TEXELS ** 2 * area(uvs, 2, i), area(places, 3, i)];
    if (samples > 0) ratios.push([texels / samples, samples]);
  }
  ratios.sort(([a], [b]) => a - b);
  const half = ratios.reduce((sum, [, samples]) => sum + samples, 0) / 2;
  let sum = 0;
  const [ratio] = ratios.find(([, samples]) => (sum += samples) >= half);
  return Math.min(7, Math.max(0, Math.round(Math.log2(ratio) / 2)));
}

/**
 * A picture of a surface with `positions`, `uvs` and `indices`: red, green and blue of each pixel, and where the surface
 * ends, at its silhouette or at an edge that hides a part of it.
 */
export function picture(surface, levels, given, direction = [0.6, 0.5, 1]) {
  const { positions, uvs, indices } = surface;
  const { places, radius } = seen(positions, direction);
  const level = given ?? levelOf(surface, places);
  const depths = new Float64Array(SAMPLES * SAMPLES).fill(Infinity);
  const colours = new Float32Array(3 * SAMPLES * SAMPLES).fill(255);
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => indices[i + k]);
    const [ax, ay, bx, by, cx, cy] = [a, b, c].flatMap((v) => [places[3 * v], places[3 * v + 1]]);
    const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
    if (!(Math.abs(area) > 0)) continue;
    const [wa, wb, wc] = [a, b, c].map((v) => 1 / places[3 * v + 2]);
    const rows = [
      Math.max(0, Math.ceil(Math.min(ay, by, cy))),
      Math.min(SAMPLES - 1, Math.floor(Math.max(ay, by, cy))),
    ];
    const columns = [
      Math.max(0, Math.ceil(Math.min(ax, bx, cx))),
      Math.min(SAMPLES - 1, Math.floor(Math.max(ax, bx, cx))),
    ];
    for (let y = rows[0]; y <= rows[1]; y++) {
      for (let x = columns[0]; x <= columns[1]; x++) {
        const s = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area;
        const t = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area;
        if (s < 0 || t < 0 || s + t > 1) continue;
        const [pa, pb, pc] = [(1 - s - t) * wa, s * wb, t * wc];
        const w = pa + pb + pc;
        if (1 / w >= depths[SAMPLES * y + x]) continue;
        depths[SAMPLES * y + x] = 1 / w;
        const [u, v] = [0, 1].map((k) => (pa * uvs[2 * a + k] + pb * uvs[2 * b + k] + pc * uvs[2 * c + k]) / w);
        sample(levels[level], TEXELS >> level, u, v, colours, 3 * (SAMPLES * y + x));
      }
    }
  }
  return { ...shrunk(colours), level, ends: endsOf(depths, radius) };
}

function shrunk(colours) {
  const pixels = new Float32Array(3 * SIZE * SIZE);
  for (let y = 0; y < SAMPLES; y++) {
    for (let x = 0; x < SAMPLES; x++) {
      for (let k = 0; k < 3; k++) {
        pixels[3 * (SIZE * (y >> 1) + (x >> 1)) + k] += colours[3 * (SAMPLES * y + x) + k] / 4;
      }
    }
  }
  return { pixels };
}

/** 1 for each pixel at most two pixels from a jump of the depth, or from the background, or in it. */
function endsOf(depths, radius) {
  const ends = new Uint8Array(SIZE * SIZE);
  for (let y = 0; y < SAMPLES; y++) {
    for (let x = 0; x < SAMPLES; x++) {
      const depth = depths[SAMPLES * y + x];
      const isEnd = [x + 1 < SAMPLES && SAMPLES * y + x + 1, y + 1 < SAMPLES && SAMPLES * (y + 1) + x].some(
        (other) => other === false || !(Math.abs(depths[other] - depth) < 0.03 * radius),
      );
      if (!isEnd) continue;
      for (let dy = -2; dy <= 2; dy++) {
        for (let dx = -2; dx <= 2; dx++) {
          const [i, j] = [(x >> 1) + dx, (y >> 1) + dy];
          if (i >= 0 && j >= 0 && i < SIZE && j < SIZE) ends[SIZE * j + i] = 1;
        }
      }
    }
  }
  return ends;
}

/** How many pixels both pictures show of the surface, and how many of them differ by more than 8 of 255. */
export function compare(before, after) {
  let [count, differing] = [0, 0];
  for (let i = 0; i < SIZE * SIZE; i++) {
    if (before.ends[i] || after.ends[i]) continue;
    count += 1;
    if ([0, 1, 2].some((k) => Math.abs(before.pixels[3 * i + k] - after.pixels[3 * i + k]) > 8)) differing += 1;
  }
  return { count, differing };
}
