/** The section "Use it in your project": code, sizes, browsers, and links to everything else. */

import './package.css';
import facts from 'virtual:package';
import { made } from '../shell/elements.ts';
import { tabs } from './tabs.ts';

const LEDE =
  'Rust compiled to WebAssembly, with shaders for WebGPU and WebGL2. The npm package needs no other package.';

const UNRELEASED =
  'Not released yet: you can try it on this page. The lines that install it are for a copy of the source, and later for the release.';

const PROMISES = [
  ['Same points', 'Colours, normals and all other data of the points stay valid.'],
  ['Exact', 'No rounding error can flip an edge. If both diagonals are equally good, the edge stays.'],
  ['Same bits everywhere', 'Every engine gives the same triangles, in every run.'],
  ['It says what stayed', 'The result counts the edges that could not flip, and says why.'],
] as const;

const CREDITS =
  'Bunny: Stanford 3D Scanning Repository, from the package bunny, public domain. Flange: made with manifold-3d, Apache-2.0. Terrain: made with simplex-noise, MIT. Suzanne: from the package @pmndrs/assets, CC0. Type: Inter, OFL 1.1.';

const kilobytes = (...names: string[]) => `${names.reduce((sum, name) => sum + facts.kilobytes[name]!, 0)} KB`;

/** It reads files, and joins vertices. */
const FILES = 'edgeflip_files_bg.wasm';

/** What a program loads, and how much that is. */
const SIZES = [
  ['edgeflip', kilobytes('edgeflip', 'edgeflip_bg.wasm')],
  ['+ for three.js', kilobytes('edgeflip/three, whole', FILES)],
  ['+ for glTF-Transform', kilobytes('edgeflip/gltf-transform, whole', FILES)],
  ['+ to run in a worker', kilobytes('edgeflip/worker')],
  ['+ CPU on several threads', kilobytes('edgeflip_threads_bg.wasm')],
  ['+ to untangle points that move', kilobytes('edgeflip_untangle_bg.wasm')],
  ['+ WebGL2', kilobytes('scripts of WebGL2', 'edgeflip_webgl2_bg.wasm')],
  ['+ to read and write files', kilobytes('edgeflip/files', FILES)],
  ['edgeflip/points, by itself', kilobytes('edgeflip/points', 'edgeflip_points_bg.wasm')],
] as const;

const JOINING = `three.js and glTF-Transform take the part for files too (${kilobytes(FILES)}), because they join vertices at the same position. With “weld: false”, they do not.`;

/** Puts the section into `host`. */
export function mountPackage(host: HTMLElement): void {
  const promises = PROMISES.map(([what, says]) => made('li', '', made('b', '', what), says));
  const columns = made('div', 'package-columns', tabs(facts.snippets), made('ul', 'package-promises', ...promises));
  const below = made('div', 'package-below', sizes(), browsers(), ways());
  const licence = made('p', 'foot', 'edgeflip is free: ', link('LICENSE-MIT.html', 'MIT'), ' or ');
  const notPublic = facts.notPublic ? `${facts.notPublic} ` : '';
  licence.append(link('LICENSE-APACHE.html', 'Apache-2.0'), `. ${notPublic}${CREDITS}`);
  const heading = made('h2', '', 'Use it in your project');
  const lede = facts.notPublic ? `${LEDE} ${UNRELEASED}` : LEDE;
  host.append(heading, made('p', 'lede', lede), columns, below, licence);
}

function link(to: string, words: string): HTMLAnchorElement {
  const a = made('a', '', words);
  a.href = to;
  return a;
}

function part(title: string, ...contents: Node[]): HTMLElement {
  return made('section', '', made('h3', '', title), ...contents);
}

function sizes(): HTMLElement {
  const rows = SIZES.map(([what, size]) => {
    const head = made('th', '', what);
    head.scope = 'row';
    return made('tr', '', head, made('td', '', size));
  });
  const note = `After gzip, measured when this page was built. A part is loaded once, when it is first used. ${JOINING}`;
  const times = made('p', 'package-note', link('#engines', 'Times of a GPU and a CPU, and of your computer'));
  return part('What it costs', made('table', '', made('tbody', '', ...rows)), made('p', 'package-note', note), times);
}

function browsers(): HTMLElement {
  const items = [
    `${facts.browsers}, or newer.`,
    'With WebGPU, large meshes flip on the GPU. Without it, the CPU flips them. The triangles are the same.',
    'Threads need a cross-origin isolated page.',
    'Node 20.19 or newer, Bun and Deno.',
    'Natively as a Rust crate and on the command line.',
  ];
  const more = made('p', 'package-note', link('docs/package.html', 'Bundlers, threads and policies'));
  return part('Where it runs', made('ul', '', ...items.map((item) => made('li', '', item))), more);
}

/** The ways out. */
function ways(): HTMLElement {
  const { repository, homepage } = facts.addresses;
  const links = [
    ...(repository ? [link(repository, 'Source code')] : []),
    ...(homepage ? [link(homepage, 'Package')] : []),
    link('api/index.html', 'JavaScript API'),
    link('README.html', 'Documents'),
    link('docs/options.html', 'All options'),
    link('examples/index.html', 'Examples'),
    link('docs/comparison.html', 'Other libraries'),
    link('docs/benchmarks.html', 'Benchmarks'),
    link('CHANGELOG.html', 'Changes'),
  ];
  const list = made('ul', 'package-ways', ...links.map((a) => made('li', '', a)));
  const until = 'Until then, the API, the documents and the examples with their sources are here.';
  return part('Read on', ...(facts.notPublic ? [made('p', 'package-until', `${facts.notPublic} ${until}`)] : []), list);
}
