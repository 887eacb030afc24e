/** The pictures that a glTF file names. It runs in a worker, and is loaded when there may be some. */

import { bytesNow, folderOf, plain, unpacked, type Content, type Located } from './files.ts';
import { chunksOf, isData, nameOf } from './gltf-file.ts';

/**
 * Adds the pictures among `files`, which were opened together with the glTF file `main`, to its content. Without those that
 * cannot be read, the mesh opens nevertheless.
 */
export async function addPictures(content: Content, main: Located, files: readonly Located[]): Promise<void> {
  const json = await unpacked(content).then(
    ({ bytes }) => chunksOf(bytes).json,
    () => undefined,
  );
  for (const { uri } of json?.images ?? []) {
    if (uri === undefined || isData(uri)) continue;
    const found = files.find(({ path }) => path === plain(folderOf(main.path) + nameOf(uri)));
    try {
      if (found) content.beside.set(nameOf(uri), bytesNow(found));
    } catch {
      // The note about its texture says that it is missing.
    }
  }
}
