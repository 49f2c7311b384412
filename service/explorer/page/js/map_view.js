// The map of orientations.

import { CLASS_COLOURS, inkOn, scaleColour } from "./colours.js";
import { tilts } from "./grid.js";
import { QUANTITIES, needsSummaries } from "./quantities.js";
import { sizeOf } from "./size.js";
import { picture, put, svg } from "./svg.js";
import { CLASSES, className } from "./terms.js";
import { angleNumber } from "./units.js";

const LEAST = { width: 300, height: 260 };
const LEFT = 46;
const RIGHT = 2;
const TOP = 4;
const BELOW = 62;
const LETTERS_FROM = 14;
const LEGEND_PLACES = [0, 72, 174];
const LEGEND_WIDTH = 246;
const NONE = "–";

/** The picture in a frame; `choose` is called with roll and pitch, `tell` with a line about a cell. */
export class MapView {
  #frame;
  #choose;
  #tell;

  constructor(frame, choose, tell) {
    this.#frame = frame;
    this.#choose = choose;
    this.#tell = tell;
  }

  /** Draws the map; a cell that had the focus has it again. */
  draw(model, view) {
    const values = mapValues(model, view);
    const angles = tilts(model.library.grid);
    const range = rangeOf(values);
    const focused = this.#frame.contains(document.activeElement);
    const { width, height } = sizeOf(this.#frame, LEAST);
    const root = picture(width, height, "Map of orientations", { class: "map", role: "group" });
    const plot = plotIn(width, height, angles.length);
    const side = plot.side / angles.length;
    const cells = svg("g", { role: "grid", "aria-label": "orientations by pitch and roll" });
    [...angles].reverse().forEach((pitch, row) => {
      const line = svg("g", { role: "row" });
      angles.forEach((roll, column) => {
        const cell = values.get(keyOf(roll, pitch));
        line.append(this.#cell(cell, { roll, pitch, x: plot.left + column * side, y: TOP + row * side, side }, range, view));
      });
      cells.append(line);
    });
    root.append(cells, ...axes(angles, plot), ...legend(plot, view, range, values));
    cells.addEventListener("keydown", (event) => this.#step(event, angles, view));
    put(this.#frame, root);
    if (focused) this.#frame.querySelector("[aria-selected=true]")?.focus();
    this.#tell(values.get(keyOf(view.roll, view.pitch))?.text ?? "");
  }

  #cell(cell, { roll, pitch, x, y, side }, range, view) {
    const chosen = roll === view.roll && pitch === view.pitch;
    const colour = colourOf(cell?.value, range);
    const element = svg("g", {
      role: "gridcell",
      class: chosen ? "cell chosen" : "cell",
      tabindex: chosen ? 0 : -1,
      "aria-selected": chosen,
      "aria-label": cell?.text ?? `roll ${roll}, pitch ${pitch}`,
      "data-roll": roll,
      "data-pitch": pitch,
    });
    const box = { x: x + 0.75, y: y + 0.75, width: side - 1.5, height: side - 1.5 };
    element.append(svg("rect", { ...box, fill: colour, class: colour === null ? "none" : null }));
    const letter = CLASSES[cell?.value]?.letter ?? (colour === null ? NONE : null);
    if (letter !== null && side > LETTERS_FROM) {
      element.append(svg("text", { x: x + side / 2, y: y + side / 2 + 4, "text-anchor": "middle", fill: colour && inkOn(colour) }, letter));
    }
    if (chosen) {
      const frame = { x: x + 2, y: y + 2, width: side - 4, height: side - 4 };
      element.append(svg("rect", { ...frame, class: "frame-out" }), svg("rect", { ...frame, class: "frame-in" }));
    }
    element.addEventListener("click", () => this.#choose(roll, pitch));
    element.addEventListener("pointerenter", () => this.#tell(cell?.text ?? ""));
    return element;
  }

  #step(event, angles, view) {
    const [right, up] = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key] ?? [0, 0];
    if (right === 0 && up === 0) return;
    event.preventDefault();
    const roll = angles[angles.indexOf(view.roll) + right];
    const pitch = angles[angles.indexOf(view.pitch) + up];
    if (roll !== undefined && pitch !== undefined) this.#choose(roll, pitch);
  }
}

/** What each cell shows: by "roll pitch" its value, null where there is none, and a line that says it. */
export function mapValues(model, view) {
  const quantity = QUANTITIES[view.quantity];
  const overAll = needsSummaries(view);
  const values = new Map();
  const add = (roll, pitch, value) => {
    const what = overAll && quantity.ofState ? quantity.all : quantity.name;
    const shown = value === null ? "none" : CLASSES[value] ? className(value) : quantity.write(value, view.unit);
    values.set(keyOf(roll, pitch), {
      roll,
      pitch,
      value,
      text: `roll ${angleNumber(roll)}, pitch ${angleNumber(pitch)} deg: ${what} ${shown}`,
    });
  };
  if (!overAll) {
    for (const state of model.map?.states ?? []) add(state.roll, state.pitch, quantity.ofState(state));
    return values;
  }
  for (const orientation of model.orientations ?? []) {
    const { roll, pitch } = orientation;
    const windows = (model.windows?.windows ?? []).filter((window) => window.roll === roll && window.pitch === pitch);
    add(roll, pitch, quantity.ofAll({ ...orientation, windows }));
  }
  return values;
}

function keyOf(roll, pitch) {
  return `${roll} ${pitch}`;
}

function rangeOf(values) {
  const numbers = [...values.values()].map(({ value }) => value).filter((value) => typeof value === "number");
  return numbers.length > 0 ? [Math.min(...numbers), Math.max(...numbers)] : null;
}

/** The colour of a value, null where there is none. */
function colourOf(value, range) {
  if (typeof value === "string") return CLASS_COLOURS[value];
  if (typeof value !== "number") return null;
  const [low, high] = range;
  return scaleColour(high > low ? (value - low) / (high - low) : 0.5);
}

/** The square of the cells, in the middle of what the picture has. */
function plotIn(width, height, count) {
  const side = Math.floor(Math.min(width - LEFT - RIGHT, height - TOP - BELOW) / count) * count;
  return { side, left: LEFT + Math.floor((width - LEFT - RIGHT - side) / 2), bottom: TOP + side };
}

function axes(angles, { side: all, left, bottom }) {
  const marks = [];
  const side = all / angles.length;
  const every = Math.ceil(angles.length / 11);
  angles.forEach((angle, k) => {
    if (k % every !== (angles.length >> 1) % every) return;
    const x = left + (k + 0.5) * side;
    const y = bottom - (k + 0.5) * side + 4;
    marks.push(svg("text", { x, y: bottom + 14, "text-anchor": "middle" }, angleNumber(angle)));
    marks.push(svg("text", { x: left - 6, y, "text-anchor": "end" }, angleNumber(angle)));
  });
  const [x, y] = [left - 34, TOP + all / 2];
  marks.push(svg("text", { x: left + all / 2, y: bottom + 29, "text-anchor": "middle", class: "title" }, "roll (deg)"));
  marks.push(svg("text", { x, y, "text-anchor": "middle", class: "title", transform: `rotate(-90 ${x} ${y})` }, "pitch (deg)"));
  return marks;
}

function legend(plot, view, range, values) {
  const top = plot.bottom + 38;
  if (range === null) return view.quantity === "class" ? classLegend(plot, top) : [];
  const gaps = [...values.values()].some(({ value }) => value === null);
  return [...scaleLegend(plot, top, view, range), ...(gaps ? noneLegend(plot, top) : [])];
}

function classLegend({ left, side }, top) {
  const first = left + side / 2 - LEGEND_WIDTH / 2;
  return Object.entries(CLASSES).flatMap(([key, { short, letter }], k) => {
    const x = first + LEGEND_PLACES[k];
    return [
      svg("rect", { x, y: top, width: 14, height: 14, fill: CLASS_COLOURS[key] }),
      svg("text", { x: x + 7, y: top + 11, "text-anchor": "middle", fill: inkOn(CLASS_COLOURS[key]) }, letter),
      svg("text", { x: x + 19, y: top + 11 }, short),
    ];
  });
}

function scaleLegend({ left, side }, top, view, [low, high]) {
  const steps = 64;
  const width = side / steps;
  const bars = Array.from({ length: steps }, (_, k) =>
    svg("rect", { x: left + k * width, y: top - 2, width: width + 0.4, height: 9, fill: scaleColour(k / (steps - 1)) }),
  );
  const quantity = QUANTITIES[view.quantity];
  const label = (value, x, anchor) => svg("text", { x, y: top + 20, "text-anchor": anchor }, quantity.write(value, view.unit));
  return [...bars, label(low, left, "start"), label(high, left + side, "end")];
}

function noneLegend({ left, side }, top) {
  const middle = left + side / 2;
  return [
    svg("rect", { x: middle - 24, y: top + 10, width: 12, height: 12, class: "none" }),
    svg("text", { x: middle - 18, y: top + 20, "text-anchor": "middle" }, NONE),
    svg("text", { x: middle - 7, y: top + 20 }, "none"),
  ];
}
