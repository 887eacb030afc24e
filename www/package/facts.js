// What the section "Use it in your project" says, from where it is written or measured: the code from README, docs/ and
// examples/, whose tests run it; the sizes from dist/; the addresses from package.json.

import { readFileSync } from 'node:fs';
import { kilobytes } from '../../tools/sizes.mjs';
import { addresses, notPublicIn, titleOf } from '../documents/site.js';

const text = (path) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');

/** The blocks of code of a language, from a heading on, or all. */
function blocks(path, language, heading) {
  const after = heading ? text(path).split(`\n${heading}\n`).slice(1).join('\n') : text(path);
  return Array.from(after.matchAll(new RegExp(`^\`\`\`${language}\n([^]*?)^\`\`\`$`, 'gm')), ([, code]) => code.trim());
}

/** What the tabs load: names of tools/sizes.mjs. */
const CORE = ['edgeflip', 'edgeflip_bg.wasm'];
const withEntry = (entry) => [...CORE, `${entry}, whole`, 'edgeflip_files_bg.wasm'];

/** What a program in Rust needs, with the features that README names. */
function rustNote() {
  const [, oldest] = text('Cargo.toml').match(/^rust-version = "(.*)"$/m);
  return `Rust ${oldest} or newer. The feature “gpu” takes the crate wgpu, and “threads” takes rayon; a few small crates are for exact numbers and vectors. For the reference of the crate, run “cargo doc --open” in the folder of the source.`;
}

/**
 * The tabs: how to install it, the code, the source of the code, the page of the site that has it and its title, and the
 * kilobytes that the code loads.
 */
function snippets(sizes) {
  const sum = (names) => names.reduce((all, name) => all + sizes[name], 0);
  const use = '## Use it';
  const [install, command] = blocks('README.md', 'sh', use);
  const [dependency] = blocks('README.md', 'toml', use);
  const [plain] = blocks('README.md', 'js', use);
  const [points] = blocks('docs/points.md', 'js');
  const [three] = blocks('docs/peers.md', 'js', '## three.js');
  const html = (path) => path.replace(/\.md$/, '.html');
  return [
    { name: 'three.js', source: 'docs/peers.md', install, code: three, loads: sum(withEntry('edgeflip/three')) },
    { name: 'JavaScript', source: 'README.md', install, code: plain, loads: sum(CORE) },
    {
      name: 'glTF-Transform',
      source: 'examples/gltf.mjs',
      install,
      code: text('examples/gltf.mjs').trim(),
      loads: sum(withEntry('edgeflip/gltf-transform')),
    },
    {
      name: 'Points',
      source: 'docs/points.md',
      install,
      code: points,
      loads: sum(['edgeflip/points', 'edgeflip_points_bg.wasm']),
    },
    { name: 'Command line', source: 'README.md', code: command },
    {
      name: 'Rust',
      source: 'examples/one_call.rs',
      install: dependency,
      code: text('examples/one_call.rs').trim(),
      note: rustNote(),
    },
  ].map((tab) =>
    tab.source.endsWith('.md')
      ? { ...tab, title: titleOf(tab.source), page: html(tab.source) }
      : { ...tab, title: tab.source, page: `${tab.source}.html` },
  );
}

/** The oldest browsers, as docs/package.md has them. */
function browsers() {
  const [, oldest] = text('docs/package.md').match(/so the package needs ([^;]*) at least;/);
  return oldest;
}

export async function packageFacts() {
  const named = addresses();
  const sizes = await kilobytes();
  return {
    snippets: snippets(sizes),
    kilobytes: sizes,
    browsers: browsers(),
    addresses: named,
    notPublic: notPublicIn(named),
  };
}
