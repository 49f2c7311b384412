// Every number of a state.

import { html } from "./html.js";
import { rests, whyNotAtRest } from "./resting.js";
import { CLASSES, FLAGS, REGIONS, TERMS, className } from "./terms.js";
import { angle, length, lengthNumber, fixed } from "./units.js";

/** Fills the frame with the tables of a state. */
export function showState(frame, { state, reason, pose, stored }, unit) {
  if (state === null) {
    frame.replaceChildren(html("p", {}, `No state at this pose: ${reason}`));
    return;
  }
  frame.replaceChildren(
    table("pose and class", summaryRows(state, pose, stored, unit)),
    ...state.contacts.map((contact, k) => table(`contact ${k + 1} of ${state.contacts.length}`, contactRows(contact, unit))),
    ...state.poses.map((one, k) => table(poseCaption(state, k), poseRows(one, unit))),
  );
}

function summaryRows(state, pose, stored, unit) {
  const turns = ["turn to the second contact", "turn to the third contact"].map((name, k) => [name, angle(state.turns[k])]);
  const margin = (value) => (value === null ? "" : `, ${length(value, unit)} from its threshold`);
  const { margins } = state;
  return [
    ["pose", `roll ${angle(pose.roll)}, pitch ${angle(pose.pitch)}, phase ${angle(pose.phase)}`],
    ["from", stored ? "the stored library" : "the exact solver, computed now"],
    ["class", `${className(state.class)}: ${CLASSES[state.class].help}`],
    ["flags", state.flags.map((flag) => FLAGS[flag]).join("; ") || "none"],
    ["first contact at", length(state.poses[0].translation[2], unit)],
    ...restRows(state, unit),
    ...turns,
    ["drop", length(state.drop, unit) + margin(margins.drop)],
    ["embedment", length(state.embedment, unit) + margin(margins.embedment)],
    ["pivot offset", length(state.pivot_offset, unit) + margin(margins.pivot_offset)],
  ];
}

/** The last height of a state: where it rests, or else where the procedure ended, which is no place of the bolt. */
function restRows(state, unit) {
  const last = length(state.poses.at(-1).translation[2], unit);
  if (rests(state)) return [["at rest at", last]];
  return [["at rest", whyNotAtRest(state)], ["where the procedure ended (no place of rest)", last]];
}

function poseCaption(state, k) {
  if (k === state.poses.length - 1 && !rests(state)) return "where the procedure ended (no place of rest)";
  return `bolt's pose at stage ${k + 1}`;
}

function contactRows(contact, unit) {
  const lengths = (point) => point.map((value) => lengthNumber(value, unit));
  return [
    ["made at", `stage ${contact.stage}, ${contact.features}`],
    ["bolt", `${REGIONS[contact.bolt_region]}, ${length(contact.bolt_margin, unit)} from its border`],
    ["nut", `${REGIONS[contact.nut_region]}, ${length(contact.nut_margin, unit)} from its border`],
    [`point in the nut (${unit})`, [lengths(contact.point)]],
    [`point in the bolt (${unit})`, [lengths(contact.point_bolt)]],
    ["normal, nut to bolt", [contact.normal.map((value) => fixed(value, 6))]],
  ];
}

function poseRows(pose, unit) {
  return [
    ["rotation, bolt to nut", pose.rotation.map((row) => row.map((value) => fixed(value, 6)))],
    [`origin (${unit})`, [pose.translation.map((value) => lengthNumber(value, unit))]],
  ];
}

/** A table of names and values; a value is a text, or rows of numbers. */
function table(caption, rows) {
  const body = rows.map(([name, value]) =>
    html("tr", {}, [
      html("th", { scope: "row" }, termOf(name)),
      typeof value === "string" ? html("td", {}, value) : html("td", { class: "numbers" }, value.map(numberRow)),
    ]),
  );
  return html("table", {}, [html("caption", {}, caption), html("tbody", {}, body)]);
}

/** A name; where the field has a word for it, with its meaning at the pointer and the focus. */
function termOf(name) {
  return TERMS[name] ? html("button", { type: "button", class: "term", "data-help": TERMS[name] }, name) : name;
}

function numberRow(numbers) {
  return html("div", { class: "number-row" }, numbers.map((number) => html("span", {}, number)));
}
