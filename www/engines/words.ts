/** How the section writes numbers and times. */

import { number } from '../shell/numbers.ts';

const rounded = new Intl.NumberFormat('en', { maximumSignificantDigits: 2 });

export const count = (value: number) => number.format(value);
export const about = (value: number) => rounded.format(value);

/** A time in milliseconds or seconds, with about three digits: the number and its unit. */
export function timeOf(ms: number): [string, string] {
  if (ms >= 10_000) return [(ms / 1000).toFixed(1), 's'];
  const decimals = [0.1, 10, 100].filter((limit) => ms < limit).length;
  return [ms >= 1000 ? count(Math.round(ms)) : ms.toFixed(decimals), 'ms'];
}

export const timeText = (ms: number) => timeOf(ms).join(' ');
