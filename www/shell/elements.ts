/** Makes elements of the page. */

/** An element with this class and these contents. */
export function made<K extends keyof HTMLElementTagNameMap>(
  name: K,
  className: string,
  ...contents: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(name);
  element.className = className;
  element.append(...contents);
  return element;
}
