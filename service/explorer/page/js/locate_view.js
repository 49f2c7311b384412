// Where a state with what was observed can be: the form that says what, and the orientations that remain.

import { byId, html } from "./html.js";
import { MOST_CONTACTS, nothingObserved, observationOf, observationText, remaining } from "./observation.js";
import { CLASSES, FEATURES, FLAGS, REGIONS } from "./terms.js";
import { angleNumber, wrapAngle, percent } from "./units.js";

const MOST_SHOWN = 24;
/** The ends of shorter stretches of phase are shown with more decimals. */
const SHORT_STRETCH = 0.2;
const CONTACTS = ["a contact", "another", "a third"];
const ANY = ["", "any"];
const named = (names) => [ANY, ...Object.entries(names)];
const CLASS_NAMES = Object.fromEntries(Object.entries(CLASSES).map(([key, { short }]) => [key, short]));
const FLAG_NAMES = Object.fromEntries(Object.entries(FLAGS).map(([key, text]) => [key, text.split(":")[0]]));
const without = (left) => Object.fromEntries(Object.entries(REGIONS).filter(([region]) => region !== left));
const PARTS = [
  ["stage", "stage", [ANY, ["1", "1"], ["2", "2"], ["3", "3"]]],
  ["bolt", "bolt", named(without("surface"))],
  ["nut", "nut", named(without("base"))],
  ["features", "features", [ANY, ...FEATURES.map((name) => [name, name])]],
];

/** The form and the answer; `observe` is called with an observation's query, `goTo` with a pose. */
export class LocateView {
  #goTo;

  constructor(observe, goTo) {
    this.#goTo = goTo;
    const form = byId("locate-form");
    form.append(
      html("div", { class: "fields" }, [
        field("class", "class", named(CLASS_NAMES)),
        field("flag", "flag", named(FLAG_NAMES)),
        field("contacts", "contacts", [ANY, ...["1", "2", "3", "4", "5", "6"].map((count) => [count, count])]),
      ]),
      ...Array.from({ length: MOST_CONTACTS }, (_, k) =>
        html("fieldset", { class: "fields" }, [html("legend", {}, CONTACTS[k]), ...PARTS.map(([part, text, options]) => field(`${part}-${k}`, text, options))]),
      ),
      html("div", { class: "choices" }, [
        html("label", {}, [html("input", { type: "checkbox", name: "ordered" }), " these are the first contacts, in their order"]),
        html("button", { type: "reset" }, "nothing observed"),
      ]),
    );
    form.addEventListener("submit", (event) => event.preventDefault());
    form.addEventListener("change", () => observe(observationText(this.#read())));
    form.addEventListener("reset", () => observe(observationText(nothingObserved())));
  }

  /** Shows an observation in the form. */
  show(text) {
    if (observationText(this.#read()) === text) return;
    const observation = observationOf(text);
    const { elements } = byId("locate-form");
    for (const name of ["class", "flag", "contacts"]) elements[name].value = observation[name];
    for (let k = 0; k < MOST_CONTACTS; k++) {
      for (const [part] of PARTS) elements[`${part}-${k}`].value = observation.contact[k]?.[part] ?? "";
    }
    elements.ordered.checked = observation.ordered;
  }

  /** Marks the orientation of a view in the list. */
  mark({ roll, pitch }) {
    for (const button of byId("located").querySelectorAll("button")) {
      button.setAttribute("aria-pressed", button.dataset.place === `${roll} ${pitch}`);
    }
  }

  /** Lists what remains (null: nothing was observed). */
  list(located) {
    const frame = byId("located");
    if (located === null) {
      frame.replaceChildren(html("p", { class: "readout" }, "Choose what was observed of a state; the orientations at which it can be are marked on the map and listed here."));
      return;
    }
    if (located.missing) {
      frame.replaceChildren(html("p", { class: "readout" }, "Nothing can be located: the library was computed by meshes and has no histories."));
      return;
    }
    const found = remaining(located.stretches);
    const rows = found.slice(0, MOST_SHOWN).map((one) => this.#row(one));
    const rest = found.slice(MOST_SHOWN);
    frame.replaceChildren(
      html("p", { class: "readout", role: "status" }, summaryText(located, found)),
      ...(rows.length > 0 ? [html("table", {}, [html("thead", {}, html("tr", {}, ["orientation", "share", "phases"].map((text) => html("th", { scope: "col" }, text)))), html("tbody", {}, rows)])] : []),
      ...(rest.length > 0 ? [html("p", { class: "readout" }, `and ${rest.length} more, ${percent(rest.reduce((sum, { share }) => sum + share, 0))} together`)] : []),
    );
  }

  #row({ roll, pitch, share, stretches, phase }) {
    const go = html("button", { type: "button", "data-place": `${roll} ${pitch}` }, `${angleNumber(roll)} / ${angleNumber(pitch)}`);
    go.setAttribute("aria-label", `go to roll ${roll}, pitch ${pitch}`);
    go.addEventListener("click", () => this.#goTo({ roll, pitch, phase }));
    return html("tr", {}, [html("td", {}, go), html("td", {}, percent(share)), html("td", {}, stretchesText(stretches))]);
  }

  #read() {
    const { elements } = byId("locate-form");
    const contact = Array.from({ length: MOST_CONTACTS }, (_, k) => Object.fromEntries(PARTS.map(([part]) => [part, elements[`${part}-${k}`].value])));
    return { class: elements.class.value, flag: elements.flag.value, contacts: elements.contacts.value, contact, ordered: elements.ordered.checked };
  }
}

function field(name, text, options) {
  return html("label", {}, [`${text} `, html("select", { name }, options.map(([value, shown]) => html("option", { value }, shown)))]);
}

/** What remains in one sentence; the shares of the list are of that. */
export function summaryText({ share, undecided_share: undecided, orientations }, found) {
  if (found.length === 0) return "Nothing in this library is like that.";
  const where = orientations === 1 ? "1 orientation" : `${orientations} orientations`;
  const doubt = undecided > 0 ? `, ${percent(undecided)} of them undecided, so that nothing excludes them` : "";
  return `${percent(share)} of all poses remain, at ${where}${doubt}. The shares below are of what remains.`;
}

function stretchesText(stretches) {
  const shown = stretches.slice(0, 3).map(({ start, end }) => {
    const decimals = end - start < SHORT_STRETCH ? 4 : 1;
    return `${angleNumber(wrapAngle(start), decimals)}–${angleNumber(wrapAngle(end), decimals)}`;
  });
  const more = stretches.length > 3 ? ` and ${stretches.length - 3} more` : "";
  return `${shown.join(", ")}${more} deg`;
}
