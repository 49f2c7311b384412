// The way to the window by turning alone, from the intervals of an orientation: where no network knows the orientation.

import { wrapAngle } from "./units.js";

/** The path from a phase counter-clockwise to the window, as the service gives paths; null where no window comes. */
export function turnPath({ roll, pitch, intervals }, phase) {
  const here = intervals.findIndex(({ start, end }) => wrapAngle(phase - start) < end - start);
  if (here < 0) return null;
  const steps = [];
  for (let k = 0; k < intervals.length; k++) {
    const { start, formation, margin, in_window: within } = intervals[(here + k) % intervals.length];
    const at = k === 0 ? phase : wrapAngle(start);
    const { key, class: stateClass, text } = formation;
    steps.push({ move: k === 0 ? null : "ccw", roll, pitch, phase: at, turning: wrapAngle(at - phase), formation: key, class: stateClass, text, margin, in_window: within });
    if (within) return { steps, turning: steps.at(-1).turning, transitions: steps.length - 1 };
  }
  return null;
}
