// Tests the entry `edgeflip/files` of the npm package in Node: files, generated meshes, measures.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { gunzipSync, gzipSync } from 'node:zlib';
import { makeDelaunay } from 'edgeflip';
import {
  angles,
  change,
  measures,
  reorient,
  EdgeflipError,
  FORMATS,
  generate,
  init,
  POINT_FORMATS,
  readMesh,
  writeMesh,
} from 'edgeflip/files';
import { triangulate } from 'edgeflip/points';

const bytes = (text) => new TextEncoder().encode(text);
const text = (bytes) => new TextDecoder().decode(bytes);
/** The bits of the positions, so that -0 and 0 differ. */
const bits = ({ positions }) => new Uint32Array(positions.buffer, positions.byteOffset, positions.length);

const refused = (code, pattern) => (error) => {
  assert.ok(error instanceof EdgeflipError && error instanceof Error, String(error));
  assert.equal(error.code, code, error.message);
  assert.match(error.message, pattern);
  return true;
};

/** FNV-1a with 64 bits. */
const digest = (bytes) =>
  bytes
    .reduce((hash, byte) => BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n), 0xcbf29ce484222325n)
    .toString(16)
    .padStart(16, '0');

/** Five vertices with numbers that are hard to write exactly. */
const awkward = () => ({
  positions: new Float32Array([1e-45, -0, 0.1, 3.4028235e38, -1.1754942e-38, 16777217, 1 / 3, -1e30, 0.3, 2 ** -126]),
  indices: new Uint32Array([0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1]),
  dimension: 2,
});

test('a module that cannot be loaded is an error, and the next call tries again', async () => {
  await assert.rejects(init({ files: bytes('no module') }), refused('load-failed', /could not be loaded/));
  await assert.rejects(
    init({ base: new URL('nowhere', import.meta.url) }),
    refused('load-failed', /ENOENT.*nowhere.edgeflip_files_bg\.wasm/),
  );
  await assert.rejects(
    init({ core: bytes('no module') }),
    refused('invalid-option', /^core is not an option; there are base, files$/),
  );
  await assert.rejects(
    init(new URL('https://example.org/a.wasm')),
    refused('invalid-input', /^name the module of a source: init\(\{ files: … \}\)$/),
  );
  await init({ base: new URL('../../dist/wasm', import.meta.url).href });
  await init({ files: 'https://example.org/not-looked-at.wasm' });
});

/** The fields of a file without notes. */
const FREE = { attributeEdges: [], groups: undefined, lockedEdges: undefined, lockedTriangles: undefined };
const PLAIN = { polygons: 0, crossing: undefined, dropped: [], keeps: true, notes: [], placed: undefined, ...FREE };

test('every format keeps every bit, in both dimensions', async () => {
  const flat = awkward();
  const raised = {
    positions: new Float32Array([...flat.positions, 7.5, -0]),
    indices: Uint32Array.of(0, 1, 2, 3, 2, 1),
    dimension: 3,
  };
  for (const mesh of [flat, raised]) {
    for (const format of [...FORMATS, '.ply.gz'].filter((format) => format !== '.stl')) {
      const file = await writeMesh(mesh, `a${format.toUpperCase()}`);
      const read = await readMesh(file, `a${format}`, { dimension: mesh.dimension });
      assert.deepEqual(bits(read), bits(mesh));
      const { placed } = read;
      assert.deepEqual(read, { ...mesh, ...PLAIN, placed });
      assert.equal(placed?.length, format.startsWith('.gl') ? (3 * mesh.positions.length) / mesh.dimension : undefined);
      assert.deepEqual(await writeMesh(read, `b${format}`), file);
    }
  }
});

