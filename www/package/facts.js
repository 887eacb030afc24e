// What the section "Use it in your project" says, from where it is written or measured: the code from README, docs/ and
// examples/, whose tests run it; the sizes from dist/; the addresses from package.json.

import { readFileSync } from 'node:fs';
import { gzipSync } from 'node:zlib';
import { measured } from '../../tools/sizes.mjs';
import { addresses } from '../documents/site.js';

const text = (path) => readFileSync(new URL(`../../${path}`, import.meta.url), 'utf8');

/** The blocks of code of a language, from a heading on. */
function blocks(path, language, heading = '') {
  const after = text(path).split(`\n${heading}\n`).slice(1).join('\n');
  return Array.from(after.matchAll(new RegExp(`^\`\`\`${language}\n([^]*?)^\`\`\`$`, 'gm')), ([, code]) => code.trim());
}

/** The tabs: how to install it, the code, the source of the code, and the page of the site that has it. */
function snippets() {
  const use = '## Use it';
  const [install, command] = blocks('README.md', 'sh', use);
  const [plain] = blocks('README.md', 'js', use);
  const [three] = blocks('docs/peers.md', 'js', '## three.js');
  const html = (path) => path.replace(/\.md$/, '.html');
  return [
    { name: 'three.js', source: 'docs/peers.md', install, code: three },
    { name: 'JavaScript', source: 'README.md', install, code: plain },
    { name: 'glTF-Transform', source: 'examples/gltf.mjs', install, code: text('examples/gltf.mjs').trim() },
    { name: 'Command line', source: 'README.md', code: command },
    { name: 'Rust', source: 'examples/one_call.rs', code: text('examples/one_call.rs').trim() },
  ].map((tab) => ({ ...tab, page: tab.source.endsWith('.md') ? html(tab.source) : `${tab.source}.html` }));
}

/** Kilobytes after gzip, by the names of tools/sizes.mjs. */
async function sizes() {
  const kilobytes = {};
  for (const [name, bytes] of await measured()) kilobytes[name] = gzipSync(bytes).length / 1024;
  return kilobytes;
}

/** The oldest browsers, as docs/package.md has them. */
function browsers() {
  const [, oldest] = text('docs/package.md').match(/so the package needs ([^;]*) at least;/);
  return oldest;
}

export async function packageFacts() {
  return { snippets: snippets(), kilobytes: await sizes(), browsers: browsers(), addresses: addresses() };
}
