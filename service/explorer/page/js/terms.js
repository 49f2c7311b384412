// Words for the names in the service's responses.

export const CLASSES = {
  stable_three_point: { name: "stable three-point", short: "stable", letter: "S", help: "three contacts hold the bolt, or it lies flush" },
  quasi_stable_two_point: {
    name: "quasi-stable two-point",
    short: "quasi-stable",
    letter: "Q",
    help: "two contacts, and the pivot axis passes near the bolt's origin",
  },
  unstable_two_point: { name: "unstable two-point", short: "unstable", letter: "U", help: "two contacts, about which the bolt goes on turning" },
};

export const REGIONS = {
  root: "root",
  root_fillet_pos: "positive root fillet",
  flank_pos: "positive flank",
  crest_fillet_pos: "positive crest fillet",
  crest: "crest",
  crest_fillet_neg: "negative crest fillet",
  flank_neg: "negative flank",
  root_fillet_neg: "negative root fillet",
  surface: "surface",
  base: "base",
};

const SHORT_REGIONS = {
  root_fillet_pos: "root fillet +",
  flank_pos: "flank +",
  crest_fillet_pos: "crest fillet +",
  crest_fillet_neg: "crest fillet −",
  flank_neg: "flank −",
  root_fillet_neg: "root fillet −",
};

export const FLAGS = {
  flush: "flush: the bolt lies on a patch, not on points",
  tie: "tie: several contacts at once",
  balanced: "balanced: the origin lies on the pivot axis, both senses were followed",
  grazing: "grazing: the features that touch are nearly parallel",
  no_second: "no second contact within 45 deg",
  no_third: "no third contact within 45 deg",
};

/** Pairs of features that can touch, the bolt's first. */
export const FEATURES = ["edge-edge", "edge-surface", "base-edge", "edge-thread", "thread-edge", "thread-thread", "thread-surface", "flush"];

/** The meaning of a state's numbers. */
export const TERMS = {
  "held from friction": "The least coefficient of friction at which the contacts can balance the load.",
  "can wedge from friction": "The least coefficient of friction at which contacts can press against each other without any load.",
  "support margin": "Distance of the load, made of size 1, from the boundary of what the contacts balance without friction; negative outside.",
  "torque that turns it ccw": "Torque about the nut's axis, over push times nominal radius, at which the bolt begins to turn counter-clockwise.",
  "torque that turns it cw": "Torque about the nut's axis, over push times nominal radius, at which the bolt begins to turn clockwise.",
  flags: "What is out of the ordinary about this state.",
  "first contact at": "Height of the bolt's origin above the nut's surface when it first touches.",
  "at rest at": "Height of the bolt's origin above the nut's surface in its last pose, in which it rests.",
  "at rest": "Only a stable or quasi-stable state that does not overlap the nut rests; its last pose alone is a place of the bolt.",
  "turn to the second contact": "Lambda: how far the bolt turns about its first contact until it touches a second time.",
  "turn to the third contact": "Mu: how far the bolt turns about the pivot axis until it touches a third time.",
  drop: "How far the origin sinks from the second contact to the third.",
  embedment: "The least lift after which the bolt, in its third pose, does not overlap the nut.",
  "pivot offset": "Distance of the bolt's origin from the pivot axis, which goes through the first two contacts.",
  "made at": "The stage at which it is made, and which features touch: the bolt's first, then the nut's.",
  "normal, nut to bolt": "Unit normal of the surfaces that touch, out of the nut.",
};

/** A state in one line: its class, and its flags in a few words. */
export function stateLine({ class: stateClass, flags }) {
  return [className(stateClass), ...flags.map((flag) => FLAGS[flag].split(/:| within/)[0])].join(", ");
}

/** A region in a few letters. */
export function shortRegion(region) {
  return SHORT_REGIONS[region] ?? REGIONS[region];
}

/** The class in words, or "undecided" where there is none. */
export function className(stateClass) {
  return CLASSES[stateClass]?.name ?? "undecided";
}
