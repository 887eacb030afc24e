// Serves the pages of this folder: `npm run examples`.

import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const at = (path) => fileURLToPath(new URL(path, import.meta.url));

export default defineConfig({
  root: at('.'),
  cacheDir: at('../target/vite/examples'),
  // In a project of your own, `edgeflip` is in node_modules, and these lines are not needed.
  resolve: {
    alias: [
      { find: /^edgeflip$/, replacement: at('../dist/index.js') },
      { find: /^edgeflip\/(.*)$/, replacement: at('../dist/$1.js') },
    ],
  },
  server: {
    fs: { allow: [at('..')] },
    // With these headers, the CPU engine uses all cores.
    headers: { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' },
  },
});
