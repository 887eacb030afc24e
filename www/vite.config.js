// Builds the page into target/www: static files that any server can serve.

import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const at = (path) => fileURLToPath(new URL(path, import.meta.url));

export default defineConfig({
  root: at('.'),
  base: './',
  resolve: {
    alias: [
      { find: /^edgeflip$/, replacement: at('../dist/index.js') },
      { find: /^edgeflip\/files$/, replacement: at('../dist/files.js') },
    ],
  },
  worker: { format: 'es' },
  build: {
    outDir: at('../target/www'),
    emptyOutDir: true,
    target: 'es2022',
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1500,
  },
});
