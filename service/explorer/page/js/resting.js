// Whether a state rests: only then is its last pose a place of the bolt (method, section 8).

const UNSTABLE = "unstable_two_point";

/** Whether the bolt rests: it is stable or quasi-stable, and lies flush or overlaps the nut by no more than the tolerance. */
export function rests({ class: stateClass, margins }) {
  return stateClass !== UNSTABLE && (margins.embedment === null || margins.embedment >= 0);
}

/** The height at which a state rests; null where it does not. */
export function restHeight(state) {
  return rests(state) ? state.poses.at(-1).translation[2] : null;
}

/** Why a state does not rest, in words; null where it does. */
export function whyNotAtRest(state) {
  if (rests(state)) return null;
  return state.class === UNSTABLE ? "ends unstable: does not rest" : "ends overlapping the nut: does not rest";
}

/** The last stage whose pose is a place of the bolt: of a state that does not rest, none after the second contact. */
export function lastStage(state) {
  return rests(state) ? state.poses.length : Math.min(state.poses.length, 2);
}
