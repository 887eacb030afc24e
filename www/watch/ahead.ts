/** Starts what the tool waits for while its code is still loading: the workers that read and run a mesh. */

import { WorkerClient } from './worker-client.ts';

let reader: WorkerClient | undefined;
let runner: WorkerClient | undefined;

/** Call it before the tool starts. Who takes something later gets its error. */
export function startAhead(): void {
  reader ??= new WorkerClient();
  reader.call((worker) => worker.loadFiles()).catch(() => {});
  runner ??= new WorkerClient();
  runner.call((worker) => worker.load()).catch(() => {});
}

/** The worker that can read files soonest. */
export function takeReader(): WorkerClient {
  const taken = reader ?? new WorkerClient();
  reader = undefined;
  return taken;
}

/** The worker that can run an engine soonest. */
export function takeRunner(): WorkerClient {
  const taken = runner ?? new WorkerClient();
  runner = undefined;
  return taken;
}
