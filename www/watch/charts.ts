/** The two charts: flips per iteration, and the angles before and after. */

import type { Angles } from 'edgeflip/files';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { inMainMemory } from './main-memory.ts';
import type { Palette } from './palette.ts';

const HEIGHT = 170;

/** A chart in a box. When the colours change, it is made again. */
class Chart {
  readonly #box: HTMLElement;
  readonly #make: (palette: Palette) => Omit<uPlot.Options, 'width' | 'height'>;
  #plot: uPlot | undefined;
  #data: uPlot.AlignedData = [[]];

  constructor(box: HTMLElement, make: (palette: Palette) => Omit<uPlot.Options, 'width' | 'height'>) {
    this.#box = box;
    this.#make = make;
    new ResizeObserver(() => {
      if (box.clientWidth > 0) this.#plot?.setSize({ width: box.clientWidth, height: HEIGHT });
    }).observe(box);
  }

  setPalette(palette: Palette): void {
    this.#plot?.destroy();
    const size = { width: Math.max(this.#box.clientWidth, 100), height: HEIGHT };
    this.#plot = inMainMemory(() => new uPlot({ ...size, ...this.#make(palette) }, this.#data, this.#box));
  }

  show(data: uPlot.AlignedData): void {
    this.#data = data;
    this.#plot?.setData(data);
  }
}

const axis = (palette: Palette, label: string, size: number): uPlot.Axis => ({
  label,
  size,
  labelSize: 18,
  labelFont: '11px system-ui, sans-serif',
  font: '11px system-ui, sans-serif',
  stroke: palette.muted,
  grid: { stroke: palette.grid, width: 1 },
  ticks: { show: false },
});

const short = new Intl.NumberFormat('en', { notation: 'compact', maximumFractionDigits: 1 });
const compact: uPlot.Axis.DynamicValues = (_, values) =>
  values.map((value) => (value === null ? '' : short.format(value)));
const whole: uPlot.Axis.DynamicValues = (_, values) =>
  values.map((value) => (Number.isInteger(value) ? `${value}` : ''));

export class FlipsChart {
  readonly #chart: Chart;
  #at = 0;

  constructor(box: HTMLElement) {
    this.#chart = new Chart(box, (palette) => ({
      legend: { show: false },
      cursor: { show: false },
      padding: [8, 10, 0, 0],
      scales: {
        x: { time: false, range: (_, __, max) => [0.4, Math.max(max ?? 1, 5) + 0.6] },
        y: { range: (_, __, max) => [0, Math.max(max ?? 0, 1) * 1.05] },
      },
      axes: [
        { ...axis(palette, 'iteration', 24), values: whole },
        { ...axis(palette, 'flips', 42), values: compact },
      ],
      series: [
        {},
        {
          stroke: palette.accent,
          fill: palette.accent,
          width: 0,
          points: { show: false },
          paths: (plot, series, from, to) => uPlot.paths.bars!({ size: [0.7, 40] })(plot, series, from, to),
        },
      ],
      hooks: { draw: [(plot) => this.#mark(plot, palette)] },
    }));
  }

  setPalette(palette: Palette): void {
    this.#chart.setPalette(palette);
  }

  /** Shows the flips of all iterations so far, and marks iteration `at`. */
  show(flips: readonly number[], at: number): void {
    this.#at = at;
    this.#chart.show([flips.map((_, index) => index + 1), [...flips]]);
  }

  /** Draws a line at the shown iteration. */
  #mark(plot: uPlot, palette: Palette): void {
    if (this.#at === 0) return;
    const x = plot.valToPos(this.#at, 'x', true);
    plot.ctx.save();
    plot.ctx.strokeStyle = palette.text;
    plot.ctx.setLineDash([3, 3]);
    plot.ctx.beginPath();
    plot.ctx.moveTo(x, plot.bbox.top);
    plot.ctx.lineTo(x, plot.bbox.top + plot.bbox.height);
    plot.ctx.stroke();
    plot.ctx.restore();
  }
}

export class AnglesChart {
  readonly #chart: Chart;

  constructor(box: HTMLElement) {
    const stepped: uPlot.Series.PathBuilder = (plot, series, from, to) =>
      uPlot.paths.stepped!({ align: 1 })(plot, series, from, to);
    this.#chart = new Chart(box, (palette) => ({
      legend: { show: false },
      cursor: { show: false },
      padding: [8, 10, 0, 0],
      scales: { x: { time: false, range: [0, 180] }, y: { range: (_, __, max) => [0, Math.max(max ?? 0, 1) * 1.05] } },
      axes: [
        { ...axis(palette, 'angle in degrees', 24), splits: () => [0, 30, 60, 90, 120, 150, 180] },
        { ...axis(palette, 'angles', 42), values: compact },
      ],
      series: [
        {},
        { stroke: palette.muted, width: 1.5, points: { show: false }, paths: stepped, dash: [4, 3] },
        { stroke: palette.accent, fill: `${palette.accent}33`, width: 1.5, points: { show: false }, paths: stepped },
      ],
    }));
  }

  setPalette(palette: Palette): void {
    this.#chart.setPalette(palette);
  }

  show(before: Angles | undefined, now: Angles | undefined): void {
    const bins = before?.counts.length ?? 0;
    const edges = Array.from({ length: bins + 1 }, (_, bin) => (bin * 180) / bins);
    const closed = (angles: Angles | undefined) =>
      edges.map((_, bin) => angles?.counts[Math.min(bin, bins - 1)] ?? null);
    this.#chart.show([edges, closed(before), closed(now)]);
  }
}
