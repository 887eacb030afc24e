/** The pictures that a glTF file names. It runs in a worker, and is loaded when there may be some. */

import { bytesNow, folderOf, plain, unpacked, type Content, type Located } from './files.ts';
import { chunksOf, isData, nameOf } from './gltf-file.ts';

/** Adds the pictures among `files`, which were opened together with the glTF file `main`, to its content. */
export async function addPictures(content: Content, main: Located, files: readonly Located[]): Promise<void> {
  const { json } = chunksOf((await unpacked(content)).bytes);
  for (const { uri } of json.images ?? []) {
    if (uri === undefined || isData(uri)) continue;
    const found = files.find(({ path }) => path === plain(folderOf(main.path) + nameOf(uri)));
    if (found) content.beside.set(nameOf(uri), bytesNow(found));
  }
}
