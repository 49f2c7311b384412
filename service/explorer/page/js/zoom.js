// Which phases the depth is drawn over.

import { seen } from "./curve.js";

const LEAST_SPAN = 1e-5;
const BESIDE_WINDOW = 0.15;

export const WHOLE_TURN = Object.freeze({ from: 0, span: 360 });

/** The range after a zoom by a factor about a phase. */
export function zoomed({ from, span }, factor, middle) {
  const next = Math.max(span * factor, LEAST_SPAN);
  if (next >= 360) return WHOLE_TURN;
  const left = middle - ((middle - from) / span) * next;
  return { from: Math.min(Math.max(left, -360), 360), span: next };
}

/** The phase to zoom about: the cursor where it is seen, else the middle. */
export function middleOf({ from, span, phase }) {
  const [shown] = seen(phase, phase, from, span);
  return shown ? shown[0] : from + span / 2;
}

/** The range that shows a clearance window, with some room beside it. */
export function aroundWindow({ enter, width }) {
  const from = enter - BESIDE_WINDOW * width;
  return { from: from >= 180 ? from - 360 : from, span: Math.min((1 + 2 * BESIDE_WINDOW) * width, 360) };
}
