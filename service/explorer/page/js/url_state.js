// The view as the fragment of an address, so that a link restores it exactly.

import { TABS } from "./tabs.js";
import { DEFAULTS } from "./view.js";

const between = (low, high) => (text) => {
  const value = Number(text);
  return text.trim() !== "" && Number.isFinite(value) && value >= low && value <= high ? value : undefined;
};
const among = (...names) => (text) => (names.includes(text) ? text : undefined);
const whole = (text) => (/^[0-9]{1,15}$/.test(text) ? Number(text) : undefined);
const word = (text) => (/^[a-z_]{1,40}$/.test(text) ? text : undefined);

const READERS = {
  library: whole,
  roll: between(-10, 10),
  pitch: between(-10, 10),
  phase: between(0, 359.9999999999999),
  unit: among("in", "mm"),
  theme: among("auto", "light", "dark"),
  quantity: word,
  over: among("phase", "all"),
  from: between(-360, 360),
  span: between(1e-6, 360),
  stage: between(0, 3),
  tab: among(...TABS),
  nut: among("cut", "glass", "off"),
  azimuth: between(-1e6, 1e6),
  elevation: between(-90, 90),
  distance: between(0.01, 100),
};

/** The fragment, without its #: what differs from the defaults, and the pose and library always. */
export function fragmentOf(view) {
  const always = ["library", "roll", "pitch", "phase"];
  return Object.keys(READERS)
    .filter((key) => view[key] !== null && (always.includes(key) || view[key] !== DEFAULTS[key]))
    .map((key) => `${key}=${encodeURIComponent(view[key])}`)
    .join("&");
}

/** The part of a view that a fragment (with # or without) holds; what is not valid is left out. */
export function viewOf(fragment) {
  const found = {};
  for (const [key, text] of new URLSearchParams(fragment.replace(/^#/, ""))) {
    const value = Object.hasOwn(READERS, key) ? READERS[key](text) : undefined;
    if (value !== undefined) found[key] = value;
  }
  return found;
}
