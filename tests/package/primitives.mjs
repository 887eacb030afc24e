// Reads the primitives of documents of glTF-Transform, for comparisons.

/** All primitives of a document of glTF-Transform. */
export const primitivesOf = (document) =>
  document
    .getRoot()
    .listMeshes()
    .flatMap((mesh) => mesh.listPrimitives());

/** The numbers of an accessor, an array per element. */
const rows = (accessor) => {
  const width = accessor.getElementSize();
  const array = accessor.getArray();
  return Array.from({ length: accessor.getCount() }, (_, i) => [...array.subarray(width * i, width * (i + 1))]);
};

/** The surface of a primitive, as in surfaces.mjs. */
export function surfaceOf(primitive) {
  const position = primitive.getAttribute('POSITION');
  const uv = primitive.getAttribute('TEXCOORD_0');
  const others = primitive.listAttributes().filter((accessor) => accessor !== position);
  const all = [...others, ...primitive.listTargets().flatMap((target) => target.listAttributes())].map(rows);
  return {
    positions: rows(position).flat(),
    records: Array.from({ length: position.getCount() }, (_, i) => JSON.stringify(all.map((row) => row[i]))),
    uvs: uv && rows(uv).flat(),
    indices: [...(primitive.getIndices()?.getArray() ?? Array.from({ length: position.getCount() }, (_, i) => i))],
  };
}