test('doubles are written with all digits', async () => {
  const positions = Float64Array.of(0.1, 1e300, 12_000_000.000_001, -0, 5e-324, 1 / 3);
  const mesh = { positions, indices: Uint32Array.of(0, 1, 2), dimension: 2 };
  const lines = ['0.1 1e+300 0', '12000000.000001 -0 0', '5e-324 0.3333333333333333 0'];
  assert.equal(text(await writeMesh(mesh, 'a.off')), `OFF\n3 1 0\n${lines.join('\n')}\n3 0 1 2\n`);
  assert.equal(text(await writeMesh(mesh, 'a.obj')), `${lines.map((line) => `v ${line}\n`).join('')}f 1 2 3\n`);
  const { min } = await angles({ ...mesh, positions: Float64Array.of(0, 0, 1e-300, 0, 0, 1e-300) });
  assert.ok(Math.abs(min - 45) < 1e-12);
});

test('a PLY file keeps doubles, and an STL file joins equal corners', async () => {
  const positions = Float64Array.of(0.1, 1e300, 12_000_000.000_001, -0, 5e-324, 1 / 3);
  const mesh = { positions, indices: Uint32Array.of(0, 1, 2), dimension: 2 };
  for (const name of ['a.ply', 'a.ply.gz']) {
    assert.deepEqual(await readMesh(await writeMesh(mesh, name), name), { ...mesh, ...PLAIN });
  }
  await assert.rejects(writeMesh(mesh, 'a.stl'), refused('io', /^a\.stl: vertex 0 is too far away/));
  const near = {
    ...mesh,
    positions: Float64Array.of(5, 6, 0.1, 0, 1, 0, 0, 1),
    indices: Uint32Array.of(1, 2, 3, 3, 2, 1),
  };
  for (const name of ['a.stl', 'a.stl.gz']) {
    const read = await readMesh(await writeMesh(near, name), name);
    const corners = { positions: Float32Array.of(0.1, 0, 1, 0, 0, 1), indices: Uint32Array.of(0, 1, 2, 2, 1, 0) };
    assert.deepEqual(read, { ...corners, dimension: 2, ...PLAIN });
  }
});

