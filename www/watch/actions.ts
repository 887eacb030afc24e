/** What the user does with the shown mesh besides running it: scramble, draw edges, save, link, and take the code. */

import { codeFor } from './code.ts';
import { download, save } from './download.ts';
import { withLecture } from './lecture.ts';
import { linkTo } from './link.ts';
import { counted, number } from '../shell/numbers.ts';
import { again } from './opening.ts';
import type { Page } from './page.ts';
import { palette } from './palette.ts';
import { canScramble, SCRAMBLED, type OpenMesh } from './run.ts';
import type { Shown } from './shown.ts';
import { snapshot } from './snapshot.ts';
import { splitName } from './sources.ts';

/** Flips edges at random where the shape stays, and opens the mesh again with these triangles. */
export async function scramble(page: Page): Promise<void> {
  const shown = page.shown;
  if (!shown) return;
  const { opened, run, settings } = shown;
  let indices: Uint32Array | undefined;
  await page.attempt('Flipping edges at random…', async () => {
    if (!canScramble(opened.mesh)) {
      throw new Error(`Scramble takes up to ${number.format(SCRAMBLED)} triangles. This mesh has more.`);
    }
    const mesh = { ...opened.mesh, ...opened.plan, indices: await run.triangles() };
    const seed = Math.floor(performance.now());
    indices = await opened.client.call((worker) => worker.scramble(mesh, settings.maxNormalAngle, seed));
  });
  if (indices) await page.open(again(opened, settings.maxNormalAngle, { ...opened.mesh, indices }));
}

/** Brings an edge into the shown triangles, and plays the run that makes the others Delaunay. */
export async function drawEdge(page: Page, ends: [from: number, to: number]): Promise<void> {
  const shown = page.shown;
  if (!shown) return;
  const { opened, run, settings } = shown;
  page.player.pause();
  let drawn: OpenMesh | undefined;
  await page.attempt('Bringing the edge in…', async () => {
    const { groups, ...mesh }: OpenMesh = opened.mesh;
    const indices = await run.triangles();
    const given = { ...mesh, indices, ...(settings.keepsGroups && groups ? { groups } : {}) };
    drawn = { ...given, ...(await opened.client.call((worker) => worker.drawEdge(given, ends))) };
  });
  if (!drawn) return;
  await page.open(again(opened, settings.maxNormalAngle, drawn, ends));
  if (page.shown?.opened.mesh.indices === drawn.indices) await page.player.toggle();
}

/** Writes the shown triangles into a file, in the format of `extension`, or of the file that was opened. */
export async function saveMesh(page: Page, extension?: string): Promise<void> {
  const shown = page.shown;
  if (!shown) return;
  const { opened, run } = shown;
  const [, own] = splitName(opened.name);
  const format = extension ?? own;
  // Only a file of the same format keeps what else was in the original.
  const kept = format === own ? opened.kept : undefined;
  await page.attempt('Writing the file…', async (signal) => {
    const mesh = { ...opened.mesh, indices: await run.triangles() };
    signal.throwIfAborted();
    await download(mesh, nameFor(shown, format), kept, signal);
  });
}

/** The name of a file of what is shown. */
function nameFor({ opened, run }: Shown, extension: string): string {
  const [stem] = splitName(opened.name);
  return `${stem.replaceAll(' ', '-')}-after-${run.at}${extension}`;
}

/** Saves a picture: of the input and the shown state beside each other with the result under them, or of the input. */
export async function savePicture(page: Page): Promise<void> {
  const { shown } = page;
  if (!shown || !page.scene || page.isBusy) return;
  const { run, opened } = shown;
  const { at } = run;
  if (page.player.isPlaying) page.player.pause();
  await page.attempt('Drawing the picture…', async (signal) => {
    const words = await page.caption();
    const pictures: OffscreenCanvas[] = [];
    try {
      for (const state of at > 0 ? [0, at] : [0]) {
        const picture = await page.pictureAt(state);
        signal.throwIfAborted();
        if (picture) pictures.push(picture);
      }
    } finally {
      if (run.at !== at) {
        run.seek(at);
        void page.redraw();
      }
    }
    const { title, mesh } = opened;
    const line = at > 0 ? words : `${title}, ${counted(mesh.indices.length / 3, 'triangle')}. ${words}`;
    save(await snapshot(pictures, line, palette()), nameFor(shown, '.png'));
  });
}

/** Copies a link to what is shown. Returns what to say. */
export async function copyLink(page: Page): Promise<string> {
  const shown = page.shown;
  if (!shown) return '';
  const link = linkTo(shown, page.scene?.camera.pose);
  if (!link) return 'A link opens samples only: your mesh is on this computer alone.';
  await navigator.clipboard.writeText(withLecture(link));
  const { spec, isScrambled } = shown.opened;
  if (spec !== undefined) return 'Link copied. It opens this mesh, iteration, limit and view.';
  return `Link copied. It opens the sample as it was before ${isScrambled ? 'it was scrambled' : 'you drew edges'}.`;
}

/** Copies the lines of JavaScript that do what is on screen. Returns what to say. */
export async function copyCode(page: Page): Promise<string> {
  const shown = page.shown;
  if (!shown) return '';
  await navigator.clipboard.writeText(codeFor(shown));
  return shown.opened.isScrambled
    ? 'Code copied. Save the scrambled input for it: a comment says how.'
    : 'Code copied.';
}
