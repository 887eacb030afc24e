/** The first figure: the same points with thin and with round triangles, and what comes of each. */

import './why.css';
import { create } from 'd3-selection';
import { made } from '../shell/elements.ts';
import { number } from '../shell/numbers.ts';
import { colourReader, onTheme } from '../shell/theme.ts';
import { drawDots, drawShapes, layer, polyline, type Svg } from './draw.ts';
import { cornersOf } from './planar.ts';
import { angle } from './angles.ts';
import { SIZE } from './why-fields.ts';
import { contours, heat, interpolated, type Joined, rasterOf, shading, slopesOf } from './why-measures.ts';
import { fine, healed, round, thinned } from './why-mesh.ts';

const [WIDTH, HEIGHT] = [240, 180];
const LEVELS = [35, 70, 105];
/** Bands of equal temperature. */
const BANDS = 14;
/** The most flips at random, and those of the beginning. */
const [MOST, AT_FIRST] = [600, 300];

const SIDES = ['Scrambled', 'By edgeflip'] as const;

const USES = [
  {
    name: 'Light on a terrain',
    words: 'The mesh gives the light its normals. The number is how far they are off on average.',
    label: 'Shaded terrain',
  },
  {
    name: 'Heat that flows',
    words:
      'A hot spot spreads, and edges carry the heat by their cotangent weights. The number is the mean error in percent of the hottest point.',
    label: 'Bands of temperature',
  },
  {
    name: 'A contour line',
    words:
      'The wide grey lines are exact. The number is how far the thin ones are off on average, in percent of the width.',
    label: 'Contour lines of a terrain',
  },
] as const;

const off = (value: number, unit: string) => `${value.toFixed(unit === '°' ? 1 : 2)}${unit} off`;

/** The smallest angle of each triangle, on average. */
function meanSmallest({ points, triangles }: Joined): number {
  const smallest = cornersOf(triangles).map((corners) => {
    const [a, b, c] = corners.map((v) => points[v]!);
    return Math.min(angle(a!, b!, c!), angle(b!, c!, a!), angle(c!, a!, b!));
  });
  return smallest.reduce((sum, degrees) => sum + degrees, 0) / smallest.length;
}

function picture(label: string): Svg {
  return create('svg')
    .attr('class', 'explain-drawing why-picture')
    .attr('viewBox', `0 0 ${SIZE.join(' ')}`)
    .attr('role', 'img')
    .attr('aria-label', label);
}

/** One of the two meshes, its three pictures, and the words below each. */
function makeSide(name: string) {
  const mesh = picture(`The mesh: ${name}`);
  const lines = layer(mesh, '');
  const dots = layer(mesh, 'explain-dots');
  const canvases = USES.slice(0, 2).map(({ label }) => {
    const canvas = made('canvas', 'why-picture');
    Object.assign(canvas, { width: WIDTH, height: HEIGHT, role: 'img', ariaLabel: `${label}: ${name}` });
    return canvas;
  });
  const contour = picture(`${USES[2].label}: ${name}`);
  const exact = layer(contour, 'why-exact');
  const drawn = layer(contour, 'why-drawn');
  const words = ['mesh', ...USES].map(() => made('p', 'why-number'));
  const pictures: Element[] = [mesh.node()!, ...canvases, contour.node()!];
  const cells = pictures.map((element, i) => made('div', 'why-cell', element, words[i]!));
  return { lines, dots, canvases, exact, drawn, words, cells };
}

type SideParts = ReturnType<typeof makeSide>;

/** The colours from one token to another, in 256 steps of red, green and blue. */
function rampOf(from: string, to: string): Uint8ClampedArray {
  const context = made('canvas', '').getContext('2d', { willReadFrequently: true })!;
  const ends = [from, to].map((colour) => {
    context.fillStyle = colour;
    context.fillRect(0, 0, 1, 1);
    return [...context.getImageData(0, 0, 1, 1).data];
  });
  return Uint8ClampedArray.from({ length: 768 }, (_, i) => {
    const [start, end] = ends.map((rgb) => rgb[i % 3]!) as [number, number];
    return start + ((end - start) * Math.floor(i / 3)) / 255;
  });
}

/** Paints a number from 0 to 1 for each pixel. */
function paint(canvas: HTMLCanvasElement, values: Float32Array, ramp: Uint8ClampedArray): void {
  const context = canvas.getContext('2d')!;
  const image = context.createImageData(WIDTH, HEIGHT);
  values.forEach((value, pixel) => {
    const step = 3 * Math.round(255 * Math.max(0, Math.min(1, value)));
    for (let k = 0; k < 3; k++) image.data[4 * pixel + k] = ramp[step + k]!;
    image.data[4 * pixel + 3] = 255;
  });
  context.putImageData(image, 0, 0);
}

