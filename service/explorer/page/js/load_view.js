// A load on the bolt: its sliders, what it does to the state, and the jamming diagram.

import { byId, html } from "./html.js";
import { jammingPicture, jammingText } from "./jamming_view.js";
import { LOAD_FIELDS, PARTS, PLANES, verdictText } from "./load.js";
import { showToast } from "./messages.js";
import { TERMS } from "./terms.js";
import { fixed } from "./units.js";
import { LOAD_LIMITS, DEFAULTS } from "./view.js";

const SLIDERS = { mu: [0, 1, 0.005], ...Object.fromEntries(Object.keys(PARTS).map((name) => [name, [-1, 1, 0.01]])) };
const MOST_FORCES = 8;
const DECIMALS = 4;

/** The panel of the load; `change` is called with parts of the view. */
export class LoadView {
  constructor(change) {
    const row = (name, text, help) => {
      const [low, high] = LOAD_LIMITS[name];
      const field = html("input", { type: "number", id: `load-${name}`, min: low, max: high, step: "any", inputmode: "decimal" });
      field.addEventListener("change", () => this.#take(name, field, change));
      const cells = [html("label", { for: `load-${name}`, "data-help": help }, text)];
      if (SLIDERS[name]) {
        const [least, most, step] = SLIDERS[name];
        const slider = html("input", { type: "range", id: `slider-${name}`, min: least, max: most, step, "aria-label": text });
        slider.addEventListener("input", () => change({ [name]: Number(slider.value) }));
        cells.push(slider);
      }
      return [...cells, field];
    };
    byId("load-fields").replaceChildren(
      ...row("mu", "friction μ", "Coefficient of friction of all contacts."),
      ...Object.entries(PARTS).flatMap(([name, { name: text, help }]) => row(name, text, `The load's ${help}.`)),
      ...row("push", "push (N)", "Force on the bolt along -z, in N."),
    );
    byId("load-reset").addEventListener("click", () => change(Object.fromEntries(LOAD_FIELDS.map((name) => [name, DEFAULTS[name]]))));
    byId("plane").replaceChildren(...Object.entries(PLANES).map(([value, text]) => html("option", { value }, text)));
    byId("plane").addEventListener("change", () => change({ plane: byId("plane").value }));
  }

  /** Shows the load of a view in the controls. */
  show(view) {
    for (const name of LOAD_FIELDS) {
      if (document.activeElement !== byId(`load-${name}`)) byId(`load-${name}`).value = String(view[name]);
      if (SLIDERS[name]) byId(`slider-${name}`).value = view[name];
    }
    byId("plane").value = view.plane;
  }

  /** Shows what the load does: {statics} or {problem}; null: not known yet. */
  showStatics(found, unit) {
    if (found === null) return;
    byId("load-verdict").textContent = found.problem ?? verdictText(found.statics);
    byId("load-verdict").dataset.verdict = found.statics?.verdict ?? "undecided";
    byId("load-numbers").replaceChildren(...(found.statics ? [numbers(found.statics), forces(found.statics, unit)] : []));
  }

  /** Draws a diagram: {diagram} or {problem}; null: not known yet. */
  showJamming(found) {
    if (found === null) return;
    byId("jamming-text").textContent = found.problem ?? jammingText(found.diagram);
    if (found.problem) {
      byId("jamming").replaceChildren();
      byId("jamming-legend").replaceChildren();
      return;
    }
    const { root, rows, more } = jammingPicture(found.diagram);
    byId("jamming").replaceChildren(root);
    byId("jamming-legend").replaceChildren(
      html("li", { class: "load" }, "this load"),
      ...rows.map(([letter, colour, text]) => html("li", { class: colour }, `${letter}: ${text}`)),
      ...(more > 0 ? [html("li", {}, `and ${more} shorter pieces`)] : []),
    );
  }

  #take(name, field, change) {
    const [low, high] = LOAD_LIMITS[name];
    const value = Number(field.value);
    if (field.value !== "" && value >= low && value <= high) {
      change({ [name]: value + 0 });
      return;
    }
    showToast(`${field.labels[0].textContent} is ${field.value || "no number"}; valid: ${low} to ${high}`);
    field.value = DEFAULTS[name];
    change({ [name]: DEFAULTS[name] });
  }
}

function numbers(statics) {
  const friction = (value) => (value === null ? "none known" : fixed(value, DECIMALS));
  const effort = (value) => (value === null ? "none turns it" : fixed(value, DECIMALS));
  const rows = [
    ["held from friction", friction(statics.mu_hold)],
    ["can wedge from friction", friction(statics.mu_wedge)],
    ["support margin", fixed(statics.support_margin, DECIMALS)],
    ["torque that turns it ccw", effort(statics.turn_effort_ccw)],
    ["torque that turns it cw", effort(statics.turn_effort_cw)],
  ];
  return html("table", {}, [
    html("caption", {}, "numbers of the loaded state"),
    html("tbody", {}, rows.map(([name, value]) => html("tr", {}, [html("th", { scope: "row" }, html("button", { type: "button", class: "term", "data-help": TERMS[name] }, name)), html("td", {}, value)]))),
  ]);
}

function forces(statics) {
  if (statics.forces.length === 0) return html("p", { class: "soft" }, "No forces balance the load at this friction.");
  const loaded = statics.forces.filter(({ normal }) => normal > 0);
  const shown = loaded.slice(0, MOST_FORCES);
  const rows = shown.map(({ contact, normal, tangential }) => {
    const across = Math.hypot(...tangential);
    return [`${contact}`, fixed(normal, DECIMALS), fixed(across, DECIMALS), normal > 0 ? fixed(across / normal, 3) : ""];
  });
  const head = ["contact", "normal (N)", "friction (N)", "of the normal"];
  return html("table", { class: "forces" }, [
    html("caption", {}, shown.length < loaded.length ? `balancing forces, ${shown.length} of ${loaded.length}` : "balancing forces"),
    html("thead", {}, html("tr", {}, head.map((text) => html("th", { scope: "col" }, text)))),
    html("tbody", {}, rows.map((cells) => html("tr", {}, cells.map((text) => html("td", {}, text))))),
  ]);
}
