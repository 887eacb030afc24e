// Runs jobs in lanes side by side, in the order of a list: a job starts when those that it waits for are done, a lane is
// free, and nobody else holds what it needs.

/**
 * @typedef {object} Job
 * @property {string} name
 * @property {string[]} after - The names of the jobs that it waits for. Jobs that are not in the list count as done.
 * @property {string[]} [holds] - What only one job may use at a time, such as a folder that cargo locks.
 * @property {boolean} [isLight] - Mostly waits, for a download say, so it needs no lane.
 * @property {boolean} [isAlone] - Depends on timing, so nothing may run beside it.
 * @property {() => Promise<boolean>} run - Resolves to its success.
 * @property {(failed: string) => void} drop - Called instead of `run` if a job that it waits for has failed.
 */

/** @param {Job[]} jobs @param {number} lanes */
export async function runAll(jobs, lanes) {
  /** @type {Map<string, boolean>} */
  const ended = new Map();
  /** @type {Map<Job, Promise<void>>} */
  const running = new Map();
  const waiting = new Set(jobs);
  const names = new Set(jobs.map(({ name }) => name));

  /** @param {Job} job */
  const mayStart = (job) => {
    if (!job.after.every((name) => ended.has(name) || !names.has(name))) return false;
    const others = [...running.keys()];
    if (others.some((other) => other.holds?.some((thing) => job.holds?.includes(thing)))) return false;
    if (job.isLight) return true;
    const inLanes = others.filter((other) => !other.isLight);
    if (job.isAlone) return others.length === 0;
    return inLanes.length < lanes && !inLanes.some((other) => other.isAlone);
  };

  while (waiting.size > 0 || running.size > 0) {
    for (const job of waiting) {
      const failed = job.after.find((name) => ended.get(name) === false);
      if (failed !== undefined) {
        waiting.delete(job);
        ended.set(job.name, false);
        job.drop(failed);
      } else if (mayStart(job)) {
        waiting.delete(job);
        const end = job.run().then((isGood) => {
          ended.set(job.name, isGood);
          running.delete(job);
        });
        running.set(job, end);
      }
    }
    await Promise.race(running.values());
  }
}
