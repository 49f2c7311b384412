// What is asked of a bolt that a device holds and turns: the pose, the device and the strategy, as the view has them.

import { angle, parseDecimal, unitFactor } from "./units.js";

const UNITS = ["in", "mm"];
/** Digits of a number that was converted to another unit. */
const DIGITS = 12;
const SHOWN_DIGITS = 6;
const LONGEST = 40;

/** Numbers of the request, by name: its label, the power of length in it, the default (lengths in mm; null: none), help. */
export const NUMBERS = {
  roll: { label: "roll (deg)", power: 0, default: null, help: "The commanded turn about x, -10 to 10 deg: as shown above unless it is changed here." },
  pitch: { label: "pitch (deg)", power: 0, default: null, help: "The commanded turn about y, -10 to 10 deg: as shown above unless it is changed here." },
  phase: { label: "phase (deg)", power: 0, default: null, help: "The commanded phase at which the bolt settles before it is turned." },
  mu: { label: "friction μ", power: 0, default: 0, help: "Coefficient of friction of all contacts, 0 to 1. A path with friction takes some ten times as long." },
  push: { label: "push (N)", power: 0, default: 10, help: "Force along -z at the compliance centre." },
  k_lateral: { label: "k lateral", unit: "N/L", power: -1, default: 20, help: "Stiffness against a shift of the compliance centre across the nut's axis." },
  k_axial: { label: "k axial", unit: "N/L", power: -1, default: 0, help: "Stiffness along the nut's axis, from the height at the first contact." },
  k_tilt: { label: "k tilt", unit: "N L/rad", power: 1, default: 500, help: "Stiffness against turns about the commanded bolt's x and y." },
  k_twist: { label: "k twist", unit: "N L/rad", power: 1, default: "rigid", help: "Stiffness against turns about the commanded bolt's axis, or rigid." },
  centre: { label: "centre", unit: "L", power: 1, default: 0, help: "Height of the compliance centre over the plane of the bolt's end that enters the nut; as the bolt begins, that is about the nut's upper surface. Negative: below it, within the nut." },
  ccw_turn: { label: "ccw turn (deg)", power: 0, default: 360, help: "How far the hand turns counter-clockwise at most until the snap, 1 to 450 deg. A snap that comes soon after a whole turn is missed by 360." },
  tilt_limit: { label: "tilt limit (deg)", power: 0, default: "any", help: "The path ends where the device tilts by more than that." },
  shift_limit: { label: "shift limit", unit: "L", power: 1, default: "any", help: "The path ends where the compliance centre shifts sideways by more than that." },
  torque_limit: { label: "torque limit", unit: "N L", power: 1, default: "any", help: "The bolt jams where the hand's torque is more than that; at the latest at 20 times push times nominal radius." },
};
/** Choices of the request, by name: its label, the values with their texts, the default first, and help. */
export const CHOICES = {
  strategy: {
    label: "strategy",
    values: { ccw_then_cw: "ccw, then cw", cw: "cw at once" },
    help: "Counter-clockwise until the snap or through the ccw turn, and from there clockwise through 270 deg; or clockwise through 270 deg at once. A left-hand bolt is turned the other way round.",
  },
  about: {
    label: "tilt of the hand",
    values: { nut: "goes round", bolt: "stays in space" },
    help: "Which axis the hand turns about: the nut's, and the tilt goes round with the phase; or the bolt's own, and it stays in space.",
  },
  confirm: {
    label: "steps",
    values: { no: "as usual", yes: "and half as long" },
    help: "Whether the path is followed with half the step as well, which takes some three times as long. It is flagged where that moves a fall or a contact, and undecided where it ends otherwise.",
  },
};
const POSE = ["roll", "pitch", "phase"];
/** The numbers of a device, without those of the pose and the contacts. */
export const DEVICE_NUMBERS = ["push", "k_lateral", "k_axial", "k_tilt", "k_twist", "centre", "ccw_turn", "tilt_limit", "shift_limit", "torque_limit"];

/** The label of a number, with the unit of lengths. */
export function labelOf(name, unit) {
  const { label, unit: own } = NUMBERS[name];
  return own ? `${label} (${own.replace("L", unit)})` : label;
}

/** The default of a number in a unit, in a few digits; null where it has none. */
export function defaultText(name, unit) {
  const { default: value } = NUMBERS[name];
  return value === null ? null : convertedText(name, String(value), "mm", unit, SHOWN_DIGITS);
}

/** The text of a number converted from one unit of lengths to another; what is no number stays. */
export function convertedText(name, text, from, to, digits = DIGITS) {
  const { power } = NUMBERS[name];
  const value = parseDecimal(text.trim());
  if (power === 0 || from === to || Number.isNaN(value)) return text;
  return String(Number((value * unitFactor(from, to) ** power).toPrecision(digits)));
}

