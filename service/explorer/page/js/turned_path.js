// The path of a held bolt that is turned, as the service answers it: its curves, events and outcome.

import { angle, angleNumber, fixed, length, shortLength, unitFactor } from "./units.js";

const DEGREE = Math.PI / 180;
/** Degrees of phase a second when a path is played, and how long a fall is looked at. */
const PLAYED_DEG_PER_S = 45;
const FALL_S = 0.6;
const TURNING_DEG = 1e-6;

/** Where each turn of one sense begins and ends: [first, last] points. */
export function legsOf({ phase }) {
  const legs = [];
  let first = 0;
  let sense = 0;
  for (let k = 1; k < phase.length; k++) {
    const step = phase[k] - phase[k - 1];
    const next = Math.abs(step) < TURNING_DEG ? sense : Math.sign(step);
    if (sense !== 0 && next !== sense) {
      legs.push([first, k - 1]);
      first = k - 1;
    }
    sense = next;
  }
  legs.push([first, phase.length - 1]);
  return legs;
}

/** The point at which each event has happened, in the order of both. */
export function pointsOfEvents({ phase }, events) {
  let at = 0;
  return events.map((event) => {
    for (let k = Math.max(at, 1); k < phase.length; k++) {
      if (phase[k] !== event.phase || Math.abs(phase[k - 1] - event.phase) > Math.abs(event.from_phase - event.phase) + TURNING_DEG) continue;
      at = k;
      break;
    }
    return at;
  });
}

/**
 * The curves over the points of an answer, lengths in a unit: phase, height of the origin, torque, the largest contact force and
 * the sum of their sizes, tilt of the bolt's axis, tilt and shift of the device, and since the start the change of elastic energy, work of hand and push, losses by falls and,
 * as what remains of these, by friction.
 */
export function curvesOf(answer, unit) {
  const { path, events } = answer;
  const factor = unitFactor(answer.unit, unit);
  const scaled = (values) => values.map((value) => value * factor);
  const height = path.potential.map((potential, k) => potential - path.elastic_energy[k]);
  const work = [0];
  for (let k = 1; k < path.phase.length; k++) {
    work.push(work[k - 1] + ((path.torque[k] + path.torque[k - 1]) / 2) * (path.phase[k] - path.phase[k - 1]) * DEGREE);
  }
  const falls = path.phase.map(() => 0);
  pointsOfEvents(path, events).forEach((at, k) => {
    for (let later = at; events[k].energy !== null && later < falls.length; later++) falls[later] += events[k].energy;
  });
  const elastic = path.elastic_energy.map((energy) => energy - path.elastic_energy[0]);
  const push = height.map((value) => height[0] - value);
  const forces = path.contacts.map((contacts) => contacts.map(forceSize));
  const friction = work.map((value, k) => value + push[k] - elastic[k] - falls[k]);
  return {
    phase: path.phase,
    height: scaled(path.pose.map(({ translation }) => translation[2])),
    torque: scaled(path.torque),
    largest_force: forces.map((sizes) => Math.max(0, ...sizes)),
    all_forces: forces.map((sizes) => sizes.reduce((sum, size) => sum + size, 0)),
    tilt: path.pose.map(({ rotation }) => Math.acos(Math.min(rotation[2][2], 1)) / DEGREE),
    device_tilt: path.deviation.map(({ rotation }) => Math.hypot(...rotation)),
    shift: scaled(path.deviation.map(({ shift: [x, y] }) => Math.hypot(x, y))),
    elastic: scaled(elastic),
    work: scaled(work),
    push: scaled(push),
    falls: scaled(falls),
    friction: scaled(friction),
  };
}

/** The size of a contact's force, N. */
export function forceSize({ force }) {
  return Math.hypot(...force);
}

/** The line of the lead through the end of a path: [phase, height] at both ends of its last turn. */
export function leadLine({ phase, height }, legs, { thread_pitch: threadPitch, starts = 1, hand = "right" }) {
  const slope = (threadPitch * starts * (hand === "left" ? -1 : 1)) / 360;
  const [first, last] = legs.at(-1);
  return [first, last].map((k) => [phase[k], height[last] + slope * (phase[k] - phase[last])]);
}

/** The point nearest to a phase, of the turn that a point belongs to where that passes the phase. */
export function nearestPoint({ phase }, legs, wanted, at) {
  const own = legs.filter(([first, last]) => first <= at && at <= last);
  const passes = ([first, last]) => (phase[first] - wanted) * (phase[last] - wanted) <= 0;
  const within = [...own, ...legs].find(passes);
  const [first, last] = within ?? [0, phase.length - 1];
  let found = first;
  for (let k = first; k <= last; k++) if (Math.abs(phase[k] - wanted) < Math.abs(phase[found] - wanted)) found = k;
  return found;
}

/** When each point is shown as a path is played, in seconds. */
export function playTimes({ phase }, events, at) {
  const falls = new Set(at.filter((_, k) => events[k].kind === "fall"));
  const times = [0];
  for (let k = 1; k < phase.length; k++) times.push(times[k - 1] + Math.abs(phase[k] - phase[k - 1]) / PLAYED_DEG_PER_S + (falls.has(k) ? FALL_S : 0));
  return times;
}

