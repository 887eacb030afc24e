// Hostile values: objects that throw, objects with false properties, and arrays that have lost their memory.

import fc from 'fast-check';

const traps = [
  'get',
  'has',
  'getPrototypeOf',
  'ownKeys',
  'getOwnPropertyDescriptor',
  'apply',
  'construct',
  'set',
  'defineProperty',
];
const throwing = Object.fromEntries(
  traps.map((trap) => [
    trap,
    () => {
      throw new Error(`trap ${trap}`);
    },
  ]),
);

function revoked(target) {
  const { proxy, revoke } = Proxy.revocable(target, {});
  revoke();
  return proxy;
}

function detached(Kind, length) {
  const array = new Kind(length);
  structuredClone(array, { transfer: [array.buffer] });
  return array;
}

/** An array whose buffer has shrunk. */
function shrunk(Kind) {
  const buffer = new ArrayBuffer(8 * Kind.BYTES_PER_ELEMENT, { maxByteLength: 64 * Kind.BYTES_PER_ELEMENT });
  const array = new Kind(buffer, Kind.BYTES_PER_ELEMENT, 4);
  buffer.resize(0);
  return array;
}

/** An array that follows the length of its buffer, and so changes its length later. */
function growing(Kind) {
  const buffer = new ArrayBuffer(6 * Kind.BYTES_PER_ELEMENT, { maxByteLength: 64 * Kind.BYTES_PER_ELEMENT });
  const array = new Kind(buffer);
  queueMicrotask(() => attempt(() => buffer.resize(0)));
  return array;
}

function shared(Kind) {
  return new Kind(new SharedArrayBuffer(6 * Kind.BYTES_PER_ELEMENT));
}

/** A subclass that overrides all inherited properties with false values. */
function lying(Kind) {
  class Lying extends Kind {
    get length() {
      return 3e9;
    }
    get byteLength() {
      return -1;
    }
    get buffer() {
      return 'none';
    }
    get [Symbol.toStringTag]() {
      return 'Float32Array';
    }
    static get [Symbol.species]() {
      throw new Error('species');
    }
    slice() {
      throw new Error('slice');
    }
    subarray() {
      return null;
    }
    *[Symbol.iterator]() {
      for (;;) yield NaN;
    }
  }
  return new Lying(6);
}

/** An object that has only the prototype of the class. */
function pretending(Kind) {
  return Object.create(Kind.prototype);
}

const kinds = [
  Int8Array,
  Uint8Array,
  Uint8ClampedArray,
  Int16Array,
  Uint16Array,
  Int32Array,
  Uint32Array,
  Float32Array,
  Float64Array,
  BigInt64Array,
];

const oddArrays = [detached, shrunk, growing, shared, lying, pretending].flatMap((make) =>
  kinds.map((Kind) => () => make(Kind, 6)),
);

const odd = [
  ...oddArrays,
  () => new DataView(new ArrayBuffer(8)),
  () => new ArrayBuffer(8),
  () => detached(Uint8Array, 8).buffer,
  () => new Proxy(new Float32Array(8), {}),
  () => new Proxy(new Uint32Array(6), throwing),
  () => new Proxy({}, throwing),
  () => new Proxy([], throwing),
  () => new Proxy(function () {}, throwing),
  () => new Proxy([0, 1], { get: (target, key) => (key === 'length' ? 2 ** 40 : 0) }),
  () => revoked({}),
  () => revoked([]),
  () => Object.create(null),
  () => ({
    toString() {
      throw new Error('toString');
    },
    get message() {
      throw new Error('message');
    },
  }),
  () => ({
    valueOf: () => {
      throw new Error('valueOf');
    },
    [Symbol.toPrimitive]: () => {
      throw new Error('toPrimitive');
    },
  }),
  () => ({ then() {} }),
  () => ({ length: 2 ** 53 }),
  () =>
    Object.defineProperty([1, 2], 1, {
      get: () => {
        throw new Error('element');
      },
    }),
  () => Object.assign([], { length: 2 ** 32 - 1 }),
  () => [[], {}, null],
  () => [1n, 2n],
  () => [0, 1, 4294967296],
  () => () => undefined,
  () => class {},
  () => Symbol('symbol'),
  () => 'x'.repeat(2 ** 20),
  () => new Map(),
  () => new Date(NaN),
  () => /x/g,
  () => new Error('an error'),
  () => AbortSignal.abort(),
  () => new Promise(() => {}),
  () => new WeakRef({}),
  () => globalThis,
];