/** A request, texts by name, as one text: what differs from the defaults, the pose and the unit always. */
export function assemblyText(request) {
  const given = Object.entries(request).filter(([name, text]) => name === "unit" || POSE.includes(name) || !isDefault(name, text));
  return given.map(([name, text]) => `${name}=${encodeURIComponent(text.trim())}`).join("&");
}

/** The request of a text, every name with its own; empty where it is left out. */
export function requestOf(text) {
  const given = new URLSearchParams(text);
  const numbers = Object.keys(NUMBERS).map((name) => [name, given.get(name) ?? ""]);
  const choices = Object.entries(CHOICES).map(([name, { values }]) => [name, given.get(name) ?? Object.keys(values)[0]]);
  return Object.fromEntries([...numbers, ...choices, ["unit", given.get("unit") ?? "mm"]]);
}

/** A request's text where it is one as the page writes it, else undefined. */
export function checkedAssembly(text) {
  const given = [...new URLSearchParams(text)];
  const names = given.map(([name]) => name);
  const complete = [...POSE, "unit"].every((name) => names.includes(name)) && new Set(names).size === names.length;
  return complete && given.every(([name, value]) => isValue(name, value)) ? text : undefined;
}

/** The body of the request to the service; what is no number is sent as it is, for the service to say what is valid. */
export function bodyOf(text, library) {
  const request = requestOf(text);
  const value = (name) => (Object.hasOwn(NUMBERS, name) ? numberOrText(request[name]) : request[name]);
  const part = (names) => Object.fromEntries(names.filter((name) => request[name] !== "").map((name) => [name, value(name)]));
  return {
    library,
    pose: Object.fromEntries(POSE.map((name) => [name, value(name)])),
    device: { unit: request.unit, ...part([...DEVICE_NUMBERS, "about"]) },
    ...part(["strategy", "mu"]),
    ...(request.confirm === "yes" ? { confirm: true } : {}),
  };
}

/** What of a request a device document of the service is, texts by name; null where it has a whole stiffness matrix. */
export function requestOfDevice(device) {
  if (device.stiffness !== null) return null;
  const text = (name) => String(device[name] ?? "");
  const isGiven = (name) => text(name) !== convertedText(name, String(NUMBERS[name].default), "mm", device.unit);
  return { unit: device.unit, about: device.about, ...Object.fromEntries(DEVICE_NUMBERS.map((name) => [name, isGiven(name) ? text(name) : ""])) };
}

/** Whether two requests have the same values of these names, in whatever units of lengths; what is left empty has its default. */
export function isSameRequest(one, other, names) {
  const inMm = (request, name) => (request[name].trim() === "" ? String(NUMBERS[name].default) : convertedText(name, request[name].trim(), request.unit, "mm"));
  return names.every((name) => {
    const [first, second] = [one, other].map((request) => (Object.hasOwn(NUMBERS, name) ? inMm(request, name) : request[name]));
    const [number, near] = [first, second].map(parseDecimal);
    return first === second || Math.abs(number - near) <= 10 ** -SHOWN_DIGITS * Math.abs(number);
  });
}

/** Push (N), and height of the compliance centre in a unit, of a request. */
export function deviceOf(text, unit) {
  const request = requestOf(text);
  const number = (name) => parseDecimal(request[name] === "" ? defaultText(name, unit) : convertedText(name, request[name], request.unit, unit));
  return { push: number("push"), centre: number("centre") };
}

/** What a refused value is of: {name: message} of the fields, under "" what is of none. */
export function refusedFields(message, errors) {
  const fields = {};
  for (const { location, value, valid } of errors) {
    const name = Object.keys({ ...NUMBERS, ...CHOICES }).find((one) => location.split(" ").includes(one));
    if (name) fields[name] = fields[name] ? `${fields[name]}; ${valid}` : `${value === "" ? "empty" : value} is not valid: ${valid}`;
  }
  return Object.keys(fields).length > 0 ? fields : { "": message };
}

/** How far a path is, in words. */
export function progressText(progress) {
  if (progress === null || progress.leg === 0) return "the bolt settles …";
  const at = progress.phase === null ? "" : `, phase ${angle(progress.phase, 1)}`;
  return `turn ${progress.leg}: ${progress.points} points so far${at} …`;
}

function numberOrText(text) {
  const value = parseDecimal(text);
  return Number.isNaN(value) ? text : value;
}

function isDefault(name, text) {
  return Object.hasOwn(NUMBERS, name) ? text.trim() === "" : text === Object.keys(CHOICES[name].values)[0];
}

function isValue(name, value) {
  if (name === "unit") return UNITS.includes(value);
  if (Object.hasOwn(CHOICES, name)) return Object.hasOwn(CHOICES[name].values, value);
  return Object.hasOwn(NUMBERS, name) && value.length <= LONGEST && (!Number.isNaN(parseDecimal(value)) || (name === "k_twist" && value === "rigid"));
}
