// Which phases the depth is drawn over.

import { visibleParts } from "./curve.js";
import { middleOfEvent } from "./falls.js";

const LEAST_SPAN = 1e-5;
const BESIDE_WINDOW = 0.15;
/** A whole turn begins at a multiple of this. */
const QUARTER = 90;

/** The whole turn, from where its main event is in the middle. */
export const WHOLE_TURN = Object.freeze({ from: null, span: 360 });

/** The range {from, span} that a view shows of a history (null: none known). */
export function rangeOf({ from, span }, history) {
  if (from !== null) return { from, span };
  const middle = middleOfEvent(history);
  return { from: middle === null ? 0 : aroundZero(Math.round((middle - 180) / QUARTER) * QUARTER), span };
}

/** The range after a zoom by a factor about a phase. */
export function zoomed({ from, span }, factor, middle) {
  const next = Math.max(span * factor, LEAST_SPAN);
  if (next >= 360) return WHOLE_TURN;
  return { from: aroundZero(middle - ((middle - from) / span) * next), span: next };
}

/** The phase to zoom about: the cursor where it is seen, else the middle. */
export function middleOf({ from, span, phase }) {
  const [shown] = visibleParts(phase, phase, from, span);
  return shown ? shown[0] : from + span / 2;
}

/** The range that shows the snap of a history and its first window, with some room beside them; null where it has neither. */
export function aroundEvent({ snap, windows }) {
  const window = windows[0];
  if (!snap && !window) return null;
  const start = snap ? snap.from : window.enter;
  const ends = [snap && snap.to, window && window.leave].filter(Boolean).map((end) => start + ((end - start) % 360 + 360) % 360);
  const width = Math.max(...ends) - start;
  return { from: aroundZero(start - BESIDE_WINDOW * width), span: Math.min((1 + 2 * BESIDE_WINDOW) * width, 360) };
}

/** The same phase, -180 to 180. */
function aroundZero(phase) {
  if (phase >= -180 && phase < 180) return phase + 0;
  return (((phase + 180) % 360) + 360) % 360 - 180;
}