const words = [
  '',
  'auto',
  'webgpu',
  'webgl2',
  'cpu',
  'gpu',
  'any',
  'reproducible',
  'a.obj',
  'a.off.gz',
  'a.glb',
  'random 9',
  'grid 4',
  'uvsphere 3 nan',
  '__proto__',
  '\0',
  '\ud800',
];
const numbers = [
  NaN,
  -0,
  -1,
  0,
  0.5,
  1,
  2,
  3,
  4,
  1e9,
  2 ** 31,
  2 ** 32 - 1,
  2 ** 32,
  2 ** 53,
  1e308,
  Infinity,
  -Infinity,
];

/** Makes a hostile value. Each call makes a new one, because some values can be used only once. */
export const hostile = fc.oneof(
  { arbitrary: fc.constantFrom(...odd), weight: 6 },
  {
    arbitrary: fc.constantFrom(undefined, null, true, false, 1n, ...words, ...numbers).map((value) => () => value),
    weight: 3,
  },
  {
    arbitrary: fc
      .tuple(fc.constantFrom(...kinds.slice(0, -1)), fc.array(fc.constantFrom(...numbers), { maxLength: 12 }))
      .map(
        ([Kind, list]) =>
          () =>
            Kind.from(list),
      ),
    weight: 2,
  },
  { arbitrary: fc.array(fc.constantFrom(...numbers), { maxLength: 12 }).map((list) => () => list.slice()), weight: 1 },
  {
    arbitrary: fc
      .anything({ withTypedArray: true, withBigInt: true, withNullPrototype: true, withSparseArray: true, maxDepth: 2 })
      .map((value) => () => value),
    weight: 1,
  },
);

/** The ways to pass a hostile value: directly, or through a getter. */
export const placing = fc.constantFrom('value', 'value', 'value', 'getter that throws', 'getter that changes its mind');

/** Ignores exceptions: a hostile value that was placed before may throw. */
function attempt(work) {
  try {
    work();
  } catch {
    // The previous value stays.
  }
}

/** Puts a value at a path of an argument list. */
export function place(args, path, make, how) {
  let target = args;
  attempt(() => path.slice(0, -1).forEach((key) => (target = target?.[key])));
  const key = path.at(-1);
  if (typeof target !== 'object' || target === null) return;
  if (how === 'value' || path.length === 1) {
    attempt(() =>
      Reflect.defineProperty(target, key, { value: make(), enumerable: true, configurable: true, writable: true }),
    );
    return;
  }
  let reads = 0;
  const get = () => {
    if (how === 'getter that throws') throw new Error('a getter');
    return reads++ === 0 ? make() : revoked({});
  };
  attempt(() => Reflect.defineProperty(target, key, { get, enumerable: true, configurable: true }));
}

/** Destroys the arguments after the call has returned: detaches arrays, and clears lists and objects. */
export function takeAway(value, depth = 0) {
  attempt(() => {
    if (ArrayBuffer.isView(value)) {
      if (value.buffer instanceof ArrayBuffer) structuredClone(value.buffer, { transfer: [value.buffer] });
    } else if (
      typeof value === 'object' &&
      value !== null &&
      depth < 4 &&
      [Object.prototype, Array.prototype].includes(Object.getPrototypeOf(value))
    ) {
      for (const key of Object.keys(value)) {
        takeAway(value[key], depth + 1);
        delete value[key];
      }
    }
  });
}
