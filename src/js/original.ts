/** The files that a mesh was read from. */

/** The bytes of files by name, such as `{ 'scene.bin': bytes }`. */
export type Files = Readonly<Record<string, Uint8Array>>;

/** The file that a mesh was read from, and the options that it was read with. */
export interface Original {
  bytes: Uint8Array;
  name: string;
  files?: Files | undefined;
  maxBytes?: number | undefined;
  coordinates?: 32 | 64 | undefined;
  ignoreAttributes?: readonly string[] | undefined;
}
