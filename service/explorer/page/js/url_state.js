// The view as the fragment of an address, so that a link restores it exactly.

import { checkedAssembly } from "./assembly.js";
import { PLANES } from "./load.js";
import { checkedObservation } from "./observation.js";
import { checkedPoses } from "./poses.js";
import { QUANTITIES } from "./quantities.js";
import { checkedMap } from "./success_map.js";
import { TABS } from "./tabs.js";
import { TILT_LIMIT, TOLERANCE_LIMIT } from "./grid.js";
import { wrapAngle, parseDecimal } from "./units.js";
import { DEFAULTS, LOAD_LIMITS, THREAD_LENGTH } from "./view.js";

const finite = (text) => (Number.isFinite(parseDecimal(text)) ? parseDecimal(text) + 0 : undefined);
const between = (low, high, unit = "") => ({
  read: (text) => (finite(text) >= low && finite(text) <= high ? finite(text) : undefined),
  valid: `${low} to ${high}${unit}`,
});
const among = (...names) => ({ read: (text) => (names.includes(text) ? text : undefined), valid: names.join(", ") });
const whole = { read: (text) => (/^[0-9]{1,15}$/.test(text) ? Number(text) : undefined), valid: "the number of a library" };
const tilt = between(-TILT_LIMIT, TILT_LIMIT, " deg");
const tilts = {
  read: (text) => (text.split(" ").length === 2 && text.split(" ").every((one) => tilt.read(one) !== undefined) ? text : undefined),
  valid: "a roll and a pitch",
};

const READERS = {
  library: whole,
  roll: tilt,
  pitch: tilt,
  phase: { read: (text) => (finite(text) === undefined ? undefined : wrapAngle(finite(text))), valid: "an angle in deg" },
  tolerance: {
    read: (text) => (finite(text) > 0 && finite(text) <= TOLERANCE_LIMIT ? finite(text) : undefined),
    valid: `above 0 to ${TOLERANCE_LIMIT} deg`,
  },
  unit: among("in", "mm"),
  theme: among("auto", "light", "dark"),
  quantity: among(...Object.keys(QUANTITIES)),
  over: among("phase", "all"),
  from: between(-360, 360, " deg"),
  span: between(1e-6, 360, " deg"),
  stage: between(0, 3),
  tab: among(...TABS),
  nut: among("cut", "glass", "off"),
  azimuth: between(-1e6, 1e6, " deg"),
  elevation: between(-90, 90, " deg"),
  distance: between(0.01, 100),
  beside_library: whole,
  beside_roll: tilt,
  beside_pitch: tilt,
  poses: { read: checkedPoses, valid: "poses as the page writes them" },
  ...Object.fromEntries(Object.entries(LOAD_LIMITS).map(([name, limits]) => [name, between(...limits)])),
  plane: among(...Object.keys(PLANES)),
  assembly: { read: checkedAssembly, valid: "a pose and a device as the page writes them" },
  point: { read: (text) => (/^[0-9]{1,6}$/.test(text) ? Number(text) : undefined), valid: "the number of a point" },
  success: { read: checkedMap, valid: "a success map as the page writes it" },
  success_at: tilts,
  success_critical: tilts,
  kept_success: { read: checkedMap, valid: "a success map as the page writes it" },
  kept_success_critical: tilts,
  thread: {
    read: (text) => (text.trim() !== "" && text.length <= THREAD_LENGTH ? text.trim() : undefined),
    valid: `the designation of a thread, of up to ${THREAD_LENGTH} characters`,
  },
  observed: { read: checkedObservation, valid: "an observation as the page writes it" },
};

/** The fragment, without its #: what differs from the defaults, and the pose and library always. */
export function fragmentOf(view) {
  const always = ["library", "roll", "pitch", "phase"];
  return Object.keys(READERS)
    .filter((key) => view[key] !== null && (always.includes(key) || view[key] !== DEFAULTS[key]))
    .map((key) => `${key}=${encodeURIComponent(view[key])}`)
    .join("&");
}

/**
 * What a fragment (with # or without) holds: {view, remarks}. The part of a view is what is valid; the remarks say what was
 * left out, and what is valid, or what was brought into the turn.
 */
export function readFragment(fragment) {
  const view = {};
  const remarks = [];
  for (const [key, text] of new URLSearchParams(fragment.replace(/^#/, ""))) {
    if (!Object.hasOwn(READERS, key)) continue;
    const value = READERS[key].read(text);
    if (value === undefined) {
      remarks.push(`${key.replaceAll("_", " ")} in the link is ${text || "empty"}; valid: ${READERS[key].valid}`);
      continue;
    }
    if (key === "phase" && value !== Number(text)) remarks.push(turned(Number(text), value));
    view[key] = value;
  }
  return { view, remarks };
}

/** A remark that a phase was wrapped into 0 to 360. */
export function turned(given, value) {
  return `phase ${given} deg is ${value} deg within the turn`;
}
