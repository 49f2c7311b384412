// What leads to a formation and what follows it, in groups.

import { wrapAngle } from "./units.js";

/** A smaller share is round-off of what a percentage shows. */
const ROUNDED = 0.0005;

/** The moves in pairs of opposite senses. */
const GROUPS = [
  { move: "cw", title: "turning clockwise" },
  { move: "ccw", title: "turning counter-clockwise" },
  { move: "roll-", title: "less roll" },
  { move: "roll+", title: "more roll" },
  { move: "pitch-", title: "less pitch" },
  { move: "pitch+", title: "more pitch" },
];

/**
 * The groups of a formation's node: {move, title, shown, more, rest}, where `shown` are the `most` formations with
 * the largest shares, `more` is how many others there are, `rest` their share, and `unchanged` the share of the formation's
 * phase at which the move leads to no other formation. The formation that comes next at this
 * very orientation, whose key `next` has by its move, stands first and is marked `here`.
 */
export function groupsOf(node, most, next) {
  return GROUPS.map((group) => {
    const members = node.following
      .filter(({ move }) => move === group.move)
      .map((one) => ({ ...one, here: one.formation === next[group.move] }))
      .sort((a, b) => b.here - a.here || b.share - a.share);
    const others = members.slice(most);
    const all = members.reduce((sum, { share }) => sum + share, 0);
    return {
      ...group,
      shown: members.slice(0, most),
      more: others.length,
      rest: others.reduce((sum, { share }) => sum + share, 0),
      unchanged: 1 - all > ROUNDED ? 1 - all : 0,
    };
  });
}

/**
 * Where a formation is found when it is followed from a pose by a move: the pose {roll, pitch, phase} half way through the
 * occurrence that the move leads to, or else through the nearest one; without a move (null), through the nearest one.
 */
export function followed(node, pose, move, grid) {
  const target = { ...pose };
  const tilt = { roll: "roll", pitch: "pitch" }[move?.slice(0, -1)];
  if (tilt) target[tilt] += move.endsWith("+") ? grid.tilt_step : -grid.tilt_step;
  const best = node.occurrences
    .map((one) => ({ one, far: distance(one, target, move) }))
    .reduce((a, b) => (b.far < a.far ? b : a)).one;
  const inside = covers(best, target.phase) ? target.phase : middleOf(best);
  return { roll: best.roll, pitch: best.pitch, phase: inside };
}

/** Orientations count far more than phase; a turn looks on in its own sense. */
function distance({ roll, pitch, start, end }, target, move) {
  const tilts = Math.abs(roll - target.roll) + Math.abs(pitch - target.pitch);
  const ahead = covers({ start, end }, target.phase) ? 0 : move === "cw" ? wrapAngle(target.phase - end) : wrapAngle(start - target.phase);
  return tilts * 1000 + ahead;
}

function covers({ start, end }, phase) {
  return wrapAngle(phase - start) < end - start;
}

function middleOf({ start, end }) {
  return wrapAngle((start + end) / 2);
}
