/** What people call the attributes of a file for whose sake edges are locked. */

/** By the names of docs/files.md, in small letters, without a number at the end. */
const WORDS: Record<string, string> = {
  usemtl: 'materials',
  usemap: 'texture maps',
  g: 'groups',
  o: 'objects',
  s: 'smoothing groups',
  mg: 'merging groups',
  vt: 'texture coordinates',
  vn: 'normals',
  texcoord: 'texture coordinates',
  normal: 'normals',
  colour: 'colours',
};

/** `the materials (usemtl)`, or `the attribute “quality”` if the name is not known. */
export function attributeOf(name: string): string {
  const words = WORDS[name.toLowerCase().replace(/_?\d+$/, '')];
  return words ? `the ${words} (${name})` : `the attribute “${name}”`;
}
