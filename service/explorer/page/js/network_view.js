// All formations of the network: where one is, what may come next, and the way to the window.

import { CLASS_COLOURS, UNDECIDED_COLOUR } from "./colours.js";
import { bandsOf, formationsAlong } from "./overview.js";
import { picture, replaceContent, svg } from "./svg.js";
import { CLASSES } from "./terms.js";
import { percent } from "./units.js";

const WIDTH = 396;
const LEFT = 72;
const TOP = 32;
const STEP = 12;
const MOST = Math.floor((WIDTH - LEFT) / STEP);
const APART = 2.4;
/** Sides of squares: the rarest formation's and the commonest's. */
const [LEAST_SIDE, MOST_SIDE] = [6, 11.2];
const LEGEND_HEIGHT = 36;
const PLACES = [14, 92, 194];

/** The picture in a frame; `choose` is called with the key of a formation, `showText` with a line about one. */
export class NetworkView {
  #frame;
  #choose;
  #showText;
  #places = new Map();
  #marks = null;
  #here = null;
  /** The square that Tab leads to. */
  #stop = null;

  constructor(frame, choose, showText) {
    this.#frame = frame;
    this.#choose = choose;
    this.#showText = showText;
  }

  /** Draws all formations. */
  draw(formations) {
    const bands = bandsOf(formations, MOST);
    const lines = bands.reduce((sum, band) => sum + band.lines.length, 0);
    const height = TOP + lines * STEP + bands.length * APART + LEGEND_HEIGHT + 6;
    const root = picture(WIDTH, height, "All formations of the network", { class: "network", role: "group" });
    const squares = svg("g", { role: "listbox", "aria-label": "formations by the turning to the window" });
    const greatest = Math.max(...formations.map(({ share }) => share));
    this.#places = new Map();
    let y = TOP;
    for (const { title, lines: rows } of bands) {
      root.append(svg("text", { x: LEFT - 8, y: y + STEP - 2, "text-anchor": "end", class: "title" }, title));
      rows.forEach((row) => {
        row.forEach((formation, k) => squares.append(this.#square(formation, LEFT + (k + 0.5) * STEP, y + STEP / 2, greatest)));
        y += STEP;
      });
      y += APART;
    }
    this.#marks = { links: svg("g", { class: "links" }), way: svg("g", { class: "way" }) };
    root.prepend(this.#marks.links);
    root.append(squares, this.#marks.way, ...heading(), ...legend(height - LEGEND_HEIGHT + 8));
    squares.addEventListener("keydown", (event) => this.#step(event));
    replaceContent(this.#frame, root);
  }

  /**
   * Marks the formation of a node, what follows it, and the path from it; null where the pose has none. The focus goes
   * along, unless keys have led it away from what was marked before.
   */
  mark(node, path) {
    if (this.#marks === null) return;
    const focused = this.#frame.contains(document.activeElement);
    const ledAway = focused && document.activeElement !== this.#here?.element;
    this.#here?.element.setAttribute("aria-selected", false);
    this.#here = this.#places.get(node?.formation.key) ?? this.#places.values().next().value ?? null;
    if (!ledAway) this.#stopAt(this.#here?.element ?? null);
    replaceContent(this.#marks.links);
    replaceContent(this.#marks.way);
    if (node === null || this.#here === null) return;
    this.#here.element.setAttribute("aria-selected", true);
    replaceContent(this.#marks.links, ...this.#links(node));
    replaceContent(this.#marks.way, ...this.#way(path));
    if (focused && !ledAway) this.#here.element.focus();
    this.#showText(this.#here.formation.text);
  }

  /** Shows a text in place of the network. */
  showEmpty(text) {
    this.#marks = null;
    replaceContent(this.#frame);
    this.#showText(text);
  }

  #square(formation, x, y, greatest) {
    const { key: name, class: stateClass, share, text, orientations } = formation;
    const side = LEAST_SIDE + (MOST_SIDE - LEAST_SIDE) * Math.cbrt(share / greatest);
    const label = `${text}; ${percent(share)} of all poses, at ${orientations} orientation${orientations === 1 ? "" : "s"}`;
    const element = svg("g", { role: "option", class: "formation", tabindex: -1, "aria-selected": false, "aria-label": label, "data-key": name });
    element.append(
      svg("rect", { x: x - STEP / 2, y: y - STEP / 2, width: STEP, height: STEP, class: "reach", fill: "transparent" }),
      svg("rect", { x: x - side / 2, y: y - side / 2, width: side, height: side, rx: 1.5, fill: CLASS_COLOURS[stateClass] ?? UNDECIDED_COLOUR }),
    );
    element.addEventListener("click", () => this.#choose(name));
    element.addEventListener("pointerenter", () => this.#showText(label));
    element.addEventListener("focus", () => this.#showText(label));
    this.#places.set(name, { x, y, element, formation });
    return element;
  }

  #links({ following }) {
    const from = this.#here;
    return following
      .filter(({ formation }) => this.#places.has(formation))
      .map(({ formation, move, share }) => {
        const to = this.#places.get(formation);
        const kind = move === "ccw" ? "ccw" : move === "cw" ? "cw" : "tilt";
        return svg("line", { x1: from.x, y1: from.y, x2: to.x, y2: to.y, class: kind, "stroke-width": (0.6 + 2.4 * share).toFixed(2) });
      });
  }

  #way(path) {
    const places = formationsAlong(path).map((name) => this.#places.get(name)).filter(Boolean);
    const points = places.map(({ x, y }) => `${x} ${y}`);
    const line = points.length > 1 ? [svg("path", { d: `M${points.join("L")}`, class: "outline" }), svg("path", { d: `M${points.join("L")}`, class: "line" })] : [];
    const { x, y } = this.#here;
    const stops = places.slice(1).map((stop) => svg("circle", { cx: stop.x, cy: stop.y, r: 2.6, class: "stop" }));
    return [...line, ...stops, svg("circle", { cx: x, cy: y, r: 9, class: "ring-out" }), svg("circle", { cx: x, cy: y, r: 9, class: "ring-in" })];
  }

  #step(event) {
    const focused = document.activeElement?.dataset.key;
    const at = this.#places.get(focused);
    if (at === undefined) return;
    if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      this.#choose(focused);
      return;
    }
    const next = nearest([...this.#places.values()], at, event.key);
    if (next === null) return;
    event.preventDefault();
    this.#stopAt(next.element);
    next.element.focus();
  }

  #stopAt(element) {
    this.#stop?.setAttribute("tabindex", -1);
    element?.setAttribute("tabindex", 0);
    this.#stop = element;
  }
}

/** The place that an arrow leads to: the next in its row, or the nearest in the row above or below; else null. */
function nearest(places, { x, y }, arrow) {
  const [right, down] = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1] }[arrow] ?? [0, 0];
  const ahead = places.filter((one) => (one.x - x) * right + (one.y - y) * down > 1 && (down !== 0 || Math.abs(one.y - y) < 1));
  const far = (one) => Math.abs(one.y - y) * 100 + Math.abs(one.x - x);
  return ahead.length === 0 ? null : ahead.reduce((a, b) => (far(b) < far(a) ? b : a));
}

function heading() {
  return [
    svg("text", { x: 0, y: 11, class: "title" }, "turning to"),
    svg("text", { x: 0, y: 24, class: "title" }, "window (deg)"),
    ...Object.entries(CLASSES).flatMap(([name, { short }], k) => [
      svg("rect", { x: LEFT + 2 + PLACES[k], y: 7, width: 12, height: 12, rx: 1.5, fill: CLASS_COLOURS[name] }),
      svg("text", { x: LEFT + 19 + PLACES[k], y: 17 }, short),
    ]),
  ];
}

function legend(y) {
  const entry = (x, at, name, text) => [
    svg("line", { x1: x, x2: x + 22, y1: at, y2: at, class: name, "stroke-width": 2 }),
    svg("text", { x: x + 27, y: at + 4 }, text),
  ];
  return [
    svg("g", { class: "way" }, [svg("path", { d: `M${LEFT} ${y}h22`, class: "line" }), svg("text", { x: LEFT + 27, y: y + 4 }, "way from here")]),
    svg("g", { class: "links" }, [...entry(LEFT + 150, y, "ccw", "turning on"), ...entry(LEFT, y + 17, "cw", "turning back"), ...entry(LEFT + 150, y + 17, "tilt", "tilting")]),
  ];
}
