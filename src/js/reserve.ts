/** Memory for results. */

/** Words of a page of memory. If the system has larger pages, `reserve` writes each more than once. */
const WORDS_OF_PAGE = 1024;

/**
 * Memory for the indices of a result, or `undefined` if there is not enough. The system provides each page at its first
 * write, which takes longer than the later copy. This writes every page now, while others are busy.
 */
export function reserve(indices: number): Uint32Array | undefined {
  try {
    const words = new Uint32Array(indices);
    for (let i = 0; i < indices; i += WORDS_OF_PAGE) words[i] = 1;
    return words;
  } catch {
    return undefined;
  }
}
