// The threads of all libraries side by side, and the section of the present one beside any other.

import { byId, html } from "./html.js";
import { CLASSES } from "./terms.js";
import { angleNumber, fixed, percent } from "./units.js";
import { THREAD_LENGTH } from "./view.js";

/** Rows of the table: what each is, and its text for a library. */
const FIGURES = [
  ["axial play", ({ axial_play: play }) => pitches(play)],
  ["window", ({ window }) => spread(window, (value) => angleNumber(value, 1), " deg")],
  ["steepest fall", ({ fall }) => spread(fall, (value) => fixed(100 * value, 1), " %")],
  ["snaps", ({ snaps, orientations }) => `${snaps} of ${orientations.length}`],
  ...Object.entries(CLASSES).map(([name, { short }]) => [`states ${short}`, ({ classes }) => percent(classes[name] ?? 0)]),
  ["states that hold at friction 0.2", ({ held }) => percent(held.find(({ mu }) => mu === HELD_AT)?.share ?? 0)],
  ["least friction that holds", ({ mu_hold_least: mu }) => spread(mu, (value) => fixed(value, 3), "")],
  ["least that wedges", ({ mu_wedge_least: mu }) => spread(mu, (value) => fixed(value, 3), "")],
  ["greatest embedment", ({ embedment_most: most }) => (most ? pitches(most.most) : "none")],
  ["undecided", ({ undecided, states }) => `${undecided} of ${states + undecided}`],
];
const HELD_AT = 0.2;

/** Lets the panel choose a library, and a thread whose section is shown too. */
export class ThreadsView {
  #chooseLibrary;

  constructor(chooseLibrary, chooseThread) {
    this.#chooseLibrary = chooseLibrary;
    byId("thread").maxLength = THREAD_LENGTH;
    byId("thread-form").addEventListener("submit", (event) => {
      event.preventDefault();
      chooseThread(byId("thread").value.trim());
    });
    byId("thread-clear").addEventListener("click", () => chooseThread(""));
  }

  /** Shows the thread of a view in its field. */
  show({ thread }) {
    byId("thread").value = thread;
    byId("thread-clear").disabled = thread === "";
  }

  /** Shows sections, and what is wrong with a designation where it has none; null: not known yet. */
  showProfiles(profiles) {
    byId("thread-problem").replaceChildren(...(profiles?.problem ? [html("li", {}, profiles.problem)] : []));
    byId("profiles").replaceChildren(
      ...(profiles?.pictures ?? []).map(({ name, svg }) =>
        html("img", { alt: `Section of bolt and nut of ${name}, with their play`, src: `data:image/svg+xml,${encodeURIComponent(svg)}` }),
      ),
    );
  }

  /** Lists libraries with the figures of all of their orientations; null: none has any. */
  list(comparison, present) {
    if (!comparison) {
      byId("compared").replaceChildren();
      return;
    }
    const { libraries } = comparison;
    const heads = [html("td", {}), ...libraries.map((one) => html("th", { scope: "col" }, this.#choice(one, one.library === present)))];
    const rows = FIGURES.map(([name, text]) =>
      html("tr", {}, [html("th", { scope: "row" }, name), ...libraries.map((one) => html("td", {}, text(one)))]),
    );
    byId("compared").replaceChildren(
      html("table", {}, [
        html("caption", {}, "Over all orientations: the median, and the range"),
        html("thead", {}, html("tr", {}, heads)),
        html("tbody", {}, rows),
      ]),
    );
  }

  #choice({ library, designation }, isPresent) {
    const choose = html("button", { type: "button", "aria-pressed": String(isPresent) }, `${library}: ${designation}`);
    choose.addEventListener("click", () => this.#chooseLibrary(library));
    return choose;
  }
}

function pitches(value) {
  return `${fixed(100 * value, 2)} % of the pitch`;
}

function spread(range, written, unit) {
  return range ? `${written(range.median)}${unit} (${written(range.least)} to ${written(range.most)})` : "none";
}
