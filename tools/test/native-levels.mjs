// The levels of tests in Rust, and what they read.

import { readFileSync } from 'node:fs';

// What is compiled natively. The rooms for browsers are for wasm32 only.
export const crate = [
  ...['src', '!src/js', '!src/wasm', '!src/engine/webgl2', 'shaders', '!shaders/webgl2', 'build.rs'],
  'benches/src/kinds.rs', // src/predicates/tiers.rs includes it
];
export const locks = ['Cargo.toml', 'Cargo.lock'];
/** The rooms above those of a run: a test that names neither files nor the command cannot reach them. */
const filesAndCommand = ['!src/io', '!src/bin'];

/**
 * The levels in Rust: the unit tests, each module with tests of tests/native/main.rs, and the programs beside it. The
 * first sentence of the file's `//!` lines describes the level.
 */
export function nativeLevels(isFull) {
  const native = { counts: true, tools: ['rust'], after: ['native programs'] };
  const [, list] = readFileSync('tests/native/main.rs', 'utf8').split('// The levels.');
  const modules = [...list.matchAll(/^mod (\w+);$/gm)].map(([, name]) => name);
  /** What some of them do besides, and read besides. */
  const more = {
    examples: { reads: ['README.md', 'examples'] },
    families: { reads: ['tests/package/generated.txt'] },
    fuzz_seeds: { reads: ['fuzz'] },
    parity: {
      modules: ['quads'],
      checks: [
        ['@native', 'parity::'],
        ['@native', 'quads::batches_for_browsers'],
      ],
      // In browsers a software GPU takes 5 times as long for a quad.
      env: { EDGEFLIP_PARITY: 'target/parity.json', EDGEFLIP_QUADS: isFull ? '1000000' : '20000' },
      writes: ['target/parity.json', 'target/quads'],
    },
    points: { reads: ['tests/points'] },
    quads: { checks: [['@native', 'quads::', '--skip', 'batches_for_browsers', '--nocapture', '--test-threads=1']] },
  };
  return [
    {
      ...native,
      name: 'unit',
      what: 'the unit tests in src/ and tools/glsl',
      checks: [['@lib edgeflip'], ['@bin glsl']],
      tools: ['rust', 'vulkan'],
      reads: [
        ...crate,
        'shaders/webgl2',
        'src/js/edge-states.ts',
        'src/js/settings.ts',
        'tools/glsl',
        'proptest-regressions',
        ...locks,
      ],
    },
    ...modules.map((name) => {
      const source = readFileSync(`tests/native/${name}.rs`, 'utf8');
      const [features = ''] = source.match(/^#!\[cfg\(.*$/m) ?? [];
      const others = modules.filter((other) => other !== name && !more[name]?.modules?.includes(other));
      return {
        ...native,
        name,
        what: firstSentence(source),
        checks: [['@native', `${name}::`]],
        tools: ['rust', ...(features.includes('gpu') ? ['vulkan'] : [])],
        isPlain: !/gpu|cli/.test(features),
        ...more[name],
        reads: [
          ...crate,
          ...(/\b(io|command)\b/.test(source) ? [] : filesAndCommand),
          ...['tests/native', 'tests/meshes', 'tests/digests.txt'],
          ...others.flatMap((other) => [`!tests/native/${other}.rs`, `!tests/native/${other}`]),
          ...(more[name]?.reads ?? []),
          ...locks,
        ],
      };
    }),
    {
      ...native,
      name: 'memory_bounds',
      what: firstSentence(readFileSync('tests/memory_bounds.rs', 'utf8')),
      checks: [['@memory_bounds']],
      reads: [...crate, ...filesAndCommand, 'tests/memory_bounds.rs', ...locks],
    },
    {
      ...native,
      name: 'doc',
      what: 'the examples in the documentation run',
      // Both, as when the programs were compiled.
      checks: [['cargo', 'test', '--package', 'edgeflip', '--package', 'glsl', '--doc']],
      reads: [...crate, ...locks],
      holds: ['target'],
    },
  ];
}

export function firstSentence(source) {
  const [block] = source.match(/^(\/\/!.*\n)+/m) ?? [];
  return block
    ?.replace(/^\/\/! ?/gm, '')
    .replace(/\s+/g, ' ')
    .trim()
    .split(/(?<=\.) /)[0]
    .replace(/\.$/, '');
}
