/** The tool: connects its controls and opens its first mesh. */

import './style.css';
import './transport.css';
import './gallery.css';
import './panel.css';
import './table.css';
import './overlays.css';
import './lecture.css';
import '../move/move.css';
import type { NamedMesh } from '../engines/index.ts';
import type { Drop } from '../shell/early-drop.ts';
import { toggleTheme } from '../shell/theme.ts';
import { copyCode, copyLink, drawEdge, saveMesh, savePicture, scramble } from './actions.ts';
import { controls, element } from './controls.ts';
import { made } from '../shell/elements.ts';
import type { EdgeLook } from './display.ts';
import { makeGallery } from './gallery.ts';
import { Guide } from './guide.ts';
import { listen } from './keys.ts';
import { asksForLecture, isLecture, setLecture } from './lecture.ts';
import { placeIn, type Place } from './link.ts';
import { tell } from './notice.ts';
import { Page } from './page.ts';
import { FEW } from './phases.ts';
import { MovingSamples } from '../move/moving-samples.ts';
import { FIRST, MOVING, SAMPLES } from '../models/samples.js';
import type { OpenMesh } from './run.ts';
import { chosen, dropped, OPENED, sample, type Source } from './sources.ts';

/** The formats that a mesh is saved in besides its own. */
const SAVED = ['.ply', '.obj', '.glb', '.stl', '.off'];
const LOOKS: readonly EdgeLook[] = ['coloured', 'plain', 'none'];

/** The tool, once it has been started. */
export interface Tool {
  /** The open mesh, as its run began. */
  mesh(): NamedMesh | undefined;
  /** Settles when the screen shows the mesh that was opened last. */
  drawn(): Promise<void>;
  /** Opens what was dropped before the tool was loaded. */
  open(drop: Drop): void;
  /** Guides a visitor who comes from the first view. */
  guide(): void;
}

/** Starts the tool, also while the first view is shown; call it once. */
export function start(): Tool {
  const page: Page = new Page((from, to) => void drawEdge(page, [from, to]));
  const movingSamples = new MovingSamples(page);
  const open = (source: Source | undefined) => {
    if (!source) return;
    movingSamples.leave();
    void page.open(source);
  };
  const openSample = (spec: string) => {
    const moving = movingOf(spec);
    if (moving) void movingSamples.show(moving);
    else open(sample(spec));
  };
  makeGallery(openSample);
  // A glTF file may have its buffers and textures in other files.
  controls.file.accept = [...OPENED, '.gz', '.bin', '.png', '.jpg', '.jpeg', '.webp', '.avif'].join(',');
  controls.file.addEventListener('change', () => {
    open(chosen([...(controls.file.files ?? [])]));
    controls.file.value = '';
  });
  connectRun(page, movingSamples);
  connectLimits(page);
  const ofRun = takingFrom(page);
  const taking = () => (movingSamples.isShown ? movingSamples : ofRun);
  connectTakeAway(taking);
  connectDrop(open);
  connectKeys(
    page,
    openSample,
    () => void taking().picture(),
    () => void tell(taking().link()),
  );
  element('end-lecture').addEventListener('click', () => lecture(page, false));
  void begin(page, movingSamples);
  const mesh = () => {
    const shown = page.shown;
    if (!shown) return undefined;
    const { mesh, plan, title: name } = shown.opened;
    const { groups, lockedEdges, lockedTriangles }: OpenMesh = mesh;
    const { positions, indices, dimension } = plan;
    const { maxNormalAngle, maxDeviation, keepsGroups } = shown.settings;
    const locks = { lockedEdges, lockedTriangles, groups: keepsGroups ? groups : undefined };
    const limits = dimension === 3 ? { maxNormalAngle, maxDeviation } : {};
    return { name, positions, indices, dimension, options: { ...locks, ...limits } };
  };
  return {
    mesh,
    open: (drop) => open(dropped(drop)),
    drawn: () => page.drawn(),
    guide: () => void new Guide(page).begin(),
  };
}

const lecture = (page: Page, isOn: boolean) => setLecture(isOn, () => page.scene?.camera.resize());

const movingOf = (spec: string | undefined) => MOVING.find((sample) => sample.spec === spec);