/** The last point that is shown so many seconds after the start. */
export function pointAtTime(times, seconds) {
  let [low, high] = [0, times.length - 1];
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (times[middle] <= seconds) low = middle;
    else high = middle - 1;
  }
  return low;
}

const KINDS = {
  gained: ({ features }) => `contact gained, ${features}`,
  lost: ({ features_before: before }) => `contact lost, ${before}`,
  moved: ({ features_before: before, features }) => `contact moves, ${before} to ${features}`,
  fall: ({ drop, way }, unit, factor) => `fall: down ${shortLength(drop * factor, unit)}, way ${shortLength(way * factor, unit)} ${unit}`,
  snap: ({ drop }, unit, factor) => (drop === null ? "snap" : `snap: down ${shortLength(drop * factor, unit)} ${unit}`),
  on_surface: () => "base comes to lie on the surface",
  off_surface: () => "base leaves the surface",
  on_strip: () => "comes to lie on a strip of flank",
  off_strip: () => "leaves the strip of flank",
  ambiguous: () => "step with several solutions",
  frictionless_fall: () => "this fall was followed without friction",
  bridged: () => "not resolved within this step",
};

/** What happens at an event, lengths multiplied by a factor to be in a unit. */
export function eventText(event, unit, factor) {
  return KINDS[event.kind](event, unit, factor);
}

const OUTCOMES = {
  engaged: "The bolt engages",
  cross_threaded: "Cross-threaded: the bolt follows the lead, but not in phase",
  jammed: "The bolt jams: the torque has passed its limit, or the device's",
  no_snap: "No snap within a whole turn",
  idle: "Idle: the bolt turns without following the thread",
  slipped: "The bolt slips off the nut sideways",
  over_travel: "The device has passed its limit of tilt or shift",
  undecided: "Undecided",
};
/** Why a path has no certain answer, or what is out of the ordinary about it. */
const REASONS = {
  flush: "the base lies flush on the nut's surface",
  marginal: "a place touches that carries no force",
  first_contact: "the first contact could not be excluded elsewhere",
  deep: "deeper than 3.6 thread pitches",
  tilted: "tilted by more than the flank's half-angle",
  unsettled: "the descent did not end within its steps",
  overlap: "an overlap could not be excluded",
  unbalanced: "the forces do not balance device and push",
  unstable: "the equilibrium is no minimum",
  ambiguous: "a step with friction had several solutions",
  frictionless_fall: "a fall was followed without friction",
  many_contacts: "more than eight contacts with friction",
  step_dependent: "with half the step it ends otherwise, or falls or changes contacts elsewhere",
};
/** Which margin an outcome rests on first. */
const DECISIVE = { engaged: "lead", cross_threaded: "play", jammed: "torque", no_snap: "snap", slipped: "offset" };

/** Margins: name in words, text of a value, help. Positive where the rule holds. */
export const MARGINS = {
  lead: { name: "height on the lead", text: (value) => `${fixed(100 * value, 1)} %`, help: "By how much the height follows the lead better than within 5 %, over the last 90 deg of the clockwise turn." },
  play: { name: "play in phase", text: (value, unit) => length(value, unit), isLength: true, help: "How far inside the axial play in phase the last height is." },
  tilt: { name: "last tilt", text: (value) => angle(value, 3), help: "By how much the last tilt is below what the play allows." },
  torque: { name: "torque", text: (value) => `${fixed(value, 2)} × push × radius`, help: "By how much the largest torque is below its limit of 20 times push times nominal radius." },
  offset: { name: "offset", text: (value, unit) => length(value, unit), isLength: true, help: "How far the origin stayed from slipping: half the bolt's major diameter." },
  snap: { name: "snap", text: (value, unit) => length(value, unit), isLength: true, help: "By how much the snap is deeper than it has to be: 5 % of a thread pitch within 3 deg." },
};

/** The text of a margin in a unit, from an answer. */
export function marginText(name, answer, unit) {
  const { text, isLength } = MARGINS[name];
  return text(answer.margins[name] * (isLength ? unitFactor(answer.unit, unit) : 1), unit);
}

/** How a path ends, in a sentence with the margin that it rests on. */
export function outcomeText(answer, unit) {
  const { outcome, flags, margins } = answer;
  const decisive = DECISIVE[outcome];
  const margin = decisive && (margins?.[decisive] ?? null) !== null ? ` Margin of the ${MARGINS[decisive].name}: ${marginText(decisive, answer, unit)}.` : "";
  const reasons = flags.length > 0 ? ` (${flags.map((flag) => REASONS[flag]).join("; ")})` : "";
  return `${OUTCOMES[outcome]}${reasons}.${margin}`;
}

/** A point of a path in one line. */
export function pointText({ phase, held, contacts }, at) {
  const holds = { contacts: contacts[at].length === 1 ? "1 contact" : `${contacts[at].length} contacts`, surface: "on the surface", strip: "on a strip of flank" };
  return `point ${at + 1} of ${phase.length}, phase ${angleNumber(phase[at], 2)} deg, ${holds[held[at]]}`;
}
