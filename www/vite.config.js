// Serves the page while somebody works on it, and builds it into target/www: static files that any server can serve.

import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const at = (path) => fileURLToPath(new URL(path, import.meta.url));

// The policy of the page is that of its workers too, which only a header tells them.
const [, policy] = readFileSync(at('index.html'), 'utf8').match(/content="(default-src [^"]*)"/);

// While somebody works on the page, Vite inserts imported styles into it.
const whileWorking = (text) => text.replace("style-src 'self'", "style-src 'self' 'unsafe-inline'");

// Isolated, so that the threads of the CPU engine may share memory.
const headersWith = (policy) => ({
  'Content-Security-Policy': policy,
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Embedder-Policy': 'require-corp',
});

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
  plugins: [{ name: 'policy-while-working', apply: 'serve', transformIndexHtml: whileWorking }],
  server: { headers: headersWith(whileWorking(policy)), fs: { allow: [at('..')] } },
  preview: { headers: headersWith(policy) },
  build: {
    outDir: at('../target/www'),
    emptyOutDir: true,
    target: 'es2022',
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1500,
  },
});
