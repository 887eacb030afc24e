/** The programs of the WebGL2 engine by their names: what tools/glsl writes into the package. */
declare const programs: Record<string, string>;
export default programs;
