/** Whether the system asks for less motion. */
export const stillness = matchMedia('(prefers-reduced-motion: reduce)');
