// Stamps: what a level or a build depended on when it last passed. If nothing of it has changed, it is not run again.
// A stamp is the digest of the level's commands, the files that it reads, the versions of the tools that it uses, and
// the variables of the environment. Stamps are in target/test/stamps.json.

import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { mkdirSync, readdirSync, readFileSync, readlinkSync, statSync, writeFileSync } from 'node:fs';
import { join, posix } from 'node:path';

const FILE = 'target/test/stamps.json';
/** Folders that no level reads as a whole: what is installed or built there comes from lock files and other levels. */
const LEFT_OUT = /^(\.git|target|dist|node_modules|fuzz\/target|tests\/(bundlers|peers)\/(node_modules|projects-.*))$/;
/** Variables that may change the result of a level. */
const VARIABLES = /^(EDGEFLIP|RUST|CARGO|VK|MESA|LIBGL|GALLIUM|LP|WGPU|CHROM|FIREFOX|MOZ|NODE|PROPTEST|CI$)/;

const sha256 = (...parts) => parts.reduce((hash, part) => hash.update(part), createHash('sha256')).digest('hex');

/** The files of the repository with their digests, found once. */
let files;
function repository() {
  if (files) return files;
  files = new Map();
  collect('.', (path) => !LEFT_OUT.test(path), files);
  return files;
}

function collect(folder, isWanted, into) {
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    const path = posix.join(folder, entry.name);
    if (!isWanted(path)) continue;
    if (entry.isDirectory()) collect(path, isWanted, into);
    else into.set(path, sha256(entry.isSymbolicLink() ? readlinkSync(path) : readFileSync(path)));
  }
}

/** The digest of the files at these paths; a path with `!` before it leaves out what is there. */
function filesAt(paths) {
  const isAt = (file) => (path) => path === '.' || file === path || file.startsWith(`${path}/`);
  const [out, wanted] = [paths.filter((path) => path.startsWith('!')).map((path) => path.slice(1)), paths];
  const found = [...repository()].filter(([file]) => wanted.some(isAt(file)) && !out.some(isAt(file)));
  return sha256(...found.sort(([a], [b]) => (a < b ? -1 : 1)).map(([file, digest]) => `${digest} ${file}\n`));
}

/** The digest of what a build has written: a file or a folder, or a word if it is not there. */
export function outputAt(path) {
  const found = new Map();
  try {
    if (statSync(path).isDirectory()) collect(path, () => true, found);
    else found.set(path, sha256(readFileSync(path)));
  } catch {
    return 'missing';
  }
  return sha256(...[...found].sort().map(([file, digest]) => `${digest} ${file}\n`));
}

const said = (program, ...args) => {
  const { status, stdout } = spawnSync(program, args, { encoding: 'utf8' });
  return status === 0 ? stdout.trim() : 'missing';
};
/** What a program on the PATH is: the first of these names that runs. */
const first = (variable, ...names) => {
  for (const name of process.env[variable] ? [process.env[variable]] : names) {
    const version = said(name, '--version');
    if (version !== 'missing') return version;
  }
  return 'missing';
};

/** The drivers: the files that name them, and the libraries that these name, by size and time. */
function drivers() {
  const folders = ['/usr/share/vulkan/icd.d', '/usr/local/share/vulkan/icd.d', '/etc/vulkan/icd.d'];
  const libraries = [
    '/usr/lib',
    '/usr/lib64',
    '/usr/local/lib',
    `/usr/lib/${process.arch === 'arm64' ? 'aarch64' : 'x86_64'}-linux-gnu`,
  ];
  const found = folders.flatMap((folder) => {
    try {
      return readdirSync(folder).map((file) => readFileSync(join(folder, file), 'utf8'));
    } catch {
      return [];
    }
  });
  const names = [...found.join('\n').matchAll(/"library_path"\s*:\s*"([^"]+)"/g)].map(([, path]) => path);
  const stats = [...names, 'libvulkan.so.1'].flatMap((name) =>
    ['', ...libraries].map((folder) => {
      try {
        const { size, mtimeMs } = statSync(join(folder, name));
        return `${name} ${size} ${mtimeMs}`;
      } catch {
        return '';
      }
    }),
  );
  return [...found, ...stats].join('\n');
}

/** The packages of a folder: those that are asked for, and those that are installed. */
const lockOf = (folder) =>
  ['package-lock.json', 'node_modules/.package-lock.json'].map((file) => outputAt(join(folder, file))).join(' ');

/** What a level can use, and how its version is found. Each is also a part of tools/setup.sh. */
const tools = {
  rust: () => [said('cargo', '-vV'), said('rustc', '-vV')].join('\n'),
  lints: () => [said('cargo', 'fmt', '--version'), said('cargo', 'clippy', '--version')].join('\n'),
  wasm: () => said('bash', 'tools/wasm-cargo.sh', '--which'),
  bindgen: () => said('target/setup/bin/wasm-bindgen', '--version'),
  packages: () => `${process.version} ${lockOf('.')}`,
  bundlers: () => lockOf('tests/bundlers'),
  peers: () => lockOf('tests/peers'),
  vulkan: drivers,
  chromium: () =>
    [
      first(
        'CHROMIUM',
        'chromium',
        'chromium-browser',
        'google-chrome',
        '/Applications/Google Chrome.app/Contents/MacOS/Google Chrome',
      ),
      first('CHROMEDRIVER', 'chromedriver'),
    ].join('\n'),
  firefox: () => first('FIREFOX', 'firefox-esr', 'firefox', '/Applications/Firefox.app/Contents/MacOS/firefox'),
};
/** @type {Map<string, string>} */
const versions = new Map();

/** After a part of the setup has run, the versions are looked up again. */
export const forget = () => versions.clear();

function version(tool) {
  const found = versions.get(tool) ?? tools[tool]();
  versions.set(tool, found);
  return found;
}

/**
 * What a level or a build depends on, as a digest.
 *
 * @param {{ checks: string[][], env?: Record<string, string>, tools: string[], reads: string[], uses: string[] }} level
 */
export function key({ checks, env = {}, tools, reads, uses = [] }) {
  const variables = Object.entries(process.env).filter(([name]) => VARIABLES.test(name));
  const asked = JSON.stringify([checks, env, variables.sort(), tools.map(version)]);
  return sha256(asked, filesAt(reads), ...uses.map(outputAt));
}

const stamps = (() => {
  try {
    return JSON.parse(readFileSync(FILE, 'utf8'));
  } catch {
    return {};
  }
})();

/** What was kept of the level when it last passed with this key. */
export const kept = (name, key) => (stamps[name]?.key === key ? stamps[name] : undefined);

/** Keeps that the level has passed, or forgets it. */
export function keep(name, stamp) {
  stamps[name] = stamp;
  mkdirSync('target/test', { recursive: true });
  writeFileSync(FILE, JSON.stringify(stamps, undefined, 1));
}
