/** How the page writes numbers. */

export const number = new Intl.NumberFormat('en');
export const ms = new Intl.NumberFormat('en', { maximumFractionDigits: 1, minimumFractionDigits: 1 });
export const digits = new Intl.NumberFormat('en', { maximumSignificantDigits: 6 });
export const degrees = new Intl.NumberFormat('en', { maximumFractionDigits: 2, minimumFractionDigits: 2 });

/** `1 edge stays`, `2 edges stay`. */
export const staying = (edges: number) => `${counted(edges, 'edge')} ${edges === 1 ? 'stays' : 'stay'}`;

/** `1 edge`, `2 edges`. */
export function counted(count: number, noun: string): string {
  return `${number.format(count)} ${noun}${count === 1 ? '' : 's'}`;
}
