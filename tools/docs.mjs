// Writes the API reference into target/docs: `npm run docs`. TypeDoc documents the npm package, rustdoc the crate. A
// warning of either is an error.

import { spawnSync } from 'node:child_process';
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { typedocTo } from './typedoc.mjs';

process.chdir(fileURLToPath(new URL('..', import.meta.url)));

const folder = 'target/docs';
const { name, description } = JSON.parse(readFileSync('package.json', 'utf8'));

function run(program, args, env = {}) {
  console.log(`$ ${[program, ...args].join(' ')}`);
  const { status, error } = spawnSync(program, args, { stdio: 'inherit', env: { ...process.env, ...env } });
  if (status === 0) return;
  console.error(`docs: stopped: ${program} failed${error ? `: ${error.message}` : ' (see above)'}`);
  process.exit(1);
}

rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });

run(process.execPath, typedocTo(`${folder}/javascript`));

run('cargo', ['doc', '--no-deps', '--lib'], { RUSTDOCFLAGS: '-D warnings' });
cpSync(`${process.env.CARGO_TARGET_DIR ?? 'target'}/doc`, `${folder}/rust`, { recursive: true });

writeFileSync(
  `${folder}/index.html`,
  `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>${name}</title>
<h1>${name}</h1>
<p>${description}.</p>
<ul>
<li><a href="javascript/index.html">JavaScript and TypeScript</a></li>
<li><a href="rust/edgeflip/index.html">Rust</a></li>
</ul>
`,
);
console.log(`${folder}/index.html`);
