// Performance marks of when something was first painted, in the browser's own clock.

const marked = new Set();

/** Marks that something is painted, the first time that it is. */
export function markPainted(name) {
  if (marked.has(name)) return;
  marked.add(name);
  requestAnimationFrame(() => setTimeout(() => performance.mark(`painted ${name}`)));
}
