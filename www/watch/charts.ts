/** The histogram of the angles, before and now. */

import type { Angles } from 'edgeflip/files';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { inMainMemory } from './main-memory.ts';
import type { Palette } from './palette.ts';

const HEIGHT = 112;
const FONT = '12px Inter, system-ui, sans-serif';

export class AnglesChart {
  readonly #box: HTMLElement;
  #plot: uPlot | undefined;
  #data: uPlot.AlignedData = [[]];

  constructor(box: HTMLElement) {
    this.#box = box;
    new ResizeObserver(() => {
      if (box.clientWidth > 0) this.#plot?.setSize({ width: box.clientWidth, height: HEIGHT });
    }).observe(box);
  }

  setPalette({ muted, text, hair }: Palette): void {
    const stepped: uPlot.Series.PathBuilder = (plot, series, from, to) =>
      uPlot.paths.stepped!({ align: 1 })(plot, series, from, to);
    const options: uPlot.Options = {
      width: Math.max(this.#box.clientWidth, 100),
      height: HEIGHT,
      legend: { show: false },
      cursor: { show: false },
      padding: [4, 16, 0, 16],
      scales: { x: { time: false, range: [0, 180] }, y: { range: (_, __, max) => [0, Math.max(max ?? 0, 1) * 1.05] } },
      axes: [
        {
          size: 24,
          font: FONT,
          stroke: muted,
          grid: { show: false },
          ticks: { show: false },
          border: { show: true, stroke: hair, width: 1 },
          splits: () => [0, 60, 120, 180],
          values: (_, splits) => splits.map((split) => `${split}°`),
        },
        { show: false },
      ],
      series: [
        {},
        {
          stroke: 'transparent',
          fill: `color-mix(in srgb, ${text} 24%, transparent)`,
          points: { show: false },
          paths: stepped,
        },
        { stroke: text, width: 1.5, points: { show: false }, paths: stepped, dash: [2, 3] },
      ],
    };
    this.#plot?.destroy();
    this.#plot = inMainMemory(() => new uPlot(options, this.#data, this.#box));
  }

  show(before: Angles | undefined, now: Angles | undefined): void {
    const bins = before?.counts.length ?? 0;
    const edges = Array.from({ length: bins + 1 }, (_, bin) => (bin * 180) / bins);
    const closed = (angles: Angles | undefined) =>
      edges.map((_, bin) => angles?.counts[Math.min(bin, bins - 1)] ?? null);
    this.#data = [edges, closed(now), closed(before)];
    this.#plot?.setData(this.#data);
  }
}
