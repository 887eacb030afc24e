// A run in a worker, with progress and a button that stops it: `npm run examples`, then open worker.html.

import { generate } from 'edgeflip/files';
import { FlipSession } from 'edgeflip/worker';

const [run, stop, state] = ['run', 'stop', 'state'].map((id) => document.getElementById(id));
const size = Number(new URLSearchParams(location.search).get('size') ?? 700);
const session = await FlipSession.create(await generate(`random ${size}`));

run.onclick = async () => {
  const controller = new AbortController();
  stop.onclick = () => controller.abort();
  [run.disabled, stop.disabled] = [true, false];
  const { status, flips, iterations, backend } = await session.run({
    signal: controller.signal,
    onProgress: ({ flips, iterations }) => (state.value = `${flips} flips in ${iterations} iterations`),
  });
  state.value = `${status}: ${flips} flips in ${iterations} iterations on ${backend}`;
  // A stopped run can continue.
  [run.disabled, stop.disabled] = [status === 'done', true];
};
state.value = 'Ready.';
run.disabled = false;
