// The levels of tests and the builds that they need: `npm test` runs all of them, `npm run test:full` with more cases.

import { readdirSync, readFileSync } from 'node:fs';
import { crate, firstSentence, locks, nativeLevels } from './native-levels.mjs';

/**
 * A level, or a build: `checks` are its command lines. A command that begins with `@` is a program that the build
 * `native programs` has compiled. If `counts` is set, the commands run the test harness of Rust or Node, and each of
 * its tests counts; otherwise each command counts as one test, and the commands of a build as none.
 * @typedef {object} Level
 * @property {string} name
 * @property {string} what
 * @property {string[][]} checks
 * @property {Record<string, string>} [env]
 * @property {boolean} [counts]
 * @property {string[]} tools - What it runs; also the parts of tools/setup.sh that it needs.
 * @property {string[]} reads - The files and folders of the repository that it reads; `!PATH` leaves out a path.
 * @property {string[]} [after] - The builds and levels that have to pass first.
 * @property {string[]} [uses] - What these have written, of what it reads.
 * @property {string[]} [writes] - What it writes for others; only a build, or a level that others come after.
 * @property {string[]} [holds] - What only one level may use at a time: the folders that cargo locks.
 * @property {boolean} [isPlain] - It needs neither a GPU nor the command line.
 * @property {boolean} [isAlone] - It measures time, so nothing may run beside it.
 * @property {RegExp} [refuses] - What its output may not contain.
 * @property {boolean} [isBuild]
 */

export const isFull = process.argv.includes('--full');
// tests/full.mjs reads it, and the tests in Rust.
if (isFull) Object.assign(process.env, { EDGEFLIP_FULL: '1', EDGEFLIP_QUADS: '1000000' });

const scripts = ['package.json', 'package-lock.json'];

// Formats and lints JavaScript and TypeScript, as biome.json says.
const biome = ['node', 'node_modules/@biomejs/biome/bin/biome', 'ci'];
const wasmCargo = ['bash', 'tools/wasm-cargo.sh'];
const wasmWith = (features) => ['--target', 'wasm32-unknown-unknown', '--no-default-features', '--features', features];

const files = (folder, names) => names.map((name) => `tests/${folder}/${name}.test.mjs`);
/** Files of tests in a folder, each in a process of its own. */
const apart = (folder, names) => [
  ...['node', '--test', '--test-reporter=tap', '--test-concurrency=1'],
  ...files(folder, names),
];
/** Files of tests that share a browser and its pages. */
const together = (...paths) => ['node', '--test-reporter=tap', 'tests/together.mjs', ...paths];
const testsIn = (folder) =>
  readdirSync(`tests/${folder}`).flatMap((file) => file.match(/^(.*)\.test\.mjs$/)?.[1] ?? []);

// A new file of tests is in a level by its name.
const inBrowsers = testsIn('package').filter((file) => file.endsWith('.browser'));
const inFull = testsIn('package').filter((file) => file.endsWith('.full'));
const inNode = testsIn('package').filter((file) => !file.includes('.'));
const alone = ['firefox', 'handover', 'large', 'offline'];
/** Last, because they lose the GPU of the page that they share, and its kernels. */
const onPage = testsIn('page').filter((file) => ![...alone, 'controls', 'opening'].includes(file));
onPage.push('controls', 'opening');

/** What the tests in browsers share. */
const shared = ['browsers.mjs', 'engine-page.mjs', 'engines.html', 'full.mjs', 'together.mjs'].map(
  (file) => `tests/${file}`,
);

