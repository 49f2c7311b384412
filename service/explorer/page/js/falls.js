// Where the bolt goes down along the phase: the snap of an orientation, in words and as phases to go to.

import { justAfter } from "./grid.js";
import { angle, angleNumber, wrapAngle, length, shortLength } from "./units.js";

/** Over how many degrees the steepest fall is looked for. */
export const STEEPEST_SPAN = 3;
const SNAP_FROM = "5 % of the thread pitch";

/** The phase just after the steepest part of a snap. */
export function afterSnap({ jump, jump_at: jumpAt, steepest_from: from }) {
  return jump > 0 ? justAfter(jumpAt) : wrapAngle(from + STEEPEST_SPAN);
}

/** A snap in one line. */
export function snapText(snap, unit) {
  const steep = snap.jump > 0
    ? `of it ${shortLength(snap.jump, unit)} at ${angle(wrapAngle(snap.jump_at), 2)}`
    : `of it ${shortLength(snap.steepest, unit)} within ${STEEPEST_SPAN} deg from ${angle(wrapAngle(snap.steepest_from), 2)}`;
  return `snap: falls ${shortLength(snap.fall, unit)} ${unit} from ${angleNumber(wrapAngle(snap.from), 1)} to ${angle(wrapAngle(snap.to), 1)}, ${steep}`;
}

/** Why there is no snap to go to. */
export function noSnapText(history, unit) {
  if (!history) return "No falls are known here: the library was computed by meshes, or its history has not come yet.";
  const { steepest } = history;
  const most = steepest === null || steepest === undefined ? "" : ` The steepest fall is ${length(steepest, unit)}.`;
  return `There is no snap here: the bolt never falls by more than ${SNAP_FROM} within ${STEEPEST_SPAN} deg.${most}`;
}

/** The jumps within the snap of a history. */
export function jumpsOfSnap({ snap, descents }) {
  if (!snap) return [];
  const descent = (descents ?? []).find(({ from, to }) => from === snap.from && to === snap.to);
  return descent?.jumps ?? [];
}

/** The middle of the main event of a history: of its snap, else of its first window; null where it has neither. */
export function middleOfEvent(history) {
  if (history?.snap) return wrapAngle((history.snap.from + history.snap.to) / 2);
  const window = history?.windows?.[0];
  return window ? wrapAngle((window.enter + window.leave) / 2) : null;
}

/** What is found within a tolerance on the measured angles, in one line. */
export function toleranceText(falls, unit) {
  const within = `within ±${falls.tolerance} deg`;
  if (!falls.snaps) return `${within}: no snap at any of ${falls.tilts} tilts; the steepest ${STEEPEST_SPAN} deg fall ${rangeText(falls.steepest, unit)}`;
  const some = falls.snaps < falls.tilts ? ` at ${falls.snaps} of ${falls.tilts} tilts` : "";
  const [from, to] = [falls.snap_from, falls.snap_to].map(([low, high]) => `${angleNumber(wrapAngle(low), 1)}–${angleNumber(wrapAngle(high), 1)}`);
  return `${within}: snaps${some}, falls ${rangeText(falls.fall, unit)}, from ${from} to ${to} deg`;
}

function rangeText([least, most], unit) {
  return `${shortLength(least, unit)} to ${shortLength(most, unit)} ${unit}`;
}