test('gzip is recognized by its bytes, and the limit applies to the unpacked file', async () => {
  const thin = bytes(`OFF 3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n${' '.repeat(100)}`);
  const packed = new Uint8Array(gzipSync(thin));
  const mesh = await readMesh(thin, 'a.off');
  for (const name of ['a.off', 'a.off.gz']) {
    assert.deepEqual(await readMesh(packed, name), mesh);
    assert.deepEqual(await readMesh(packed, name, { maxBytes: thin.length }), mesh);
    assert.deepEqual(await readMesh(packed, name, { maxBytes: Infinity }), mesh);
  }
  assert.deepEqual(new Uint8Array(gunzipSync(await writeMesh(mesh, 'a.stl.gz'))), await writeMesh(mesh, 'a.stl'));
  const limit = { maxBytes: thin.length - 1 };
  for (const file of [thin, packed, new Uint8Array(gzipSync(new Uint8Array(1 << 26)))]) {
    await assert.rejects(
      readMesh(file, 'a.off', limit),
      refused('file-too-large', /more than 133 bytes, packed or unpacked; maxBytes sets/),
    );
  }
  await assert.rejects(
    readMesh(packed.subarray(0, -1), 'a.off'),
    refused('parse', /^byte \d+: the gzip'd file is cut off/),
  );
  await assert.rejects(
    readMesh(thin, 'a.off', { maxBytes: -1 }),
    refused('invalid-option', /maxBytes: -1 is not a size in bytes/),
  );
  await assert.rejects(readMesh(thin, 'a.off', { maxBytes: '9' }), refused('invalid-input', /maxBytes/));
});

test('a mesh from a file can be flipped, and arguments stay unchanged', async () => {
  const thin = 'OFF\n4 2 0\n-3 0 0\n0 -1 0\n3 0 0\n0 1 0\n3 0 1 2\n3 0 2 3\n';
  const file = bytes(thin);
  const mesh = await readMesh(file, 'thin.off');
  assert.equal(mesh.dimension, 2);
  const { indices } = await makeDelaunay(mesh);
  assert.equal(
    text(await writeMesh({ ...mesh, indices }, 'out.obj')),
    'v -3 0 0\nv 0 -1 0\nv 3 0 0\nv 0 1 0\nf 4 2 3\nf 1 2 4\n',
  );
  assert.equal(text(file), thin);
  assert.equal(text(await writeMesh(mesh, 'same.off')), thin);
});

test('polygons of an OBJ file become triangles, and `dropped` names lost contents', async () => {
  const file = bytes(
    'o house\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 3 1\nv 0 2 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1 5//1\nf -1 -2 -3\n',
  );
  const mesh = await readMesh(file, 'house.obj');
  assert.equal(mesh.dimension, 3);
  assert.deepEqual([...mesh.indices], [0, 1, 2, 0, 2, 3, 0, 3, 4, 4, 3, 2]);
  assert.equal(mesh.polygons, 1);
  assert.deepEqual(mesh.dropped, ['groups, objects and materials', 'normals']);
  // An L, whose fan around its first corner leaves it, and a bow tie.
  const dent = await readMesh(
    bytes('v 6 0 0\nv 6 1 0\nv 1 1 0\nv 1 6 0\nv 0 6 0\nv 0 0 0\nf 1 2 3 4 5 6\nf 1 2 6 3\n'),
    'dent.obj',
  );
  const area = dent.indices.slice(0, 12).reduce((sum, v, i, all) => {
    const w = all[i % 3 === 2 ? i - 2 : i + 1];
    return (
      sum + (dent.positions[2 * v] * dent.positions[2 * w + 1] - dent.positions[2 * v + 1] * dent.positions[2 * w]) / 2
    );
  }, 0);
  assert.deepEqual([area, dent.polygons, dent.crossing], [11, 2, Uint32Array.of(1)]);
});

test('the digits of a text decide between 32 and 64 bits, or `coordinates` does', async () => {
  const file = (x) => bytes(`v 0 0 0\nv ${x} 0 0\nv 0 1 0\nf 1 2 3\n`);
  const read = async (x, options) => (await readMesh(file(x), 'a.obj', options)).positions;
  assert.deepEqual(await read('0.1'), Float32Array.of(0, 0, 0.1, 0, 0, 1));
  assert.deepEqual(await read('4649776.51'), Float64Array.of(0, 0, 4649776.51, 0, 0, 1));
  assert.deepEqual(await read('4649776.51', { coordinates: 32 }), Float32Array.of(0, 0, 4649776.51, 0, 0, 1));
  assert.deepEqual(await read('0.1', { coordinates: 64 }), Float64Array.of(0, 0, 0.1, 0, 0, 1));
  await assert.rejects(read('1', { coordinates: 16 }), refused('invalid-input', /^coordinates: 16 is not 32 or 64$/));
  const original = { bytes: file('0.1'), name: 'a.obj', coordinates: 64 };
  const mesh = await readMesh(original.bytes, 'a.obj', { coordinates: 64 });
  assert.deepEqual(await writeMesh(mesh, 'b.obj', { original }), original.bytes);
});

test('with `original`, a file is written with other triangles and is otherwise unchanged', async () => {
  const points =
    '# by hand\r\nv 0 0 0\r\nv 0.90000000001 0.2 0\r\nv 1 1 0\r\nv 0 1 0\r\nv 0.5 -9 0\r\nvt 0 0\r\nvt 1 1\r\n';
  const original = {
    bytes: bytes(`${points}usemtl a\r\nf 1/1 2/1 3/1 4/1\r\nusemtl b\r\nf 2/2 1/2 5/2\r\n`),
    name: 'a.obj',
  };
  const mesh = await readMesh(original.bytes, original.name);
  const { groups, lockedEdges, lockedTriangles, keeps } = mesh;
  assert.deepEqual(
    [groups, lockedEdges, lockedTriangles, keeps],
    [Uint32Array.of(0, 0, 1), Uint32Array.of(0, 1), undefined, true],
  );
  const { indices, flips } = await makeDelaunay(mesh, { groups, lockedEdges, lockedTriangles });
  assert.equal(flips, 1);
  const written = text(await writeMesh({ ...mesh, indices }, 'b.obj', { original }));
  assert.equal(written, `${points}usemtl a\r\nf 4/1 2/1 3/1\r\nf 1/1 2/1 4/1\r\nusemtl b\r\nf 2/2 1/2 5/2\r\n`);
  assert.deepEqual(new Uint8Array(gunzipSync(await writeMesh(mesh, 'b.obj.gz', { original }))), original.bytes);
  // Another format, and the same format without the original, have only positions and triangles.
  assert.match(text(await writeMesh({ ...mesh, indices }, 'b.off', { original })), /^OFF\n5 3 0\n0 0\b/);
  assert.match(text(await writeMesh({ ...mesh, indices }, 'b.obj')), /^v 0 0 0\nv 0.90000000001 0.2 0\n/);
  const turned = { ...mesh, indices: Uint32Array.of(0, 2, 1, 0, 3, 2, 1, 0, 4) };
  await assert.rejects(
    writeMesh(turned, 'b.obj', { original }),
    refused('invalid-option', /triangle 0 cannot result from flips while seams are locked/),
  );
  const strips =
    'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nelement tristrips 1\nproperty list int int vertex_index\nend_header\n0 0\n1 0\n0 1\n3 0 1 2\n';
  assert.equal((await readMesh(bytes(strips), 'a.ply')).keeps, false);
});

test('ignored attributes lock no edges, and stay in the file', async () => {
  const points = 'v -3 0 0\nv 0 -1 0\nv 3 0 0\nv 0 1 0\n';
  const ply =
    'ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nelement face 2\nproperty list uchar int vertex_indices\nproperty int id\nend_header\n-3 0\n0 -1\n3 0\n0 1\n';
  const normals = `${points}vn 0 0 1\nvn 0 0.0001 1\n`;
  for (const [name, attribute, before, faces, after] of [
    ['a.ply', 'id', ply, '3 0 1 2 7\n3 0 2 3 8\n', '3 3 1 2 7\n3 0 1 3 8\n'],
    ['a.obj', 'vn', normals, 'f 1//1 2//1 3//1\nf 1//2 3//2 4//2\n', 'f 4//1 2//1 3//1\nf 1//2 2//2 4//2\n'],
  ]) {
    const file = bytes(before + faces);
    const flipped = async (options) => {
      const mesh = await readMesh(file, name, options);
      const { groups, lockedEdges, lockedTriangles } = mesh;
      const { indices } = await makeDelaunay(mesh, { groups, lockedEdges, lockedTriangles });
      const original = { bytes: file, name, ...options };
      return { mesh, written: text(await writeMesh({ ...mesh, indices }, name, { original })) };
    };
    const kept = await flipped({});
    assert.deepEqual([kept.mesh.attributeEdges, kept.written], [[{ name: attribute, edges: 1 }], before + faces]);
    const ignored = await flipped({ ignoreAttributes: [attribute] });
    assert.deepEqual([ignored.mesh.attributeEdges, ignored.written], [[], before + after]);
    const unknown = refused(
      'invalid-option',
      new RegExp(`^option ignoreAttributes: no attribute .* named \`red\`; the file has: \`${attribute}\`$`),
    );
    await assert.rejects(readMesh(file, name, { ignoreAttributes: [attribute, 'red'] }), unknown);
    const original = { bytes: file, name, ignoreAttributes: ['red'] };
    await assert.rejects(writeMesh(kept.mesh, name, { original }), unknown);
  }
  for (const wrong of ['vn', [1], [undefined], new Array(2000), new Set(['vn']), null]) {
    await assert.rejects(
      readMesh(bytes(points), 'a.obj', { ignoreAttributes: wrong }),
      refused('invalid-input', /^ignoreAttributes: .* is not a (string|list of at most 1024 names)$/),
    );
  }
});

test('the dimension is that of the file, or that of the option', async () => {
  const flat = bytes('OFF 1 0\n1 2 0\n');
  const raised = bytes('OFF 2 0\n0 0 0\n1 2 0.5\n');
  assert.deepEqual([...(await readMesh(flat, 'a.off')).positions], [1, 2]);
  assert.deepEqual([...(await readMesh(flat, 'a.off', { dimension: 3 })).positions], [1, 2, 0]);
  assert.deepEqual([...(await readMesh(bytes('2OFF 1 0\n1 2'), 'a.off')).positions], [1, 2]);
  assert.deepEqual([...(await readMesh(raised, 'a.off')).positions], [0, 0, 0, 1, 2, 0.5]);
  await assert.rejects(readMesh(raised, 'a.off', { dimension: 2 }), refused('parse', /^vertex 1: z is 0\.5/));
  await assert.rejects(
    readMesh(raised, 'a.off', { dimension: 4 }),
    refused('invalid-input', /dimension: 4 is not 2 or 3/),
  );
});

test('errors have codes and name the location', async () => {
  const mesh = awkward();
  await assert.rejects(
    readMesh(bytes('OFF\n3 1 0\n0 0 0\n1 x 0\n'), 'a.off'),
    refused('parse', /^line 4: expected a number, found `x`$/),
  );
  await assert.rejects(readMesh(bytes('v 0 0 0\nf 1 1 2\n'), 'a.obj'), refused('parse', /^line 2: vertex index `2`/));
  await assert.rejects(readMesh(new Uint8Array(), 'a.obj'), refused('parse', /^line 1: the file is empty$/));
  await assert.rejects(readMesh(Uint8Array.of(0xff, 0, 0x0a), 'a.obj'), refused('parse', /^line 1: /));
  await assert.rejects(readMesh(new Uint8Array(), 'a.mesh'), refused('unknown-format', /^a\.mesh: /));
  await assert.rejects(
    readMesh(bytes('ply\nformat ascii 1.0\nelement\n'), 'a.ply'),
    refused('parse', /^line 3: .* found `element`$/),
  );
  await assert.rejects(readMesh(new Uint8Array(90), 'a.stl'), refused('parse', /^byte 84: .* found 6 more bytes$/));
  await assert.rejects(writeMesh(mesh, 'mesh'), refused('unknown-format', /^mesh: /));
  await assert.rejects(
    writeMesh({ ...mesh, indices: Uint32Array.of(0, 1, 9) }, 'a.off'),
    refused('index-out-of-range', /9/),
  );
  await assert.rejects(readMesh('OFF', 'a.off'), refused('invalid-input', /bytes/));
  await assert.rejects(readMesh(new Uint8Array(), undefined), refused('invalid-input', /name/));
  await assert.rejects(writeMesh(mesh, 1), refused('invalid-input', /name/));
  await assert.rejects(generate(['grid', 5]), refused('invalid-input', /spec/));
  await assert.rejects(
    generate('sphere 5'),
    refused('invalid-option', /"sphere 5" is not one of: grid N, .*uvsphere N/),
  );
  await assert.rejects(generate('grid 12000'), refused('too-large', /triangles/));
  for (const bins of [0, 1.5, NaN, 2 ** 20]) {
    await assert.rejects(angles(mesh, bins), refused('invalid-option', /bins: .* 1 to 65536/));
  }
});

test('the formats are those that the module knows', async () => {
  await assert.rejects(readMesh(new Uint8Array(), 'a'), (error) =>
    error.message.endsWith(`use one of: ${[...FORMATS, ...POINT_FORMATS].join(', ')}, also gzip'd (.gz)`),
  );
});

test('files of points are read, and not written', async () => {
  for (const format of POINT_FORMATS) {
    const flat = await readMesh(
      bytes('0 0\n4,0\n4 3\n'.replaceAll(/[ ,]/g, format === '.csv' ? ',' : ' ')),
      `a${format}`,
    );
    assert.deepEqual([flat.dimension, flat.indices.length, ...flat.positions], [2, 0, 0, 0, 4, 0, 4, 3]);
    await assert.rejects(
      writeMesh(flat, `a${format}`),
      refused('unknown-format', /use one of: .off.* .glb, also gzip/),
    );
  }
  const terrain = await readMesh(bytes('name,height,y,x\na,5,0,0\nb,6,0,4\nc,7,3,4\n'), 'a.csv');
  assert.deepEqual([terrain.dimension, ...terrain.positions], [3, 0, 0, 5, 4, 0, 6, 4, 3, 7]);
  const { triangles } = await triangulate(terrain.positions, { stride: terrain.dimension });
  assert.deepEqual([...triangles], [0, 1, 2]);
});

test('generated meshes are those of the crate', async () => {
  const lines = readFileSync(new URL('generated.txt', import.meta.url), 'utf8')
    .trimEnd()
    .split('\n')
    .slice(1);
  assert.ok(lines.length > 10);
  for (const line of lines) {
    const [, off, obj, spec] = line.match(/^(\w+) (\w+) (.+)$/);
    const mesh = await generate(spec);
    assert.equal(digest(await writeMesh(mesh, 'a.off')), off, spec);
    assert.equal(digest(await writeMesh(mesh, 'a.obj')), obj, spec);
  }
});

test('angles of a right triangle', async () => {
  const mesh = { positions: new Float64Array([0, 0, 1, 0, 0, 1]), indices: new Uint16Array([0, 1, 2]), dimension: 2 };
  const { min, meanMin, counts } = await angles(mesh, 4);
  assert.ok(Math.abs(min - 45) < 1e-12 && Math.abs(meanMin - 45) < 1e-12);
  assert.deepEqual(counts, Uint32Array.of(0, 2, 1, 0));
  assert.equal((await angles(mesh)).counts.length, 180);
  assert.deepEqual(await angles({ ...mesh, indices: new Uint32Array() }, 1), {
    min: 60,
    meanMin: 60,
    counts: Uint32Array.of(0),
  });
});

test('720,000 triangles are generated, written and read back', async () => {
  const mesh = await generate('uvsphere 600');
  assert.deepEqual([mesh.positions.length, mesh.indices.length], [3 * 360_002, 3 * 720_000]);
  for (const format of FORMATS) {
    const read = await readMesh(await writeMesh(mesh, `a${format}`), `a${format}`);
    assert.equal(read.indices.length, mesh.indices.length);
    if (format === '.stl') continue;
    assert.deepEqual(read.indices, mesh.indices);
    assert.deepEqual(bits(read), bits(mesh));
  }
  const { counts } = await angles(mesh, 18);
  assert.equal(
    counts.reduce((sum, count) => sum + count),
    3 * 720_000,
  );
});

test('`measures` and `change` measure a mesh and the changes of a run', async () => {
  const mesh = await generate('uvsphere 12');
  const { indices } = await makeDelaunay(mesh, { maxNormalAngle: 60 });
  const [before, after] = [await measures(mesh), await measures({ ...mesh, indices })];
  assert.ok(
    after.meanMinAngle > before.meanMinAngle && after.meanAspect < before.meanAspect && after.area < before.area,
  );
  assert.ok(before.volume > 3 && before.volume < 4.2 && Math.abs(after.volume - before.volume) < 0.2);
  assert.equal(before.flat, 0);
  const { moved, distance } = await change(mesh, indices);
  assert.ok(moved.length > 10 && distance > 0 && distance < 0.2, `${moved.length} ${distance}`);
  assert.deepEqual(await change(mesh, mesh.indices), { moved: new Uint32Array(), distance: 0 });
  await assert.rejects(change(mesh, indices.slice(3)), refused('triangle-count', /triangles has/));
  assert.deepEqual(await reorient(mesh), { indices: mesh.indices, turned: 0 });
});
