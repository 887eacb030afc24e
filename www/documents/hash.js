// Tells whether what was made from files is still theirs.

import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';

/** The SHA-256 of the contents of files, one after the other. */
export function hashOf(...paths) {
  const hash = createHash('sha256');
  for (const path of paths) hash.update(readFileSync(path));
  return hash.digest('hex');
}
