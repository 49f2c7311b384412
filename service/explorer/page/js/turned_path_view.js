// The path of a held bolt below the solids: what plays it, the slider over its points, and its curves.

import { byId } from "./html.js";
import { prefersReducedMotion } from "./player.js";
import { followSize } from "./size.js";
import { curvesOf, playTimes, pointAtTime, pointText, pointsOfEvents } from "./turned_path.js";
import { TurnedPathChart } from "./turned_path_chart.js";

const PLAYS = "path";

/** The panel; `choose` is called with a point, `player` plays. */
export class TurnedPathView {
  #choose;
  #player;
  #chart;
  #answer = null;
  #at = 0;
  #redraw = () => {};

  constructor(choose, player) {
    this.#choose = choose;
    this.#player = player;
    this.#chart = new TurnedPathChart(byId("turned-chart"), (at) => this.#stopAt(at));
    byId("turned-point").addEventListener("input", () => this.#stopAt(Number(byId("turned-point").value)));
    byId("turned-back").addEventListener("click", () => this.#stopAt(this.#at - 1));
    byId("turned-on").addEventListener("click", () => this.#stopAt(this.#at + 1));
    byId("turned-play").addEventListener("click", () => (player.playing === PLAYS ? player.stop() : this.play()));
    followSize([byId("turned-chart")], () => this.#redraw());
  }

  /** Shows an answer in a unit, with the lead of a pair in that unit; null: none. */
  show(answer, pair, unit) {
    if (answer !== this.#answer && this.#player.playing === PLAYS) this.#player.stop();
    this.#answer = answer;
    if (answer === null) {
      this.#redraw = () => {};
      this.#chart.clear();
      return;
    }
    byId("turned-point").max = answer.path.phase.length - 1;
    const curves = curvesOf(answer, unit);
    this.#redraw = () => this.#chart.draw(answer, curves, pair, unit);
    this.#redraw();
  }

  /** Moves everything to a point; nothing while the lead in a new unit has not arrived. */
  moveTo(at) {
    if (this.#answer === null) return;
    this.#at = at;
    const text = pointText(this.#answer.path, at);
    byId("turned-point").value = at;
    byId("turned-point").setAttribute("aria-valuetext", text);
    byId("turned-readout").textContent = text;
    byId("turned-back").disabled = at === 0;
    byId("turned-on").disabled = at === this.#answer.path.phase.length - 1;
    this.#chart.moveCursor(at);
  }

  #stopAt(at) {
    if (this.#player.playing === PLAYS) this.#player.stop();
    this.#choose(at);
  }

  /** Plays from the point that is shown, or from the start where that is the last one. */
  play() {
    const { path, events } = this.#answer;
    const times = playTimes(path, events, pointsOfEvents(path, events));
    const last = times.length - 1;
    const begun = times[this.#at === last ? 0 : this.#at];
    this.#player.play(PLAYS, (seconds) => {
      const at = pointAtTime(times, begun + (prefersReducedMotion() ? Math.floor(seconds) : seconds));
      this.#choose(at);
      return at < last;
    });
  }
}
