/** Tells results apart. */

/** The SHA-256 of the triangles, as 32-bit little-endian words. */
export async function digestOf(indices: Uint32Array): Promise<string> {
  const digest = await crypto.subtle.digest('SHA-256', indices as Uint32Array<ArrayBuffer>);
  return Array.from(new Uint8Array(digest), (byte) => byte.toString(16).padStart(2, '0')).join('');
}

/** The first 64 bits of a digest, as the page shows it: 16 digits. */
export const fingerprintOf = (digest: string) => digest.slice(0, 16);
