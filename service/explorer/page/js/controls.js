// The controls of the page: each sets a part of the view and shows it.

import { TILT_LIMIT, TOLERANCE_LIMIT, gridText, steppedPhase, steppedTilt } from "./grid.js";
import { byId, html } from "./html.js";
import { showToast } from "./messages.js";
import { QUANTITIES } from "./quantities.js";
import { storePreferredUnit } from "./preferences.js";
import { turned } from "./url_state.js";
import { wrapAngle } from "./units.js";

const CHOICES = ["unit", "theme", "quantity", "over", "nut"];
const ELEMENTS = { nut: "nut-look" };
const TILTS = ["roll", "pitch"];

/** Lets the controls set the view; `gridOf` returns the grid of the library that is shown. */
export function wireControls(view, gridOf) {
  for (const name of TILTS) wireTilt(view, gridOf, name, byId(name), [byId(`${name}-less`), byId(`${name}-more`)]);
  byId("quantity").replaceChildren(...Object.entries(QUANTITIES).map(([value, { name }]) => html("option", { value }, name)));
  for (const name of CHOICES) {
    const control = byId(ELEMENTS[name] ?? name);
    control.addEventListener("change", () => view.set({ [name]: control.value }));
  }
  byId("unit").addEventListener("change", () => storePreferredUnit(byId("unit").value));
  byId("library").addEventListener("change", () => view.set({ library: Number(byId("library").value) }));
  wirePhase(view, gridOf);
  wireTolerance(view);
  byId("stage").addEventListener("input", () => view.set({ stage: Number(byId("stage").value) }));
}

/** Lets a field of roll or pitch set the part `name` of the view: any angle, by arrows and `steppers` that of the grid. */
export function wireTilt(view, gridOf, name, field, steppers = []) {
  const step = (sense) => view.set({ [name]: steppedTilt(gridOf(), view.value[name], sense) });
  field.min = -TILT_LIMIT;
  field.max = TILT_LIMIT;
  field.addEventListener("change", () => {
    const value = Number(field.value) + 0;
    if (field.value !== "" && Math.abs(value) <= TILT_LIMIT) {
      view.set({ [name]: value });
      return;
    }
    showToast(`${field.dataset.name} is ${field.value || "no number"}; valid: ${-TILT_LIMIT} to ${TILT_LIMIT} deg`);
    field.value = view.value[name];
  });
  field.addEventListener("keydown", (event) => {
    const sense = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (sense === undefined) return;
    event.preventDefault();
    step(sense);
  });
  steppers.forEach((button, k) => button.addEventListener("click", () => step(k === 0 ? -1 : 1)));
}

function wirePhase(view, gridOf) {
  const slider = byId("phase-slider");
  slider.addEventListener("input", () => view.set({ phase: Number(slider.value) }));
  const number = byId("phase");
  number.addEventListener("change", () => {
    const given = Number(number.value);
    if (number.value === "" || !Number.isFinite(given)) {
      showToast("phase is no number; valid: an angle in deg");
      number.value = view.value.phase;
      return;
    }
    const phase = wrapAngle(given);
    if (phase !== given) showToast(turned(given, phase));
    view.set({ phase });
    number.value = phase;
  });
  const step = (sense) => view.set({ phase: steppedPhase(gridOf(), view.value.phase, sense) });
  number.addEventListener("keydown", (event) => {
    const sense = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (sense === undefined) return;
    event.preventDefault();
    step(sense);
  });
  byId("phase-back").addEventListener("click", () => step(-1));
  byId("phase-on").addEventListener("click", () => step(1));
}

function wireTolerance(view) {
  const field = byId("tolerance");
  field.max = TOLERANCE_LIMIT;
  field.addEventListener("change", () => {
    const value = Number(field.value);
    if (field.value === "" && field.validity.valid) {
      view.set({ tolerance: null });
      return;
    }
    if (field.validity.valid && value > 0 && value <= TOLERANCE_LIMIT) {
      view.set({ tolerance: value });
      return;
    }
    showToast(`the tolerance is ${field.value || "no number"}; valid: above 0 to ${TOLERANCE_LIMIT} deg, or nothing`);
    field.value = view.value.tolerance ?? "";
  });
}

/** Fits the controls to the grid of a library. */
export function fitControls(grid) {
  const slider = byId("phase-slider");
  slider.step = grid.phase_step;
  slider.max = 360 - grid.phase_step;
}

/** Shows the libraries that can be chosen, and which of them `latest` means. */
export function showLibraries({ all, latest }, present) {
  const texts = new Map(all.map((one) => [one.id, libraryText(one, one.id === latest)]));
  if (!texts.has(present.id)) texts.set(present.id, libraryText(present, false));
  for (const id of ["library", "beside-library"]) {
    const chosen = byId(id).value;
    byId(id).replaceChildren(...[...texts].map(([value, text]) => html("option", { value }, text)));
    if (chosen !== "") byId(id).value = chosen;
  }
}

/** A library in one line: number, thread, grid and method. */
export function libraryText({ id, designation, grid, method }, isLatest) {
  return `${id}${isLatest ? " (latest)" : ""}: ${designation}, ${gridText(grid)}, ${method}`;
}

/** Shows a view in the controls. */
export function showControls(now) {
  for (const name of [...TILTS, "phase"]) byId(name).value = String(now[name]);
  byId("tolerance").value = now.tolerance ?? "";
  byId("library").value = now.library;
  byId("phase-slider").value = now.phase;
  byId("stage").value = now.stage;
  for (const name of CHOICES) byId(ELEMENTS[name] ?? name).value = now[name];
  byId("over").disabled = !QUANTITIES[now.quantity].ofState;
  document.documentElement.dataset.theme = now.theme;
}
