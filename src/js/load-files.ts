/** Loads the module of the entry `edgeflip/files`. */

import initModule from './wasm/edgeflip_files.js';
import { loader } from './module.js';

let isStarted = false;

/** Whether the module is loaded. */
export function areFilesLoaded(): boolean {
  return isStarted;
}

export const loadFiles = loader(
  async (source) => {
    await initModule(source);
    isStarted = true;
  },
  'edgeflip_files_bg.wasm',
  () => new URL('./wasm/edgeflip_files_bg.wasm', import.meta.url),
);