/** Opens the mesh of the address, or a file that was chosen before this code was loaded, or the first sample. */
async function begin(page: Page, movingSamples: MovingSamples): Promise<void> {
  const file = chosen([...(controls.file.files ?? [])]);
  const place = file ? undefined : placeIn(location.hash);
  lecture(page, asksForLecture(location.hash));
  addEventListener('hashchange', () => {
    const next = placeIn(location.hash);
    if (!next) {
      // The sections are not in a lecture.
      if (!/^#(?:watch|first)\b/.test(location.hash)) lecture(page, false);
      return;
    }
    page.prefer(next);
    lecture(page, asksForLecture(location.hash));
    const moving = movingOf(next.mesh);
    if (moving) return void movingSamples.show(moving);
    movingSamples.leave();
    void page.open(sample(next.mesh)).then(() => goTo(page, next));
  });
  if (place) page.prefer(place);
  const moving = movingOf(place?.mesh);
  await page.start(moving ? undefined : (file ?? sample(place?.mesh ?? FIRST)));
  if (moving) await movingSamples.show(moving);
  else if (place) await goTo(page, place);
}

async function goTo(page: Page, { at, pose }: Place): Promise<void> {
  if (at > 0) await page.player.seek(at);
  if (pose && page.scene) page.scene.camera.pose = pose;
}

function connectRun(page: Page, movingSamples: MovingSamples): void {
  controls.backend.addEventListener('change', () => {
    void page.begin();
    void movingSamples.restart();
  });
  controls.reset.addEventListener('click', () => void page.player.seek(0));
  controls.back.addEventListener('click', () => void page.player.seekBy(-1));
  controls.play.addEventListener(
    'click',
    () => void (movingSamples.isShown ? movingSamples.toggle() : page.player.toggle()),
  );
  controls.step.addEventListener('click', () => void page.player.step());
  controls.phase.addEventListener('click', () => void page.phases.step(1));
  controls.slider.addEventListener('input', () => void page.player.seek(controls.slider.valueAsNumber));
  controls.compare.addEventListener('click', () => void page.compare());
  controls.scramble.addEventListener('click', () => void scramble(page));
  const cancel = element<HTMLButtonElement>('cancel');
  cancel.disabled = false;
  cancel.addEventListener('click', () => page.cancel());
  element('dismiss').addEventListener('click', () => (element('error').hidden = true));
}

function connectLimits(page: Page): void {
  for (const control of [controls.beta, controls.deviation, controls.feature, controls.groups]) {
    control.addEventListener('change', () => void page.begin());
  }
  controls.betaRange.addEventListener('input', () => {
    controls.beta.value = controls.betaRange.value;
    void page.begin();
  });
}

/** What can be taken away, of a run or of a mesh that moves. Links and code return what to say. */
interface Taking {
  save(extension?: string): Promise<void>;
  picture(): Promise<void>;
  link(): Promise<string>;
  code(): Promise<string>;
}

function takingFrom(page: Page): Taking {
  return {
    save: (extension) => saveMesh(page, extension),
    picture: () => savePicture(page),
    link: () => copyLink(page),
    code: () => copyCode(page),
  };
}

function connectTakeAway(taking: () => Taking): void {
  const own = made('button', '', 'Same format');
  own.id = 'download';
  own.addEventListener('click', () => void taking().save());
  const others = SAVED.map((extension) => {
    const button = made('button', '', extension.slice(1).toUpperCase());
    button.addEventListener('click', () => void taking().save(extension));
    return button;
  });
  element('formats').append(own, ...others);
  controls.picture.addEventListener('click', () => void taking().picture());
  element('link').addEventListener('click', () => void tell(taking().link()));
  element('code').addEventListener('click', () => void tell(taking().code()));
  element('away').addEventListener('toggle', () => (element('away-says').textContent = ''));
}

function connectDrop(open: (source: Source | undefined) => void): void {
  const dropHere = element('drop-here');
  document.addEventListener('dragover', (event) => {
    event.preventDefault();
    dropHere.hidden = false;
  });
  document.addEventListener('dragleave', (event) => {
    if (!event.relatedTarget) dropHere.hidden = true;
  });
  document.addEventListener('drop', (event) => {
    event.preventDefault();
    dropHere.hidden = true;
    open(dropped(event));
  });
}

function connectKeys(
  page: Page,
  openSample: (spec: string) => void,
  savePicture: () => void,
  copyLink: () => void,
): void {
  const specs = SAMPLES.map(({ spec }) => spec);
  const keys = element<HTMLDialogElement>('keys');
  element('help').addEventListener('click', () => keys.showModal());
  const toggle = (id: string, opener: HTMLButtonElement) => opener.offsetParent && element(id).togglePopover();
  const slides = 'input, select';
  const step = async (by: 1 | -1) => {
    if (isLecture() && (await page.phases.step(by))) return;
    if (by > 0) controls.step.click();
    else await page.player.seekBy(-1);
  };
  listen([
    {
      keys: [' '],
      label: 'Space',
      says: 'play or pause',
      keptBy: 'button, summary, a, input, select',
      act: () => controls.play.click(),
    },
    {
      keys: ['ArrowLeft'],
      label: '← →',
      says: 'one iteration back, on',
      keptBy: slides,
      act: () => void step(-1),
    },
    { keys: ['ArrowRight'], keptBy: slides, act: () => void step(1) },
    // Of clickers.
    { keys: ['PageUp'], when: isLecture, act: () => void step(-1) },
    { keys: ['PageDown'], when: isLecture, act: () => void step(1) },
    {
      keys: [','],
      label: ', .',
      says: `one phase back, on, up to ${FEW} triangles`,
      act: () => void page.phases.step(-1),
    },
    { keys: ['.'], act: () => void page.phases.step(1) },
    {
      keys: ['Home'],
      label: 'Home End',
      says: 'the input, the last state',
      keptBy: slides,
      act: () => void page.player.seek(0),
    },
    { keys: ['End'], keptBy: slides, act: () => void page.player.seek(Number(controls.slider.max)) },
    {
      keys: ['1', '2', '3', '4', '5', '6', '7', '8', '9'],
      label: '1 – 9',
      says: 'sample 1 to 9',
      act: (key) => {
        const spec = specs[Number(key) - 1];
        if (spec) openSample(spec);
      },
    },
    { keys: ['c'], label: 'C', says: 'before and now', act: () => void page.compare() },
    {
      keys: ['n'],
      label: 'N, Shift N',
      says: 'next, previous edge that is not Delaunay',
      act: (key) => page.inspectNext(key.startsWith('Shift') ? -1 : 1),
    },
    {
      keys: ['e'],
      label: 'E',
      says: 'edges: coloured, plain, none',
      act: () => (page.edges = LOOKS[(LOOKS.indexOf(page.edges) + 1) % LOOKS.length]!),
    },
    { keys: ['v'], label: 'V', says: 'surface: as in the file, plain', act: () => page.toggleSurface() },
    { keys: ['d'], label: 'D', says: 'draw edges, in a plane', act: () => controls.draw.click() },
    { keys: ['l'], label: 'L', says: 'limits', act: () => toggle('limits', controls.limit) },
    { keys: ['x'], label: 'X', says: 'scramble', act: () => controls.scramble.click() },
    { keys: ['o'], label: 'O', says: 'open a mesh', act: () => controls.file.click() },
    { keys: ['s'], label: 'S', says: 'save the mesh', act: () => toggle('away', controls.take) },
    { keys: ['p'], label: 'P', says: 'save a picture', act: savePicture },
    { keys: ['k'], label: 'K', says: 'copy a link to this view', act: copyLink },
    { keys: ['f'], label: 'F', says: 'fit the mesh to the view', act: () => page.scene?.camera.fit() },
    { keys: ['g'], label: 'G', says: 'the engines', act: () => (location.hash = '#engines') },
    {
      keys: ['h'],
      label: 'H',
      says: 'lecture: no tools, large type; Page ↑ ↓ step',
      act: () => lecture(page, !isLecture()),
    },
    { keys: ['t'], label: 'T', says: 'light or dark', act: toggleTheme },
    { keys: ['?'], label: '?', says: 'these keys', act: () => keys.showModal() },
    {
      keys: ['Escape'],
      label: 'Esc',
      says: 'close what is open, then end the lecture',
      act: () => {
        if (!page.closeTopmost()) lecture(page, false);
      },
    },
  ]);
}
