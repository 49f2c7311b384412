// Measured poses: pasted or opened from a file, listed with the state of each.

import { firstHeight } from "./curve.js";
import { byId, html } from "./html.js";
import { showToast } from "./messages.js";
import { posesOf, posesText } from "./poses.js";
import { restHeight } from "./resting.js";
import { CLASSES } from "./terms.js";
import { angleNumber, length } from "./units.js";

const MOST_FAULTS = 4;
const LARGEST_FILE = 1_000_000;

/** Lets the panel take poses; `take` is called with their text, `goTo` with a pose. */
export class PosesView {
  #take;
  #goTo;

  constructor(take, goTo) {
    this.#take = take;
    this.#goTo = goTo;
    byId("poses-take").addEventListener("click", () => this.#read(byId("poses-text").value));
    byId("poses-clear").addEventListener("click", () => {
      byId("poses-text").value = "";
      this.#showFaults([]);
      take("");
    });
    byId("poses-file").addEventListener("change", async () => {
      const [file] = byId("poses-file").files;
      if (!file) return;
      if (file.size > LARGEST_FILE) {
        showToast(`${file.name} is too large for a table of poses; valid: up to 1 MB`);
        return;
      }
      byId("poses-text").value = await file.text();
      byId("poses-file").value = "";
      this.#read(byId("poses-text").value);
    });
  }

  /** Marks the pose of a view in the list. */
  mark({ roll, pitch, phase }) {
    for (const button of byId("poses-list").querySelectorAll("button")) {
      button.setAttribute("aria-pressed", button.dataset.place === `${roll} ${pitch} ${phase}`);
    }
  }

  /** Lists poses with their states (null: not known yet). */
  list(measured, unit) {
    byId("poses-clear").disabled = !measured || measured.length === 0;
    if (!measured || measured.length === 0) {
      byId("poses-list").replaceChildren();
      return;
    }
    const head = ["pose", "roll", "pitch", "phase", "class", "first contact at", "at rest at"];
    byId("poses-list").replaceChildren(
      html("table", {}, [
        html("caption", {}, measured.length === 1 ? "1 pose" : `${measured.length} poses`),
        html("thead", {}, html("tr", {}, head.map((text) => html("th", { scope: "col" }, text)))),
        html("tbody", {}, measured.map((one, k) => this.#row(one, k, unit))),
      ]),
    );
  }

  #row({ pose, state }, k, unit) {
    const place = `${pose.roll} ${pose.pitch} ${pose.phase}`;
    const go = html("button", { type: "button", "data-place": place, "aria-label": `go to pose ${k + 1}` }, `${k + 1}`);
    go.addEventListener("click", () => this.#goTo(pose));
    const rest = state && restHeight(state);
    const cells = [
      ...[pose.roll, pose.pitch, pose.phase].map((one) => angleNumber(one)),
      state ? CLASSES[state.class].short : "undecided",
      state ? length(firstHeight(state), unit) : "",
      state ? (rest === null ? "does not rest" : length(rest, unit)) : "",
    ];
    return html("tr", {}, [html("td", {}, go), ...cells.map((text) => html("td", {}, text))]);
  }

  #read(text) {
    const { poses, faults } = posesOf(text);
    this.#showFaults(poses.length === 0 && faults.length === 0 ? ["There is no pose; a line has roll, pitch and phase in deg."] : faults);
    if (poses.length > 0) this.#take(posesText(poses));
  }

  #showFaults(faults) {
    const more = faults.length > MOST_FAULTS ? [`and ${faults.length - MOST_FAULTS} more`] : [];
    byId("poses-faults").replaceChildren(...[...faults.slice(0, MOST_FAULTS), ...more].map((fault) => html("li", {}, fault)));
  }
}
