// Pictures of textured geometries before and after `delaunayGeometry`, drawn without light from one camera, agree where
// the surface does not end. The angle between triangles is not limited. Uses the existing dist/.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { delaunayGeometry } from 'edgeflip/three';
import { full } from '../full.mjs';
import { compare, picture, texture } from './pictures.mjs';
import { TEXTURED } from './textured.mjs';

const levels = texture();

const surfaceOf = ({ index, attributes: { position, uv } }) => ({
  positions: position.array,
  uvs: uv.array,
  indices: index?.array ?? Uint32Array.from({ length: position.count }, (_, i) => i),
});

/** The most pixels that may differ, of those that both pictures show. */
const MOST = 0.001;

/** The models of the short run. */
const SHORT = ['pmndrs with its own mapping', 'bunny, projected and mirrored', 'atlas of a lathe'];

/** Models whose pictures change without the limit. */
const TORN = ['bunny, projected and mirrored', 'mirrored sphere', 'sheared rounded box'];

for (const [name, [make, isSmooth]] of Object.entries(TEXTURED)) {
  if (!full && !SHORT.includes(name)) continue;
  test(`the picture stays: ${name}`, async (t) => {
    const geometry = await make();
    const before = picture(surfaceOf(geometry), levels);
    const run = async (maxAttributeShift) => {
      const result = await delaunayGeometry(geometry, { copy: true, maxNormalAngle: 180, maxAttributeShift });
      const { count, differing } = compare(before, picture(surfaceOf(result.geometry), levels, before.level));
      return { ...result, count, share: differing / count };
    };
    const [limited, unlimited] = [await run(undefined), await run(Infinity)];
    const { flips, share, count, shiftEdges, largestShifts } = limited;
    const percent = (x) => `${(100 * x).toFixed(3)} %`;
    t.diagnostic(
      `${flips} of ${unlimited.flips} flips; ${shiftEdges} edges locked; largest shift ${largestShifts.uv}; ` +
        `${percent(share)} of ${count} pixels differ, ${percent(unlimited.share)} without the limit`,
    );
    assert.ok(count > 5000);
    assert.ok(share <= MOST, `${percent(share)} of the pixels differ`);
    assert.ok(largestShifts.uv <= 1 / 1024);
    if (TORN.includes(name)) assert.ok(unlimited.share > 3 * MOST, `${percent(unlimited.share)} differ`);
    if (isSmooth) assert.ok(flips >= 0.8 * unlimited.flips, `${flips} of ${unlimited.flips} flips`);
  });
}
