/**
 * The service worker. After the first visit to the tool, the page needs no network; and it is cross-origin isolated on
 * any server, so that the threads of the CPU engine can share memory.
 */

import { addPlugins, precacheAndRoute, type PrecacheEntry } from 'workbox-precaching';

/** All files of the page; the build puts them here. */
declare const FILES: PrecacheEntry[];

addPlugins([
  {
    handlerWillRespond: async ({ response }) => {
      const headers = new Headers(response.headers);
      headers.set('Cross-Origin-Opener-Policy', 'same-origin');
      headers.set('Cross-Origin-Embedder-Policy', 'require-corp');
      const { body, status, statusText } = response;
      return new Response(body, { status, statusText, headers });
    },
  },
]);
precacheAndRoute(FILES);
