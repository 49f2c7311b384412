// What the map of orientations can show.

import { angle, fixed, length, percent } from "./units.js";

/** How near the class is to a threshold: the least distance of the three that the state has. */
export function nearestThreshold(margins) {
  const known = Object.values(margins).filter((margin) => margin !== null).map(Math.abs);
  return known.length > 0 ? Math.min(...known) : null;
}

const ofWindows = (pick) => (orientation) => (orientation.windows.length > 0 ? pick(orientation.windows) : null);

/**
 * A quantity: its name, a line of help, how it is written, and how it is read from a state (`ofState`) and from an
 * orientation's summary with its windows and falls (`ofAll`, named by `all`); `none` says what is missing where there is none; colours have a fixed `range`, or that of the values. Without `ofState` it belongs to the orientation.
 */
export const QUANTITIES = {
  class: {
    name: "class",
    help: "whether the bolt comes to rest, and how",
    all: "share of phases with a stable state",
    ofState: (state) => state.class,
    ofAll: (orientation) => stableShare(orientation.counts),
    write: (value) => percent(value),
  },
  window_width: {
    name: "window width",
    help: "width of the clearance window: how far the bolt can turn while its edge is within the thread",
    ofAll: ofWindows((windows) => windows.reduce((sum, window) => sum + window.width, 0)),
    none: "no window",
    write: (value) => angle(value, 3),
  },
  snap: {
    name: "fall at the snap",
    help: "how far the bolt goes down in the descent that has its steepest fall; none where that is less than 5 % of the thread pitch",
    ofAll: (orientation) => orientation.snap?.fall ?? null,
    none: "no snap",
    write: length,
  },
  steepest: {
    name: "steepest fall",
    all: "steepest fall",
    help: "the largest fall within any 3 deg of phase",
    ofAll: (orientation) => orientation.steepest ?? null,
    write: length,
  },
  drop: {
    name: "drop",
    help: "how far the origin sinks from the second contact to the third",
    all: "greatest drop",
    ofState: (state) => state.drop,
    ofAll: (orientation) => orientation.drop_most,
    write: length,
  },
  pivot_offset: {
    name: "pivot offset",
    help: "distance of the bolt's origin from the axis through the first two contacts",
    all: "least pivot offset",
    ofState: (state) => state.pivot_offset,
    ofAll: (orientation) => orientation.pivot_offset_least,
    write: length,
  },
  embedment: {
    name: "embedment",
    help: "the least lift after which the bolt, in its third pose, does not overlap the nut",
    all: "greatest embedment",
    ofState: (state) => state.embedment,
    ofAll: (orientation) => orientation.embedment_most,
    write: length,
  },
  margin: {
    name: "margin of the class",
    help: "distance of the nearest of the class's numbers from its threshold",
    all: "least margin of the class",
    ofState: (state) => nearestThreshold(state.margins),
    ofAll: (orientation) => orientation.margin_least,
    write: length,
  },
  mu_hold: {
    name: "μ that holds",
    help: "the least coefficient of friction at which contacts can hold a push along -z through the bolt's origin",
    all: "least friction that holds a push",
    ofState: (state) => state.statics?.mu_hold ?? null,
    ofAll: (orientation) => orientation.mu_hold_least,
    none: "no friction holds",
    range: [0, 1],
    write: (value) => fixed(value, 3),
  },
  mu_wedge: {
    name: "μ that wedges",
    help: "the least coefficient of friction at which contacts can press against each other without any load",
    all: "least friction that wedges",
    ofState: (state) => state.statics?.mu_wedge ?? null,
    ofAll: (orientation) => orientation.mu_wedge_least,
    none: "never wedges",
    range: [0, 3],
    write: (value) => fixed(value, 3),
  },
  support_margin: {
    name: "support margin",
    help: "distance of a push from the boundary of what the contacts balance without friction, over the push; negative outside",
    all: "greatest support margin",
    ofState: (state) => state.statics?.support_margin ?? null,
    ofAll: (orientation) => orientation.support_margin_most,
    write: (value) => fixed(value, 4),
  },
};

/** The share of an orientation's states that are stable. */
export function stableShare(counts) {
  const all = Object.values(counts).reduce((sum, count) => sum + count, 0);
  return all > 0 ? counts.stable_three_point / all : null;
}

/** Whether a map shows summaries of whole orientations: over all phases, or a quantity that no state has. */
export function needsSummaries({ quantity, over }) {
  return over === "all" || !QUANTITIES[quantity].ofState;
}
