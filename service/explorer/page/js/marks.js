// When what was first seen, for whoever measures: marks of the browser's own clock, from the start of the navigation.

const marked = new Set();

/** Marks that something is painted, the first time that it is. */
export function markPainted(name) {
  if (marked.has(name)) return;
  marked.add(name);
  requestAnimationFrame(() => setTimeout(() => performance.mark(`painted ${name}`)));
}
