// What is drawn, as tables.

import { mapValues } from "./map_view.js";
import { QUANTITIES } from "./quantities.js";

/** The map's cells. */
export function mapTable(model, view) {
  const cells = [...mapValues(model, view).values()];
  const kind = QUANTITIES[view.quantity].ofState ? ` ${view.over === "all" ? "over all phases" : `at phase ${model.map.phase}`}` : "";
  return [["roll_deg", "pitch_deg", `${view.quantity}${kind}`], ...cells.map(({ roll, pitch, value }) => [roll, pitch, value])];
}

/** Heights along the phase. */
export function depthTable({ heights }, { unit }) {
  const rows = heights.phases.map((phase, k) => [phase, heights.first_heights[k], heights.last_heights[k]]);
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

/** The contacts of a state. */
export function contactTable({ state: { state, unit } }) {
  const axes = ["x", "y", "z"];
  const head = [
    "stage", "bolt_region", "nut_region", "features",
    ...axes.map((axis) => `point_${axis}_${unit}`),
    ...axes.map((axis) => `point_bolt_${axis}_${unit}`),
    ...axes.map((axis) => `normal_${axis}`),
    `bolt_margin_${unit}`, `nut_margin_${unit}`,
  ];
  const rows = state.contacts.map((one) => [
    one.stage, one.bolt_region, one.nut_region, one.features,
    ...one.point, ...one.point_bolt, ...one.normal, one.bolt_margin, one.nut_margin,
  ]);
  return [head, ...rows];
}
