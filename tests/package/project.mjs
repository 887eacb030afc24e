// Packs the package and installs it into fresh projects.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

export const repository = fileURLToPath(new URL('../..', import.meta.url));

/** Runs a program to its end and returns its output. Fails if the program fails. */
export function run(program, args, cwd, env = {}) {
  const shell = process.platform === 'win32'; // on Windows, npm is a script
  const { status, stdout, stderr, error } = spawnSync(program, args, {
    cwd,
    encoding: 'utf8',
    shell,
    env: { ...process.env, ...env },
  });
  assert.equal(status, 0, `${program} ${args.join(' ')}: ${error ?? ''}\n${stdout}\n${stderr}`);
  return stdout;
}

/** A folder for projects, in which the package is packed from the existing dist/. `prefix` is its path without an end. */
export class Projects {
  /** @type {{ filename: string, files: { path: string }[] }} */
  packed;
  /** The folder into which npm has installed the package. */
  #installed;

  constructor(prefix) {
    assert.ok(existsSync(join(repository, 'dist/index.js')), 'dist/ is not built: npm run build');
    this.folder = mkdtempSync(prefix);
    const pack = ['pack', '--json', '--ignore-scripts', '--pack-destination', this.folder];
    [this.packed] = JSON.parse(run('npm', pack, repository));
  }

  /** The path of the packed package. */
  get tarball() {
    return join(this.folder, this.packed.filename);
  }

  /** A new folder with the installed package. `more` are further fields of its package.json. */
  project(name, more = {}) {
    const root = join(this.folder, name);
    mkdirSync(root);
    const dependencies = { edgeflip: `file:${this.tarball}` };
    const fields = { name, private: true, type: 'module', dependencies, ...more };
    writeFileSync(join(root, 'package.json'), JSON.stringify(fields));
    if (this.#installed) {
      // What npm would write again.
      for (const part of ['node_modules', 'package-lock.json'])
        cpSync(join(this.#installed, part), join(root, part), { recursive: true });
    } else {
      run('npm', ['install', '--offline', '--install-links', '--ignore-scripts', '--no-audit', '--no-fund'], root);
      this.#installed = root;
    }
    return root;
  }

  remove() {
    rmSync(this.folder, { recursive: true, force: true });
  }
}