/** @type {Level[]} */
const builds = [
  {
    name: 'native programs',
    what: 'the tests in Rust compile, and the command line',
    checks: [['node', 'tools/test/programs.mjs']],
    tools: ['rust'],
    reads: [
      ...crate,
      ...locks,
      'tools/glsl',
      'shaders/webgl2',
      'tests',
      'examples',
      'fuzz',
      '!tests/package',
      '!tests/page',
      '!tests/bundlers',
      '!tests/peers',
    ],
    writes: ['target/test/programs.json'],
    holds: ['target'],
  },
  {
    name: 'package',
    what: 'the npm package builds without a warning, and is within its sizes',
    checks: [['node', 'tools/build.mjs']],
    // What rustc says of every build with threads is no lint.
    refuses: /^warning: (?!unstable feature specified|`edgeflip` \(lib\) generated 1 warning$).*/m,
    tools: ['rust', 'wasm', 'bindgen', 'packages'],
    reads: [
      'src',
      '!src/bin',
      'shaders',
      'build.rs',
      'tools/build.mjs',
      'tools/sizes.mjs',
      'tools/wasm-cargo.sh',
      'tools/glsl',
      ...locks,
      ...scripts,
    ],
    writes: ['dist'],
    holds: ['target/wasm', 'target/wasm-threads'],
  },
  {
    name: 'page',
    what: 'the types of the page are right, and it builds',
    checks: [
      ['node', 'node_modules/typescript/bin/tsc', '-p', 'www'],
      ['node', 'node_modules/vite/bin/vite.js', 'build', '-c', 'www/vite.config.js'],
    ],
    tools: ['packages'],
    reads: [
      ...['www', 'shaders', 'docs', 'src/js', 'examples', 'benches/results', 'tools/sizes.mjs', 'tools/typedoc.mjs'],
      ...['README.md', 'CHANGELOG.md', 'CONTRIBUTING.md', 'SECURITY.md', 'LICENSE-MIT', 'LICENSE-APACHE', ...scripts],
    ],
    after: ['package'],
    uses: ['dist'],
    writes: ['target/www', 'target/public'],
  },
];
for (const build of builds) build.isBuild = true;

/** @type {Level[]} */
const levels = [
  {
    name: 'formatting',
    what: 'rustfmt and Biome would change nothing',
    checks: [
      ['cargo', 'fmt', '--all', '--check'],
      [...biome, '--linter-enabled=false'],
    ],
    tools: ['rust', 'lints', 'packages'],
    reads: ['.'],
  },
  {
    name: 'layout',
    what: 'imports run down the rooms of docs/architecture.md, no files import each other in a circle, no file is too long',
    checks: [['node', 'tools/layout.mjs']],
    tools: [],
    reads: ['.'],
  },
  {
    name: 'lints',
    what: 'Biome gives no warning',
    checks: [[...biome, '--formatter-enabled=false', '--error-on-warnings']],
    tools: ['packages'],
    reads: ['.', '!src/bin', '!src/engine', '!src/io'],
  },
  ...nativeLevels(isFull),
  {
    name: 'clippy',
    what: 'clippy gives no warning; Cargo.lock fits Cargo.toml',
    checks: [
      [
        'cargo',
        'clippy',
        '--locked',
        '--workspace',
        ...['--lib', '--bins', '--tests', '--examples'],
        '--bench',
        '*',
        '--',
        '-D',
        'warnings',
      ],
    ],
    tools: ['rust', 'lints'],
    reads: [
      ...crate,
      ...locks,
      'clippy.toml',
      'tools/glsl',
      'tests',
      'examples',
      'benches',
      'fuzz',
      '!tests/package',
      '!tests/page',
      '!tests/bundlers',
      '!tests/peers',
    ],
    holds: ['target'],
  },
  {
    name: 'docs',
    what: 'the API reference of both languages builds without a warning or a dead link',
    checks: [['node', 'tools/docs.mjs']],
    tools: ['rust', 'packages'],
    reads: [...crate, 'src/js', ...locks, ...scripts, 'tools/docs.mjs', 'tools/typedoc.mjs'],
    holds: ['target'],
  },
  {
    name: 'wasm in Chromium',
    what: firstSentence(readFileSync('tests/wasm.rs', 'utf8')),
    checks: [[...wasmCargo, 'test', '--test', 'wasm', '--test', 'worker', ...wasmWith('gpu,js')]],
    counts: true,
    env: {
      CHROMEDRIVER: process.env.CHROMEDRIVER ?? 'chromedriver',
      CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER: `${process.cwd()}/target/setup/bin/wasm-bindgen-test-runner`,
      WASM_BINDGEN_TEST_TIMEOUT: '600',
    },
    tools: ['rust', 'wasm', 'bindgen', 'chromium'],
    reads: [
      'src',
      '!src/js',
      '!src/bin',
      '!src/io',
      'shaders',
      'build.rs',
      ...locks,
      'tests/wasm.rs',
      'tests/worker.rs',
      'tests/wasm',
      'tests/native/meshes',
      'tools/wasm-cargo.sh',
      'webdriver.json',
    ],
    holds: ['target/wasm'],
  },
  {
    name: 'npm package',
    what: 'the types pass strict TypeScript; the tests of the package, and the code in README and docs/, run in Node on the CPU engine',
    checks: [['node', 'node_modules/typescript/bin/tsc', '-p', 'tests/package'], apart('package', inNode)],
    counts: true,
    tools: ['packages'],
    reads: [
      'tests/package',
      'tests/browsers.mjs',
      'tests/full.mjs',
      'README.md',
      'docs',
      'examples',
      'src/js',
      'CHANGELOG.md',
      'tools',
      ...scripts,
    ],
    after: ['package'],
    uses: ['dist'],
  },
];
levels.push(
  {
    name: 'npm package in browsers',
    what: 'the parity matrix, quads and locks on each engine in Chromium and Firefox; the packed package in fresh projects: plain pages, Vite, webpack, Parcel, TypeScript',
    checks: [together('tests/engines.test.mjs', ...files('package', inBrowsers))],
    counts: true,
    tools: ['packages', 'bundlers', 'vulkan', 'chromium', 'firefox'],
    reads: [
      ...['tests/package', 'tests/bundlers', 'tests/engines.test.mjs', 'tests/parity', 'tests/quads', ...shared],
      ...['README.md', 'docs', 'examples', ...scripts],
    ],
    after: ['package', 'parity'],
    uses: ['dist', 'target/parity.json', 'target/quads'],
  },
  ...fullLevels(),
  ...pageLevels(),
);

