// Compiles the tests in Rust, and writes the path of each program and the folder that it runs in to target/test: cargo
// would look for changes again before each of them. `programs.mjs light` compiles those without a GPU and a command
// line only, in a fraction of the time.

import { spawn } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import { dirname } from 'node:path';
import { createInterface } from 'node:readline';

const isLight = process.argv[2] === 'light';
const light = ['--no-default-features', '--features', 'files,threads', '--test', 'native'];
// glsl, so that both find naga with the same features.
const both = ['--package', 'edgeflip', '--package', 'glsl', '--lib', '--bins', '--tests'];
const args = ['test', '--no-run', '--message-format=json-render-diagnostics', ...(isLight ? light : both)];
console.log(`$ cargo ${args.join(' ')}`);
const cargo = spawn('cargo', args, { stdio: ['ignore', 'pipe', 'inherit'] });
const programs = {};
for await (const line of createInterface({ input: cargo.stdout })) {
  const { executable, target, manifest_path, profile } = JSON.parse(line);
  if (!executable || !profile.test) continue;
  const [kind] = target.kind;
  const name = kind === 'test' ? target.name : `${kind === 'bin' ? 'bin' : 'lib'} ${target.name}`;
  programs[name] = { program: executable, cwd: dirname(manifest_path) };
}
cargo.on('close', (status) => {
  process.exitCode = status === 0 ? 0 : 1;
  mkdirSync('target/test', { recursive: true });
  if (status === 0) writeFileSync(`target/test/${isLight ? 'light' : 'programs'}.json`, JSON.stringify(programs));
});
