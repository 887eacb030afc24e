#!/usr/bin/env bash
# One expects: a worker that loads two scripts by `import()`, one after the other, can run both, whatever these two import.
# What happens in Parcel 2.16: if both import a third module of 20,000 bytes or more, the worker's first `import()` rejects
# with "Cannot find module". Parcel moves such a module into a bundle of its own, which both load by `importScripts`; there
# it runs, but nothing registers it under its name. Below that size each script gets a copy, and all is well. So is it with
# the bundler's setting `disableSharedBundles`.
# Why it matters: the build says nothing, the error comes only when the worker loads the script, and a module that grows
# from 19 KB to 21 KB breaks a program whose imports nobody has changed. A library cannot choose the setting for its users.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >npm.log
npm install --ignore-scripts --no-audit --no-fund parcel@2.16.4 >>npm.log 2>&1
cat >index.html <<'HTML'
<!doctype html>
<title>app</title>
<body><script type="module" src="./main.js"></script></body>
HTML
cat >main.js <<'JS'
const worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
worker.onmessage = ({ data }) => document.body.append(data);
worker.postMessage('start');
JS
cat >worker.js <<'JS'
onmessage = async () => {
  try {
    const { one } = await import('./one.js');
    const { two } = await import('./two.js');
    postMessage(`${one()} and ${two()}`);
  } catch (error) {
    postMessage(String(error).replace(/'.*'/, '...'));
  }
};
JS
echo "import { at } from './table.js'; export const one = () => at(1);" >one.js
echo "import { at } from './table.js'; export const two = () => at(2);" >two.js
cat >run.mjs <<'JS'
// Runs the worker as a browser does: a classic script, in which importScripts runs others in the same scope.
import { readdirSync, readFileSync } from 'node:fs';
import { createContext, runInContext } from 'node:vm';

const bundles = readdirSync('out').filter((name) => /^worker\..*\.js$/.test(name));
const name = bundles.find((name) => readFileSync(`out/${name}`, 'utf8').includes('onmessage'));
const at = (url) => `out/${new URL(url, 'https://app/').pathname}`;
const run = (url) => runInContext(readFileSync(at(url), 'utf8'), scope, { filename: new URL(url, 'https://app/').href });
const scope = createContext({ URL, setTimeout, importScripts: (...urls) => urls.forEach(run) });
const said = new Promise((resolve) => Object.assign(scope, { postMessage: resolve }));
run(`./${name}`);
scope.onmessage({ data: 'start' });
console.log(await said);
JS
build() { # ROWS of 10 bytes, SETTINGS
  node -e "
    const rows = Array.from({ length: $1 }, (_, i) => String(i).padStart(8, ' ') + ',\n').join('');
    require('fs').writeFileSync('table.js', 'export const table = [' + rows + '];\nexport const at = (i) => table[i];\n');
    require('fs').writeFileSync('package.json', JSON.stringify({ name: 'app', ...$2 }));"
  rm -rf out
  node_modules/.bin/parcel build index.html --dist-dir out --no-cache --cache-dir cache --public-url ./ >build.log 2>&1
}
{
  echo "Parcel $(node -p "require('./node_modules/parcel/package.json').version")"
  build 1900 '{}'
  echo "a common module of 19 KB: $(node run.mjs)"
  build 2100 '{}'
  echo "a common module of 21 KB: $(node run.mjs)"
  build 2100 '{ "@parcel/bundler-default": { disableSharedBundles: true } }'
  echo "the same, disableSharedBundles: $(node run.mjs)"
} | tee output.txt
diff output.txt - <<'EXPECTED'
Parcel 2.16.4
a common module of 19 KB: 1 and 2
a common module of 21 KB: Error: Cannot find module ...
the same, disableSharedBundles: 1 and 2
EXPECTED
