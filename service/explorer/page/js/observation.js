// What was observed of a state, to be searched for in the library: as a form's fields, and as a query.

import { CLASSES, FEATURES, FLAGS, REGIONS } from "./terms.js";

/** How many contacts can be described in the form. */
export const MOST_CONTACTS = 3;
const ANY = "*";
const PARTS = ["stage", "bolt", "nut", "features"];
const VALID = {
  stage: ["1", "2", "3"],
  bolt: Object.keys(REGIONS).filter((region) => region !== "surface"),
  nut: Object.keys(REGIONS).filter((region) => region !== "base"),
  features: FEATURES,
};

/** Nothing observed. */
export function nothingObserved() {
  return { class: "", flag: "", contacts: "", contact: [], ordered: false };
}

/** An observation, {class, flag, contacts, contact: [{stage, bolt, nut, features}], ordered}, as a query; "" means any. */
export function observationText(observation) {
  const contact = observation.contact
    .map((one) => PARTS.map((part) => one[part] || ANY).join(":"))
    .filter((text) => text !== PARTS.map(() => ANY).join(":"));
  const found = Object.entries({
    class: observation.class,
    flag: observation.flag,
    contacts: observation.contacts,
    contact: contact.join(","),
    ordered: observation.ordered && contact.length > 0 ? "true" : "",
  }).filter(([, value]) => value !== "");
  return found.map(([name, value]) => `${name}=${value}`).join("&");
}

/** The observation that a query has; what is not valid in it is left out. */
export function observationOf(text) {
  const query = new URLSearchParams(text);
  const among = (value, valid) => (valid.includes(value) ? value : "");
  const contact = (query.get("contact") ?? "")
    .split(",")
    .filter((one) => one !== "")
    .slice(0, MOST_CONTACTS)
    .map((one) => Object.fromEntries(PARTS.map((part, k) => [part, among(one.split(":")[k], VALID[part])])));
  return {
    class: among(query.get("class"), Object.keys(CLASSES)),
    flag: among(query.get("flag"), Object.keys(FLAGS)),
    contacts: among(query.get("contacts"), ["1", "2", "3", "4", "5", "6", "7", "8"]),
    contact,
    ordered: query.get("ordered") === "true",
  };
}

/** The query if all of it is valid, or undefined. */
export function checkedObservation(text) {
  return observationText(observationOf(text)) === text ? text : undefined;
}

/** The query parameters of the request. */
export function observationQuery(text) {
  return Object.fromEntries(new URLSearchParams(text));
}

/**
 * The orientations that remain, those with the most phase first: {roll, pitch, degrees, share, stretches, phase}, where
 * `share` is of all that remains and `phase` is half way through the longest stretch.
 */
export function remaining(stretches) {
  const found = new Map();
  for (const one of stretches) {
    const key = `${one.roll} ${one.pitch}`;
    if (!found.has(key)) found.set(key, { roll: one.roll, pitch: one.pitch, degrees: 0, stretches: [] });
    const orientation = found.get(key);
    orientation.degrees += one.end - one.start;
    orientation.stretches.push(one);
  }
  const all = [...found.values()].reduce((sum, { degrees }) => sum + degrees, 0);
  return [...found.values()]
    .map((one) => {
      const longest = one.stretches.reduce((a, b) => (b.end - b.start > a.end - a.start ? b : a));
      return { ...one, share: all > 0 ? one.degrees / all : 0, phase: ((longest.start + longest.end) / 2) % 360 };
    })
    .sort((a, b) => b.degrees - a.degrees || a.roll - b.roll || a.pitch - b.pitch);
}
