// Lists the tasks of a page's main thread, from Chromium's trace.

/** The trace events of tasks that draw: a frame's callbacks, layout, paint, and the commit to the compositor. */
const DRAWING = new Set(['FireAnimationFrame', 'Paint', 'PrePaint', 'Layerize', 'Commit', 'UpdateLayerTree']);

/**
 * Starts a trace. `end` returns the tasks of the page's main thread since then: the end of each on the page's clock, its
 * duration and its CPU time in milliseconds, whether it drew, whether it belongs to the page, and its five longest
 * events.
 *
 * @param {import('playwright-core').Page} page
 */
export async function tasksOf(page) {
  const session = await page.context().newCDPSession(page);
  const events = [];
  session.on('Tracing.dataCollected', ({ value }) => events.push(...value));
  await session.send('Tracing.start', {
    transferMode: 'ReportEvents',
    traceConfig: {
      recordMode: 'recordAsMuchAsPossible',
      includedCategories: ['devtools.timeline', 'disabled-by-default-devtools.timeline'],
      excludedCategories: ['*'],
    },
  });
  // This mark identifies the thread of the page.
  const mark = `the main thread of ${Math.random()}`;
  const markedAt = await page.evaluate((name) => {
    console.timeStamp(name);
    return performance.now();
  }, mark);
  return {
    async end() {
      const complete = new Promise((resolve) => session.once('Tracing.tracingComplete', resolve));
      await session.send('Tracing.end');
      const { dataLossOccurred } = await complete;
      if (dataLossOccurred) throw new Error('the trace has gaps');
      await session.detach();
      const marked = events.find(({ name, args }) => name === 'TimeStamp' && args?.data?.message === mark);
      if (!marked) throw new Error('the trace does not have the mark');
      const mine = events.filter(
        ({ pid, tid, ph, ts }) => pid === marked.pid && tid === marked.tid && ph === 'X' && ts > marked.ts,
      );
      mine.sort((a, b) => a.ts - b.ts || b.dur - a.dur);
      const tasks = [];
      for (const { name, ts, dur, tdur, args } of mine) {
        if (name === 'RunTask' || name === 'ThreadControllerImpl::RunTask') {
          tasks.push({ start: ts, end: ts + dur, ms: dur / 1000, busy: tdur / 1000, draws: false, parts: [] });
          continue;
        }
        const task = tasks.at(-1);
        if (!task || ts >= task.end) continue;
        task.draws ||= DRAWING.has(name);
        const { functionName, url } = args?.data ?? {};
        task.parts.push({
          ms: dur / 1000,
          name: [name, functionName, url?.split('/').at(-1)].filter(Boolean).join(' '),
        });
      }
      return tasks.map(({ end, ms, busy, draws, parts }) => ({
        end: markedAt + (end - marked.ts) / 1000,
        ms,
        busy,
        draws,
        // Tasks without events are Chromium's own, such as waiting for its GPU process.
        isOfPage: parts.length > 0,
        within: parts
          .sort((a, b) => b.ms - a.ms)
          .slice(0, 5)
          .map((part) => `${part.name} ${part.ms.toFixed(0)} ms`),
      }));
    },
  };
}
