// What is drawn, as tables.

import { DEVICE_NUMBERS, defaultText } from "./assembly.js";
import { firstHeight } from "./curve.js";
import { mapValues } from "./map_view.js";
import { QUANTITIES } from "./quantities.js";
import { restHeight } from "./resting.js";
import { curvesOf } from "./turned_path.js";
import { mapRequestOf } from "./success_map.js";

/** The map's cells. */
export function mapTable(model, view) {
  const cells = [...mapValues(model, view).values()];
  const kind = QUANTITIES[view.quantity].ofState ? ` ${view.over === "all" ? "over all phases" : `at phase ${model.map.phase}`}` : "";
  return [["roll_deg", "pitch_deg", `${view.quantity}${kind}`], ...cells.map(({ roll, pitch, value }) => [roll, pitch, value])];
}

/** Heights along the phase. */
export function depthTable({ heights }, { unit }) {
  const rows = heights.phases.map((phase, k) => [phase, heights.first_heights[k], heights.rest_heights?.[k] ?? null]);
  return [["phase_deg", `first_contact_z_${unit}`, `at_rest_z_${unit}`], ...rows];
}

/** The intervals with their contacts. */
export function intervalTable({ intervals }) {
  const rows = intervals.history.intervals.map(({ start, end, in_window: within, flags, formation }) => [
    start, end, formation.class, formation.key, flags.join(" "), within, formation.text,
  ]);
  return [["start_deg", "end_deg", "class", "formation", "flags", "in_window", "contacts"], ...rows];
}

/** What follows a formation. */
export function followingTable({ node: { node } }) {
  const rows = node.following.map((one) => [one.move, one.formation, one.class, one.share, one.change]);
  return [["move", "formation", "class", "share", "change"], ...rows];
}

/** The steps of the path to the window. */
export function pathTable({ path: { path } }, { unit }) {
  const rows = path.steps.map((one) => [
    one.move, one.roll, one.pitch, one.phase, one.turning, one.formation, one.class, one.margin, one.in_window, one.text,
  ]);
  const head = ["move", "roll_deg", "pitch_deg", "phase_deg", "turned_deg", "formation", "class", `margin_${unit}`, "in_window", "contacts"];
  return [head, ...rows];
}

/** All formations of the network. */
export function formationTable({ formations }) {
  const rows = formations.map((one) => [
    one.key, one.class, one.share, one.window_share, one.orientations, one.to_window.least, one.to_window.most, one.text,
  ]);
  return [["formation", "class", "share", "window_share", "orientations", "least_to_window_deg", "most_to_window_deg", "contacts"], ...rows];
}

/** Measured poses with the states that they have. */
export function poseTable({ measured }, { unit }) {
  const rows = measured.map(({ pose, state }) => [
    pose.roll, pose.pitch, pose.phase, state?.class, state ? firstHeight(state) : null, state ? restHeight(state) : null,
  ]);
  return [["roll_deg", "pitch_deg", "phase_deg", "class", `first_contact_z_${unit}`, `at_rest_z_${unit}`], ...rows];
}

/** Every number of a state, one a row: what it is of, its name, value and unit. */
export function stateTable({ state: { state, pose, unit } }) {
  const rows = [
    ...["roll", "pitch", "phase"].map((name) => ["pose", name, pose[name], "deg"]),
    ["state", "class", state.class, ""],
    ["state", "flags", state.flags.join(" "), ""],
    ["state", "lambda", state.turns[0], "deg"],
    ["state", "mu", state.turns[1], "deg"],
    ...["drop", "embedment", "pivot_offset"].flatMap((name) => [
      ["state", name, state[name], unit],
      ["state", `margin_${name}`, state.margins[name], unit],
    ]),
    ...state.contacts.flatMap((contact, k) => contactRows(`contact ${k + 1}`, contact, unit)),
    ...state.poses.flatMap((one, k) => poseRows(`pose at stage ${k + 1}`, one, unit)),
  ];
  return [["of", "name", "value", "unit"], ...rows];
}

