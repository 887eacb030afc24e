// Each option of src/js/types.ts takes effect in the module of the engines and in the module of the threads. Unknown
// options are refused.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import workers from 'node:worker_threads';
import { FlipSession, makeDelaunay } from 'edgeflip';
import { generate, readMesh, writeMesh } from 'edgeflip/files';
import ts from 'typescript';
import { cases } from './options.mjs';

let started = 0;
workers.Worker = class extends workers.Worker {
  constructor(...args) {
    super(...args);
    started++;
  }
};

/** The fields of an interface of the package's types. */
function fieldsOf(name) {
  const path = new URL('../../src/js/types.ts', import.meta.url);
  const source = ts.createSourceFile('types.ts', readFileSync(path, 'utf8'), ts.ScriptTarget.Latest);
  const found = source.statements.find(
    (statement) => ts.isInterfaceDeclaration(statement) && statement.name.text === name,
  );
  return found.members.map((member) => member.name.text);
}

test('every option has a case', () => {
  assert.deepEqual(Object.keys(cases).sort(), fieldsOf('Options').sort());
});

// The second mesh is large enough for several threads, the first is not.
const modules = [
  { name: 'the module of the engines', mesh: await generate('uvsphere 24'), threads: 1 },
  { name: 'the module of the threads', mesh: await generate('uvsphere 190'), threads: 2 },
];
for (const { name, mesh, threads } of modules) {
  test(`every option takes effect in ${name}`, async (t) => {
    const base = { backend: 'cpu', threads };
    const plain = await makeDelaunay(mesh, base);
    assert.equal(started, threads === 1 ? 0 : 2);
    for (const [option, run] of Object.entries(cases)) {
      await t.test(option, () => run({ makeDelaunay, FlipSession, mesh, base, plain }));
    }
  });
}

test('an unknown option is refused, with the nearest name', async () => {
  const [{ mesh }] = modules;
  const refused = (message) => ({ name: 'EdgeflipError', code: 'invalid-option', message });
  const wrong = [
    [{ maxNormalAngel: 5 }, 'maxNormalAngel is not an option; did you mean maxNormalAngle?'],
    [{ max_deviation: 5 }, 'max_deviation is not an option; did you mean maxDeviation?'],
    [{ Backend: 'cpu' }, 'Backend is not an option; did you mean backend?'],
    [{ onprogress() {} }, 'onprogress is not an option; did you mean onProgress?'],
    [{ lockEdges: [] }, 'lockEdges is not an option; did you mean lockedEdges?'],
    [{ '\0': null }, /^'\0' is not an option; there are backend, .*, onIteration$/],
    [{ ['x'.repeat(1e6)]: 1 }, /^'x{40}…' is not an option; there are /],
    [{ colour: 'red' }, /^colour is not an option; there are backend, /],
    [{ __proto__: null, constructor: 1 }, /^constructor is not an option; /],
  ];
  for (const [options, message] of wrong) await assert.rejects(makeDelaunay(mesh, options), refused(message));
  const session = await FlipSession.create(mesh, { backend: 'cpu' });
  await assert.rejects(
    FlipSession.create(mesh, { onProgres() {} }),
    refused(/^onProgres is not an option; there are backend, .*, device$/),
  );
  await assert.rejects(
    FlipSession.create(mesh, { signal: AbortSignal.abort() }),
    refused(/^signal is not an option; /),
  );
  await assert.rejects(
    session.run({ maxIterations: 4 }),
    refused('maxIterations is not an option; there are signal, onProgress'),
  );
  session.free();
  const bytes = await writeMesh(mesh, 'a.off');
  await assert.rejects(
    readMesh(bytes, 'a.off', { maxbytes: 4 }),
    refused('maxbytes is not an option; did you mean maxBytes?'),
  );
  await assert.rejects(
    writeMesh(mesh, 'a.off', { origin: 4 }),
    refused('origin is not an option; did you mean original?'),
  );
});

test('an option that is undefined keeps its default', async () => {
  const [{ mesh }] = modules;
  const nothing = Object.fromEntries([...fieldsOf('Options'), 'other'].map((name) => [name, undefined]));
  const { timings, ...result } = await makeDelaunay(mesh, nothing);
  const { timings: _, ...expected } = await makeDelaunay(mesh);
  assert.deepEqual(result, expected);
});

test('options may be inherited, and a list is refused', async () => {
  const [{ mesh }] = modules;
  const { iterations } = await makeDelaunay(mesh, Object.create({ maxIterations: 2, backend: 'cpu' }));
  assert.equal(iterations, 2);
  for (const list of [[], new Uint8Array(2), new Uint32Array(2 ** 28)]) {
    await assert.rejects(makeDelaunay(mesh, list), {
      code: 'invalid-input',
      message: 'options: a list is not an object with options',
    });
  }
});
