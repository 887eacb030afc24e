/** The one class of errors. */

/**
 * What an error is about.
 *
 * | code | what to do |
 * |---|---|
 * | `invalid-input` | pass typed arrays that have their memory, strings where text is asked for, and 2 or 3 as the dimension |
 * | `non-finite` | repair or remove the vertex that the message names |
 * | `index-out-of-range` | check the indices of the triangle that the message names |
 * | `ragged-array` | check the array's length and the dimension |
 * | `position-count` | give `setPositions` 2 or 3 numbers for each vertex of the mesh |
 * | `triangle-count` | give `writeMesh` as many triangles as its `original` has |
 * | `too-large` | split the mesh, or call `free` on sessions that are done: more than 32 bits can index, or than there is memory for |
 * | `parse` | repair the file at the line, or the vertex, that the message names |
 * | `file-too-large` | pass a larger `maxBytes`, if the file is to be trusted |
 * | `unknown-format` | take a file name with one of the extensions in `FORMATS` |
 * | `io` | write another format: STL and glTF cannot hold coordinates as large as the message says |
 * | `invalid-option` | check the option that the message names |
 * | `backend-unavailable` | take `'auto'` or `'cpu'`: there is no such GPU here, or it fails its self-test |
 * | `backend-limit` | take `'auto'` or `'cpu'`: the GPU cannot take this mesh |
 * | `device-failed` | begin again: the GPU was lost, or the `device` given is |
 * | `load-failed` | see that the package's `wasm/*.wasm` are served, or tell `init` where they are |
 * | `freed` | do not use a session after `free`, or after a call of it that crashed or ran out of memory |
 * | `internal` | report it: the module has crashed, and is of no use until the page or the worker is loaded anew; or a thread has, and with it the sessions on threads: others begin anew |
 */
export type ErrorCode = (typeof CODES)[number];

const CODES = [
  'invalid-input',
  'non-finite',
  'index-out-of-range',
  'ragged-array',
  'position-count',
  'triangle-count',
  'too-large',
  'parse',
  'file-too-large',
  'unknown-format',
  'io',
  'invalid-option',
  'backend-unavailable',
  'backend-limit',
  'device-failed',
  'load-failed',
  'freed',
  'internal',
] as const;

/** Everything that this package throws by itself. What a callback throws goes through unchanged. */
export class EdgeflipError extends Error {
  override readonly name = 'EdgeflipError';
  /** What the error is about; the same in every release. */
  readonly code: ErrorCode;

  /** Made by the package. */
  constructor(code: ErrorCode, message: string, options?: ErrorOptions) {
    super(message, options);
    this.code = code;
  }
}

/** What a module says where memory cannot be had, `out_of_memory` in `src/wasm/values.rs`, and what workers make of it. */
const OUT_OF_MEMORY = /\bout of memory\b/;

/** What the module has thrown, as an `EdgeflipError`. A trap has no code. */
export function fromModule(thrown: unknown): EdgeflipError {
  if (thrown instanceof EdgeflipError) return thrown;
  const message = thrown instanceof Error ? thrown.message : String(thrown);
  const given = thrown instanceof Error && 'code' in thrown ? thrown.code : undefined;
  const code = CODES.find((code) => code === given);
  if (code) return new EdgeflipError(code, message, { cause: thrown });
  // Of an array that JavaScript cannot have.
  const isOfArray = thrown instanceof RangeError && /alloc|length/i.test(message);
  if (!isOfArray && !OUT_OF_MEMORY.test(message)) return new EdgeflipError('internal', message, { cause: thrown });
  const advice = 'WebAssembly has 4 GiB for all meshes: free() sessions that are done, or split the mesh';
  return new EdgeflipError('too-large', `memory ran out (${message}); ${advice}`, { cause: thrown });
}
