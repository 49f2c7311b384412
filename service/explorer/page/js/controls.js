// The controls of the page: each sets a part of the view and shows it.

import { steppedPhase, tilts } from "./grid.js";
import { byId, html } from "./html.js";
import { QUANTITIES } from "./quantities.js";
import { angleNumber, inTurn } from "./units.js";

const CHOICES = ["unit", "theme", "quantity", "over", "nut"];
const ELEMENTS = { nut: "nut-look" };

/** Fills the controls for a library's grid and lets them set the view. */
export function wireControls(view, grid) {
  for (const name of ["roll", "pitch"]) {
    byId(name).replaceChildren(...tilts(grid).map((tilt) => html("option", { value: tilt }, angleNumber(tilt))));
    byId(name).addEventListener("change", () => view.set({ [name]: Number(byId(name).value) }));
  }
  byId("quantity").replaceChildren(...Object.entries(QUANTITIES).map(([value, { name }]) => html("option", { value }, name)));
  for (const name of CHOICES) {
    const control = byId(ELEMENTS[name] ?? name);
    control.addEventListener("change", () => view.set({ [name]: control.value }));
  }
  wirePhase(view, grid);
  byId("stage").addEventListener("input", () => view.set({ stage: Number(byId("stage").value) }));
}

function wirePhase(view, grid) {
  const slider = byId("phase-slider");
  slider.step = grid.phase_step;
  slider.max = 360 - grid.phase_step;
  slider.addEventListener("input", () => view.set({ phase: Number(slider.value) }));
  const number = byId("phase");
  number.addEventListener("change", () => {
    if (number.value !== "" && number.checkValidity()) view.set({ phase: inTurn(Number(number.value)) });
  });
  byId("phase-back").addEventListener("click", () => view.set({ phase: steppedPhase(grid, view.value.phase, -1) }));
  byId("phase-on").addEventListener("click", () => view.set({ phase: steppedPhase(grid, view.value.phase, 1) }));
}

/** Shows a view in the controls. */
export function showControls(now) {
  byId("roll").value = now.roll;
  byId("pitch").value = now.pitch;
  byId("phase").value = String(now.phase);
  byId("phase-slider").value = now.phase;
  byId("stage").value = now.stage;
  for (const name of CHOICES) byId(ELEMENTS[name] ?? name).value = now[name];
  byId("over").disabled = !QUANTITIES[now.quantity].ofState;
  document.documentElement.dataset.theme = now.theme;
}
