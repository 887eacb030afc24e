/** The module of the engines, in gzip, as base64. Written by tools/build.mjs. */
declare const core: string;
export default core;