/** The points of the path of a held bolt: what is drawn of them, and how it is held. */
export function turnedTable({ assembly: { path: answer } }, { unit }) {
  const curves = curvesOf(answer, unit);
  const columns = {
    phase: "phase_deg", height: `z_${unit}`, torque: `torque_N_${unit}`, largest_force: "largest_force_N", all_forces: "sum_of_forces_N", tilt: "tilt_deg", device_tilt: "device_tilt_deg", shift: `shift_${unit}`,
    ...Object.fromEntries(["elastic", "work", "push", "falls", "friction"].map((name) => [name, `${name}_N_${unit}`])),
  };
  const rows = answer.path.phase.map((_, k) => [...Object.keys(columns).map((name) => curves[name][k]), answer.path.held[k], answer.path.contacts[k].length]);
  return [[...Object.values(columns), "held", "contacts"], ...rows];
}

/** The outline of the jamming diagram, counter-clockwise. */
export function jammingTable({ jamming: { diagram } }) {
  return [diagram.axes, ...diagram.vertices];
}

const AXES = ["x", "y", "z"];

function contactRows(name, contact, unit) {
  const vector = (part, its) => AXES.map((axis, k) => [name, `${part}_${axis}`, contact[part][k], its]);
  return [
    ...["stage", "bolt_region", "nut_region", "features"].map((part) => [name, part, contact[part], ""]),
    ...vector("point", unit),
    ...vector("point_bolt", unit),
    ...vector("normal", ""),
    ...["bolt_margin", "nut_margin"].map((part) => [name, part, contact[part], unit]),
  ];
}

function poseRows(name, { rotation, translation }, unit) {
  return [
    ...rotation.flatMap((row, i) => row.map((value, j) => [name, `r${i + 1}${j + 1}`, value, ""])),
    ...translation.map((value, k) => [name, `t${AXES[k]}`, value, unit]),
  ];
}

/** The paths of a success map by orientation, with the device as it was given: lengths and torques in the unit of the map. */
export function successTable({ success: { value } }) {
  const { request } = mapRequestOf(value.text);
  const names = ["outcome", "flags", "bounded", "torque", "tilt", "shift", "end"];
  const device = [...DEVICE_NUMBERS.map((name) => request[name] || defaultText(name, request.unit)), request.about, request.unit];
  const paths = [...value.cells.values()].flat().sort((a, b) => a.roll - b.roll || a.pitch - b.pitch || a.phase - b.phase);
  const rows = paths.map((one) => [
    one.roll, one.pitch, one.phase, one.mu, ...names.map((name) => (name === "flags" ? one.flags.join(" ") : one[name])), value.unit, request.strategy, ...device,
  ]);
  return [["roll", "pitch", "phase", "mu", ...names, "unit", "strategy", ...DEVICE_NUMBERS, "about", "device_unit"], ...rows];
}

/** The figures of libraries side by side. */
export function comparisonTable({ comparison: { libraries } }) {
  const spreads = ["window", "widest", "fall", "embedment_most", "mu_hold_least", "mu_wedge_least"];
  const ends = ["least", "median", "most"];
  const rows = libraries.map((one) => [
    one.library, one.designation, one.axial_play, one.orientations.length, one.windows, one.snaps,
    ...Object.values(one.classes), ...one.held.map(({ share }) => share),
    ...spreads.flatMap((name) => ends.map((end) => one[name]?.[end] ?? null)), one.states, one.undecided,
  ]);
  const [{ classes, held }] = libraries;
  const head = [
    "library", "designation", "axial_play_pitches", "orientations", "with_windows", "snaps",
    ...Object.keys(classes).map((name) => `share_${name}`), ...held.map(({ mu }) => `share_held_at_${mu}`),
    ...spreads.flatMap((name) => ends.map((end) => `${name}_${end}`)), "states", "undecided",
  ];
  return [head, ...rows];
}
