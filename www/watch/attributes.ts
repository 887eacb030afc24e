/** What people call the attributes of a file for whose sake edges stay. */

/** By their names in files, in small letters, without a number at the end. */
const WORDS: Record<string, string> = {
  usemtl: 'materials',
  material: 'materials',
  usemap: 'texture maps',
  g: 'groups',
  o: 'objects',
  s: 'smoothing groups',
  mg: 'merging groups',
  vt: 'texture coordinates',
  vn: 'normals',
  texcoord: 'texture coordinates',
  normal: 'normals',
  tangent: 'tangents',
  colour: 'colours',
  color: 'colours',
  red: 'colours',
  green: 'colours',
  blue: 'colours',
};

/** `materials` for `usemtl`; `undefined` if the name is not known. */
export const wordsFor = (name: string): string | undefined => WORDS[name.toLowerCase().replace(/_?\d+$/, '')];

/** `the materials (usemtl)`, or `the attribute “quality”` if the name is not known. */
export function attributeOf(name: string): string {
  const words = wordsFor(name);
  return words ? `the ${words} (${name})` : `the attribute “${name}”`;
}
