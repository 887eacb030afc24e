#!/usr/bin/env bash
# One expects: if a thread has grown a shared WebAssembly memory and says so by an atomic store, then a thread that has
# read this by an atomic load can use the new pages, by every instruction.
# What happens in V8 (Node): a plain store there works, but memory.fill traps with "memory access out of bounds", and in
# code that is not yet optimized so does every atomic instruction, until the thread next calls a function or begins
# another round of a loop. On one core, where the threads interrupt each other, this happens in two of three rounds; on
# two idle cores, in a few of a thousand.
# Why it matters: an allocator with a lock hands out memory that another thread has just grown; whether the first
# instruction in it traps depends on where the compiler has put calls, and on whether the code is already optimized.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >npm.log
npm install --no-audit --no-fund node@20.20.2 >>npm.log 2>&1
cat >grow.mjs <<'JS'
import { isMainThread, parentPort, Worker, workerData } from 'node:worker_threads';

const kind = process.argv[2] ?? workerData;
const ROUNDS = 1000;
const number = (n) => (n < 128 ? [n] : [(n & 127) | 128, ...number(n >>> 7)]);
const vector = (items) => [...number(items.length), ...items.flat()];
const section = (id, items) => [id, ...number(vector(items).length), ...vector(items)];
const text = (name) => vector([...name].map((c) => [c.charCodeAt(0)]));
const body = (...code) => [...number(code.length + 2), 0, ...code, 0x0b];
// The address of page n, the argument.
const page = [0x20, 0, 0x41, 16, 0x74];
const writes = {
  'i32.store': [...page, 0x41, 1, 0x36, 2, 0],
  'memory.fill': [...page, 0x41, 1, 0x41, 8, 0xfc, 0x0b, 0],
  'i32.atomic.rmw.add': [...page, 0x41, 1, 0xfe, 0x1e, 2, 0, 0x1a],
};
const module = new WebAssembly.Module(
  Uint8Array.from([
    ...[0, 0x61, 0x73, 0x6d, 1, 0, 0, 0],
    ...section(1, [[0x60, 0, 0], [0x60, 1, 0x7f, 0]]),
    ...section(2, [[...text('e'), ...text('m'), 2, 3, 2, ...number(65536)]]),
    ...section(3, [[0], [1]]),
    ...section(7, [[...text('grow'), 0, 0], [...text('write'), 0, 1]]),
    ...section(10, [
      // grow: word 0 = the number of pages before, after growing by one page.
      body(0x41, 0, 0x41, 1, 0x40, 0, 0xfe, 0x17, 2, 0),
      // write(n): waits until word 0 is n, then writes into page n.
      body(0x03, 0x40, 0x41, 0, 0xfe, 0x10, 2, 0, 0x20, 0, 0x47, 0x0d, 0, 0x0b, ...writes[kind]),
    ]),
  ]),
);
if (isMainThread) {
  const memory = new WebAssembly.Memory({ initial: 2, maximum: 65536, shared: true });
  const { grow } = new WebAssembly.Instance(module, { e: { m: memory } }).exports;
  const worker = new Worker(new URL(import.meta.url), { workerData: kind });
  let [pages, traps] = [2, 0];
  const round = () => {
    worker.postMessage([memory, pages++]);
    setTimeout(grow, 1);
  };
  worker.on('message', (trap) => {
    traps += trap;
    if (pages < ROUNDS + 2) return round();
    console.log(`${process.version} ${process.execArgv.join(' ')}: ${kind}: ${traps} of ${ROUNDS} trap`);
    process.exit();
  });
  round();
} else {
  let write;
  parentPort.on('message', ([memory, n]) => {
    write ??= new WebAssembly.Instance(module, { e: { m: memory } }).exports.write;
    try {
      write(n);
      parentPort.postMessage(0);
    } catch (error) {
      if (!(error instanceof WebAssembly.RuntimeError)) throw error;
      parentPort.postMessage(1);
    }
  });
}
JS
for kind in i32.store memory.fill i32.atomic.rmw.add; do
  for flag in --liftoff-only --no-liftoff; do taskset -c 0 node_modules/.bin/node $flag grow.mjs $kind; done
done | tee found
expect() { # FLAG INSTRUCTION TRAPS
  grep -Eq -- "$1: $2: $3 of" found || { echo "changed: $1 $2"; exit 1; }
}
for flag in --liftoff-only --no-liftoff; do
  expect $flag i32.store 0
  expect $flag memory.fill '[0-9]{2,}'
done
expect --liftoff-only i32.atomic.rmw.add '[0-9]{2,}'
expect --no-liftoff i32.atomic.rmw.add 0
