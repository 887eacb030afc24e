/** Light or dark: as the system says, until the visitor chooses. */

const system = matchMedia('(prefers-color-scheme: dark)');
const listeners = new Set<() => void>();

function isDark(): boolean {
  const { theme } = document.documentElement.dataset;
  return theme === undefined ? system.matches : theme === 'dark';
}

/** Calls back when the colours have changed. */
export function onTheme(callback: () => void): void {
  listeners.add(callback);
}

export function toggleTheme(): void {
  document.documentElement.dataset.theme = isDark() ? 'light' : 'dark';
  for (const callback of listeners) callback();
}

system.addEventListener('change', () => listeners.forEach((callback) => callback()));

/** Reads colours of `tokens.css`, for what style sheets cannot reach. */
export function colourReader(): (token: string) => string {
  const probe = document.createElement('i');
  probe.hidden = true;
  document.body.append(probe);
  const style = getComputedStyle(probe);
  // The browser computes `color` when it is read.
  queueMicrotask(() => probe.remove());
  return (token) => {
    probe.style.color = `var(--${token})`;
    return style.color;
  };
}
