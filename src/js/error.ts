/** The error class of the package. */

/**
 * The kinds of errors.
 *
 * | code | what to do |
 * |---|---|
 * | `invalid-input` | pass a value of the type that the message names, and no array that was transferred |
 * | `non-finite` | repair or remove the vertex that the message names |
 * | `index-out-of-range` | check the indices of the triangle that the message names |
 * | `ragged-array` | check the array's length and the dimension |
 * | `position-count` | give `setPositions` 2 or 3 numbers for each vertex of the mesh |
 * | `triangle-count` | pass as many triangles as the mesh or the file has |
 * | `too-large` | split the mesh, or call `free` on unused sessions: indices have 32 bits, and memory is limited |
 * | `parse` | repair the file at the line, byte or vertex that the message names |
 * | `file-too-large` | pass a larger `maxBytes` if you trust the file |
 * | `unknown-format` | use a file name with one of the extensions in `FORMATS`; to read, also in `POINT_FORMATS` |
 * | `io` | write another format: a coordinate of the vertex that the message names exceeds a 32-bit float |
 * | `invalid-option` | check the option that the message names |
 * | `backend-unavailable` | use `'auto'` or `'cpu'`: this engine is not available here, or it failed its self-test |
 * | `backend-limit` | use `'auto'` or `'cpu'`: the GPU cannot accept this mesh |
 * | `device-failed` | create a new session: the GPU or the given `device` was lost |
 * | `load-failed` | serve the package's `wasm/*.wasm`, or tell `init` where they are |
 * | `freed` | do not use a session after `free`, or after one of its calls crashed or ran out of memory |
 * | `internal` | report it; if a module crashed, reload the page or worker; if a thread crashed, create new sessions |
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

/** Every error of this package. An exception of a callback passes through unchanged. */
export class EdgeflipError extends Error {
  override readonly name = 'EdgeflipError';
  /** The kind of the error. Codes stay the same in every release. */
  readonly code: ErrorCode;

  /** For the package only. */
  constructor(code: ErrorCode, message: string, options?: ErrorOptions) {
    super(message, options);
    this.code = code;
  }
}

/** The message of a module without memory (`out_of_memory` in `src/wasm/values.rs`), also inside a worker's message. */
const OUT_OF_MEMORY = /\bout of memory\b/;

/** The exception of a module as an `EdgeflipError`. A trap has no code. */
export function fromModule(thrown: unknown): EdgeflipError {
  if (thrown instanceof EdgeflipError) return thrown;
  const message = thrown instanceof Error ? thrown.message : String(thrown);
  const given = thrown instanceof Error && 'code' in thrown ? thrown.code : undefined;
  const code = CODES.find((code) => code === given);
  if (code) return new EdgeflipError(code, message, { cause: thrown });
  // JavaScript could not allocate an array.
  const isAllocation = thrown instanceof RangeError && /alloc|length/i.test(message);
  if (!isAllocation && !OUT_OF_MEMORY.test(message)) return new EdgeflipError('internal', message, { cause: thrown });
  const advice = 'WebAssembly has 4 GiB for all meshes: free() sessions that are done, or split the mesh';
  return new EdgeflipError('too-large', `memory ran out (${message}); ${advice}`, { cause: thrown });
}
