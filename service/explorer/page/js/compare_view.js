// Another orientation, or another library, beside the present one: its choice, and the snaps of both in a table.

import { wireTilt } from "./controls.js";
import { byId, html } from "./html.js";
import { angle, angleNumber, wrapAngle, length } from "./units.js";

const HEAD = ["", "falls from", "to", "by", "largest jump", "steepest 3 deg"];

/** Lets the controls choose what is shown beside; `gridOf` returns the grid of the library that is shown. */
export function wireComparison(view, gridOf) {
  byId("compare").addEventListener("click", () => {
    const { library, roll, pitch, beside_library: chosen } = view.value;
    if (chosen === null) view.set({ beside_library: library, beside_roll: roll, beside_pitch: pitch });
    else view.set({ beside_library: null, beside_roll: null, beside_pitch: null });
  });
  const library = byId("beside-library");
  library.addEventListener("change", () => view.set({ beside_library: Number(library.value) }));
  for (const name of ["roll", "pitch"]) wireTilt(view, gridOf, `beside_${name}`, byId(`beside-${name}`));
}

/** Shows in the controls what a view compares with. */
export function showComparison({ beside_library: library, beside_roll: roll, beside_pitch: pitch }) {
  const compares = library !== null;
  byId("compare").setAttribute("aria-pressed", compares);
  byId("compare").setAttribute("aria-expanded", compares);
  byId("beside").hidden = !compares;
  if (!compares) return;
  byId("beside-library").value = library;
  byId("beside-roll").value = roll;
  byId("beside-pitch").value = pitch;
}

/** What is shown beside, short; the thread is named where it is another library. */
export function besideText(beside, library) {
  const place = placeText(beside);
  return beside.library.id === library.id ? place : `${place} of ${beside.library.designation}`;
}

/** Fills the frame with the snaps of the present orientation and of the one beside. */
export function showSnaps(frame, here, beside, unit) {
  const rows = [here, beside].map(({ text, history }) => html("tr", {}, [html("th", { scope: "row" }, text), ...cells(history, unit)]));
  const head = html("tr", {}, HEAD.map((text) => html("th", { scope: "col" }, text)));
  frame.replaceChildren(html("table", { class: "snaps" }, [html("caption", { class: "visually-hidden" }, "The snaps of both"), html("thead", {}, head), html("tbody", {}, rows)]));
}

/** An orientation in few words. */
export function placeText({ roll, pitch }) {
  return `roll ${angleNumber(roll)}, pitch ${angle(pitch)}`;
}

function cells(history, unit) {
  const snap = history?.snap;
  if (!snap) {
    const steepest = typeof history?.steepest === "number" ? length(history.steepest, unit) : "not known";
    return [html("td", { colspan: 4 }, "no snap"), html("td", {}, steepest)];
  }
  const jump = snap.jump > 0 ? `${length(snap.jump, unit)} at ${angle(wrapAngle(snap.jump_at), 3)}` : "none";
  const texts = [angle(wrapAngle(snap.from), 3), angle(wrapAngle(snap.to), 3), length(snap.fall, unit), jump, length(snap.steepest, unit)];
  return texts.map((text) => html("td", {}, text));
}