/** Builds the figure and starts it; `number` is its number. */
export function mountWhy(figureNumber: number): HTMLElement {
  const sides = SIDES.map(makeSide);
  const slider = made('input', '');
  Object.assign(slider, {
    type: 'range',
    min: '0',
    max: `${MOST}`,
    step: '10',
    value: `${AT_FIRST}`,
    id: 'why-scramble',
  });
  const label = made('label', '', 'Scramble');
  label.htmlFor = slider.id;
  const says = made('output', 'why-says');
  says.htmlFor.add(slider.id);
  const rows = USES.map(({ name, words }, i) =>
    made(
      'section',
      'why-use',
      made('h4', '', name),
      made('div', 'why-two', ...sides.map(({ cells }) => cells[i + 1]!)),
      made('p', 'why-words', words),
    ),
  );
  const card = made(
    'div',
    'explain-card',
    made(
      'div',
      'why-two why-meshes',
      ...sides.map(({ cells }, i) => made('div', '', made('h4', '', SIDES[i]!), cells[0]!)),
    ),
    made('div', 'why-slider', label, slider, says),
  );
  const title = made('h3', 'explain-title', made('span', 'explain-number', `${figureNumber}`), 'Why it is better');
  const words = made(
    'p',
    'explain-words',
    'Both meshes have the same points. Scramble flips edges at random, and edgeflip makes round triangles of any of them: always the same ones. Height and heat are known exactly here, so all of the error is the fault of the triangles.',
  );
  const element = made('figure', 'explain-figure why', title, words, card, made('div', 'why-uses', ...rows));
  start(sides, slider, says).catch((error) => {
    says.textContent = 'The engine did not load, so this figure stands still.';
    console.error(error);
  });
  return element;
}

async function start(sides: SideParts[], slider: HTMLInputElement, says: HTMLOutputElement): Promise<void> {
  const best = await round();
  const slopes = slopesOf(WIDTH, HEIGHT);
  const exact = contours(fine(), LEVELS).pieces.map((piece) => ({ d: polyline(piece), kind: '' }));
  for (const side of sides) {
    drawDots(side.dots, best.points, 5);
    drawShapes(side.exact, exact);
  }
  const show = (side: SideParts, mesh: Joined) => {
    const colour = colourReader();
    const raster = rasterOf(mesh, WIDTH, HEIGHT);
    const { light, error } = shading(mesh, raster, slopes);
    const warm = heat(mesh);
    const line = contours(mesh, LEVELS);
    const edges = cornersOf(mesh.triangles).map((corners) => `${polyline(corners.map((v) => mesh.points[v]!))}Z`);
    drawShapes(side.lines, [{ d: edges.join(''), kind: 'explain-edge' }]);
    paint(side.canvases[0]!, light, rampOf(colour('shaded'), colour('lit')));
    const most = Math.max(...warm.values);
    const bands = interpolated(mesh, raster, warm.values).map((value) => Math.floor((BANDS * value) / most) / BANDS);
    paint(side.canvases[1]!, bands, rampOf(colour('shaded'), colour('lit')));
    drawShapes(side.drawn, [{ d: line.pieces.map(polyline).join(''), kind: '' }]);
    const backwards = warm.backwards === 0 ? '' : `. On ${warm.backwards} edges it flows from cold to hot.`;
    [
      `Smallest angle on average: ${meanSmallest(mesh).toFixed(0)}°`,
      off(error, '°'),
      off(warm.error, ' %') + backwards,
      off(line.error, ' %'),
    ].forEach((text, i) => (side.words[i]!.textContent = text));
  };
  let isBusy = false;
  let shown = -1;
  const update = async (): Promise<void> => {
    if (isBusy) return;
    isBusy = true;
    try {
      while (shown !== slider.valueAsNumber) {
        const flips = slider.valueAsNumber;
        shown = flips;
        const mesh = thinned(best, flips);
        const made = await healed(mesh);
        show(sides[0]!, mesh);
        show(sides[1]!, made);
        const text = `${number.format(flips)} flips at random, healed by ${number.format(made.flips)} flips in ${made.iterations} iterations`;
        says.textContent = text;
        slider.setAttribute('aria-valuetext', `${number.format(flips)} flips at random`);
        await new Promise(requestAnimationFrame);
      }
    } finally {
      isBusy = false;
    }
  };
  const fail = (error: unknown) => console.error(error);
  slider.addEventListener('input', () => update().catch(fail));
  onTheme(() => {
    shown = -1;
    update().catch(fail);
  });
  await update();
}
