/**
 * The colours that a file gives its surface: textures, and colours of vertices. It runs in a worker, and is loaded when
 * it is needed.
 */

import { contentOfKept, GLTF, unpacked, type Kept } from './files.ts';
import type { FoundColours, Sizes } from './colour-format.ts';
import { gltfColours } from './gltf-colours.ts';
import { GltfFile } from './gltf-file.ts';
import { coloursOfVertices } from './vertex-colours.ts';

/** The colours of the file of a mesh. */
export async function coloursOf(kept: Kept, sizes: Sizes): Promise<FoundColours> {
  const content = await unpacked(await contentOfKept(kept));
  if (GLTF.test(kept.name)) return gltfColours(await GltfFile.of(content), sizes);
  return { colours: await coloursOfVertices(kept.name, content.bytes, sizes), notes: [] };
}