/** The levels of the demo page. */
function pageLevels() {
  const page = {
    counts: true,
    reads: ['tests/page', ...shared, 'www', 'README.md', 'docs', 'examples', 'benches/results', 'tools', ...scripts],
    after: ['page'],
    uses: ['dist', 'target/www', 'target/public'],
  };
  return [
    {
      ...page,
      name: 'page in Chromium',
      what: 'the demo page opens files, plays, scrubs and downloads on every engine, draws from the buffer that the flips write, and recovers',
      checks: [together(...files('page', onPage))],
      tools: ['packages', 'chromium'],
    },
    ...(isFull
      ? [
          {
            ...page,
            name: 'page in Firefox',
            what: 'the demo page opens a file, plays and scrubs on every engine',
            checks: [together('tests/page/firefox.test.mjs')],
            tools: ['packages', 'vulkan', 'firefox'],
          },
        ]
      : []),
    {
      ...page,
      name: 'page without a network',
      what: 'the demo page needs no network and no headers after the first visit, in Chromium',
      checks: [together('tests/page/offline.test.mjs')],
      tools: ['packages', 'chromium'],
    },
    {
      ...page,
      name: 'page with a large mesh',
      what: 'the demo page plays 720,000 triangles in Chromium as the package in Node does, without a long task',
      checks: [together('tests/page/large.test.mjs')],
      after: ['page', 'native programs'],
      tools: ['packages', 'chromium'],
      isAlone: true,
    },
    {
      ...page,
      name: 'handover of the page',
      what: 'the demo page hands a run over to the GPU when its kernels are ready',
      checks: [together('tests/page/handover.test.mjs')],
      tools: ['packages', 'chromium'],
    },
  ];
}

/** The levels that only the full run has. */
function fullLevels() {
  if (!isFull) return [];
  const wasm32 = [
    ['gpu'],
    ['js-webgl2'],
    ['js-threads', '--threads'],
    ['js-untangle'],
    ['js-audit'],
    ['js-files'],
    ['js-points'],
    ['js-point-session'],
    ['js-points-threads', '--threads'],
    ['gpu,js', '--test', 'wasm', '--test', 'worker'],
  ];
  return [
    {
      name: 'wasm32',
      what: 'clippy gives no warning for the library in a browser: without exports for JavaScript, and as each module of the package',
      checks: wasm32.map(([features, ...options]) => {
        const [threads, tests] = [
          options.filter((option) => option === '--threads'),
          options.filter((option) => option !== '--threads'),
        ];
        return [...wasmCargo, ...threads, 'clippy', '--lib', ...tests, ...wasmWith(features), '--', '-D', 'warnings'];
      }),
      tools: ['rust', 'lints', 'wasm'],
      reads: [],
      holds: ['target/wasm', 'target/wasm-threads'],
    },
    {
      name: 'npm package in projects',
      what: 'the packed package in projects of every bundler and runtime of docs/package.md',
      checks: [apart('package', inFull)],
      counts: true,
      tools: ['packages', 'peers', 'chromium'],
      reads: [],
      after: ['package'],
    },
  ];
}

/** The builds, and the levels of this run. */
export const jobs = [...builds, ...levels];

/** What replaces `native programs` where no level needs a GPU or the command line. */
export const lightPrograms = {
  checks: [['node', 'tools/test/programs.mjs', 'light']],
  writes: ['target/test/light.json'],
};
