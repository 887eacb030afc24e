// A lesson in the playground, for both browsers: its link, what the page draws, and what the engine says of it.

import assert from 'node:assert/strict';
import { fileURLToPath } from 'node:url';
import { EDGE_STATES, FlipSession } from 'edgeflip';
import site from '../../www/vite.config.js';
import { openPage, serve } from '../browsers.mjs';

const DIGITS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_';

/** The link to these points and triangles. */
export function hashOf({ points, triangles = [], at = '0', edge }) {
  const digits = points.flat().flatMap((x) => [Math.floor(x / 64), x % 64]);
  const text = (numbers) => numbers.map((x) => DIGITS[x]).join('');
  return `#explain?points=${text(digits)}&triangles=${text(triangles)}&at=${at}${edge ? `&edge=${edge.join('-')}` : ''}`;
}

/** The points and triangles of a link. */
export function meshIn(link) {
  const parts = new URLSearchParams(link.split('?')[1]);
  const numbers = (name) => Array.from(parts.get(name) ?? '', (char) => DIGITS.indexOf(char));
  const digits = numbers('points');
  const points = [];
  for (let i = 0; i < digits.length; i += 4) {
    points.push([64 * digits[i] + digits[i + 1], 64 * digits[i + 2] + digits[i + 3]]);
  }
  return { points, triangles: numbers('triangles'), at: parts.get('at'), edge: parts.get('edge') };
}

/** Opens a page at a part of the section, without motion where the browser can be told. */
export async function openAt(browser, hash) {
  const address = await serve(fileURLToPath(new URL('../../target/www', import.meta.url)), site.preview.headers);
  const opened = await openPage(browser, 'about:blank');
  await opened.page.emulateMedia?.({ reducedMotion: 'reduce' });
  await opened.page.goto(`${address}${hash}`);
  await opened.page.waitForSelector('.playground .explain-caption:not(:empty)');
  return opened;
}

/** What the playground shows: the edges as pairs of points by their kind, the points, the words and the marked button. */
export async function drawn(page) {
  const { points, edges, ...rest } = await page.evaluate(() => {
    const all = (part) => [...document.querySelectorAll(`.playground ${part}`)];
    const text = (part) => all(part).map((element) => element.textContent);
    return {
      points: all('.explain-handle').map((point) =>
        point
          .getAttribute('transform')
          .match(/[\d.]+/g)
          .map(Number),
      ),
      edges: all('.explain-edge').map((edge) => ({
        kind: edge.getAttribute('class').split(' ').at(-1).replace('explain-', ''),
        ends: edge
          .getAttribute('d')
          .match(/[\d.]+/g)
          .map(Number),
      })),
      stop: text('[aria-current]'),
      caption: text('.explain-caption').join(),
      labels: text('.playground-labels text'),
      arrows: all('.explain-arrows path').length,
      why: all('.playground-why:not([hidden])').map((element) => element.textContent.trim()),
    };
  });
  const indexOf = (x, y) => points.findIndex(([u, v]) => u === x && v === y);
  const kinds = {};
  for (const { kind, ends } of edges) {
    (kinds[kind] ??= []).push(key(indexOf(ends[0], ends[1]), indexOf(ends[2], ends[3])));
  }
  for (const list of Object.values(kinds)) list.sort();
  return { points, kinds, ...rest };
}

export const key = (a, b) => `${Math.min(a, b)}-${Math.max(a, b)}`;

const next = (h) => (h % 3 === 2 ? h - 2 : h + 1);

/** The edges of triangles by their state on the engine, before each iteration. */
export async function enginesRounds({ points, triangles }) {
  const mesh = { positions: Float64Array.from(points.flat()), indices: Uint32Array.from(triangles), dimension: 2 };
  const session = await FlipSession.create(mesh, { backend: 'cpu', threads: 1 });
  const rounds = [];
  do {
    const indices = [...(await session.triangles())];
    const states = {};
    [...(await session.edgeStates())].forEach((state, h) => {
      const edges = (states[EDGE_STATES[state]] ??= new Set());
      edges.add(key(indices[h], indices[next(h)]));
    });
    const lists = Object.entries(states).map(([state, edges]) => [state, [...edges].sort()]);
    rounds.push({ triangles: indices, states: Object.fromEntries(lists) });
  } while (await session.step());
  session.free();
  return rounds;
}

/** All edges of a round, whatever their state. */
export const edgesOf = (kinds) => Object.values(kinds).flat().sort();

/** Eight points with long triangles after two rounds, at Select of the third, with an edge that waits explained. */
// biome-ignore format: one row for the points, two for the triangles
export const LESSON = {
  points: [[50, 360], [350, 340], [520, 90], [190, 360], [140, 80], [380, 50], [450, 230], [100, 260]],
  triangles: [
    1, 0, 2, 0, 1, 3, 2, 0, 7, 0, 4, 7,
    4, 2, 7, 2, 4, 5, 1, 2, 6,
  ],
  at: '2.select',
};

/** Asserts that the page shows a mesh at Select, as the engine says, after these rounds. Returns what it shows. */
export async function assertSelected(page, mesh, rounds) {
  const shown = await drawn(page);
  const { states } = (await enginesRounds(mesh))[rounds];
  assert.deepEqual(shown.points, mesh.points);
  assert.deepEqual([shown.kinds.flips, shown.kinds.waits], [states.flips, states.waits]);
  assert.deepEqual(edgesOf(shown.kinds), edgesOf(states));
  assert.deepEqual(shown.stop, ['Select']);
  return shown;
}
