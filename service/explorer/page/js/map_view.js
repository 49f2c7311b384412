// The map of orientations.

import { CLASS_COLOURS, textColourOn, scaleColour } from "./colours.js";
import { isOnGrid, nearestTilt, tilts } from "./grid.js";
import { QUANTITIES, needsSummaries } from "./quantities.js";
import { sizeOf } from "./size.js";
import { picture, replaceContent, svg } from "./svg.js";
import { CLASSES, className } from "./terms.js";
import { angle, angleNumber } from "./units.js";

const LEAST = { width: 280, height: 190 };
const LEFT = 46;
const RIGHT = 2;
const TOP = 4;
const BELOW = 62;
const LETTERS_FROM = 14;
const LEGEND_PLACES = [0, 66, 166];
const LEGEND_WIDTH = 240;
const UNDECIDED_WIDTH = 84;
const NONE = "–";
const CROSS = 7;

/** The picture in a frame; `choose` is called with roll and pitch, `showText` with a line about a cell, `goTo` with a measured pose. */
export class MapView {
  #frame;
  #choose;
  #showText;
  #goTo;
  /** What was drawn: the cells' values, where orientations lie, how large a square is, and the marks of the chosen state. */
  #drawn = null;

  constructor(frame, { choose, showText, goTo }) {
    this.#frame = frame;
    this.#choose = choose;
    this.#showText = showText;
    this.#goTo = goTo;
  }

  /** Draws the map; a cell that had the focus has it again. `remaining` are orientations that an observation leaves. */
  draw(model, view, remaining) {
    const { grid } = model.library;
    const values = mapValues(model, view);
    const angles = tilts(grid);
    const range = rangeOf(values, QUANTITIES[view.quantity]);
    const focused = this.#frame.contains(document.activeElement);
    const { width, height } = sizeOf(this.#frame, LEAST);
    const root = picture(width, height, "Map of orientations", { class: "map", role: "group" });
    const plot = plotIn(width, height, angles.length);
    const side = plot.side / angles.length;
    const onGrid = isOnGrid(grid, view);
    const stop = onGrid ? view : { roll: nearestTilt(grid, view.roll), pitch: nearestTilt(grid, view.pitch) };
    const cells = svg("g", { role: "grid", "aria-label": "orientations by pitch and roll" });
    [...angles].reverse().forEach((pitch, row) => {
      const line = svg("g", { role: "row" });
      angles.forEach((roll, column) => {
        const cell = values.get(keyOf(roll, pitch));
        const place = { roll, pitch, x: plot.left + column * side, y: TOP + row * side, side };
        line.append(this.#cell(cell, place, range, { chosen: onGrid && isAt(view, place), stop: isAt(stop, place) }));
      });
      cells.append(line);
    });
    const placed = placesOf(grid, angles, plot, side);
    root.append(cells, ...axes(angles, plot), ...legend(plot, view, range, hasGaps(values, angles)));
    root.append(...remainingMarks(remaining, placed, side));
    const own = svg("g");
    root.append(own);
    if (!onGrid) root.append(cross(placed(view)));
    root.append(...this.#poseMarks(model.measured ?? [], placed));
    cells.addEventListener("keydown", (event) => this.#step(event, angles, stop));
    replaceContent(this.#frame, root);
    if (focused) this.#frame.querySelector('.cell[tabindex="0"]')?.focus();
    this.#drawn = { values, placed, side, own };
    this.markState(model, view);
  }

  /** Marks the class of the chosen state in its square where that shows another phase's, and says both. */
  markState(model, view) {
    if (this.#drawn === null) return;
    const { values, placed, side, own } = this.#drawn;
    const onGrid = isOnGrid(model.library.grid, view);
    replaceContent(own, ...(onGrid ? ownClass(model, view, placed(view), side) : []));
    this.#showText(chosenText(model, view, values.get(keyOf(view.roll, view.pitch)), onGrid));
  }

  #cell(cell, { roll, pitch, x, y, side }, range, { chosen, stop }) {
    const colour = colourOf(cell?.value, range);
    const text = cell?.text ?? `${placeText({ roll, pitch })}: undecided`;
    const element = svg("g", {
      role: "gridcell",
      class: chosen ? "cell chosen" : "cell",
      tabindex: stop ? 0 : -1,
      "aria-selected": chosen,
      "aria-label": text,
      "data-roll": roll,
      "data-pitch": pitch,
    });
    const box = { x: x + 0.75, y: y + 0.75, width: side - 1.5, height: side - 1.5 };
    element.append(svg("rect", { ...box, fill: colour, class: colour === null ? "none" : null }));
    const letter = CLASSES[cell?.value]?.letter ?? (colour === null ? NONE : null);
    if (letter !== null && side > LETTERS_FROM) {
      element.append(svg("text", { x: x + side / 2, y: y + side / 2 + 4, "text-anchor": "middle", fill: colour && textColourOn(colour) }, letter));
    }
    const frame = { x: x + 2, y: y + 2, width: side - 4, height: side - 4 };
    if (chosen || stop) element.append(svg("rect", { ...frame, class: "frame-out" }), svg("rect", { ...frame, class: "frame-in" }));
    element.addEventListener("click", () => this.#choose(roll, pitch));
    element.addEventListener("pointerenter", () => this.#showText(text));
    return element;
  }

  #poseMarks(measured, placed) {
    return measured.map(({ pose }, k) => {
      const [x, y] = placed(pose);
      const mark = svg("g", { class: "pose", "data-pose": k }, [
        svg("path", { d: `M${x} ${y - 6}l5 6l-5 6l-5 -6z` }),
        svg("title", {}, `measured pose ${k + 1}: ${placeText(pose)}, phase ${angle(pose.phase)}`),
      ]);
      mark.addEventListener("click", () => this.#goTo(pose));
      return mark;
    });
  }

  #step(event, angles, from) {
    const [right, up] = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1], Enter: [0, 0] }[event.key] ?? [];
    if (right === undefined) return;
    event.preventDefault();
    const roll = angles[angles.indexOf(from.roll) + right];
    const pitch = angles[angles.indexOf(from.pitch) + up];
    if (roll !== undefined && pitch !== undefined) this.#choose(roll, pitch);
  }
}

/** What each cell shows: by "roll pitch" its value, null where there is none, and a line of text. */
export function mapValues(model, view) {
  const quantity = QUANTITIES[view.quantity];
  const overAll = needsSummaries(view);
  const values = new Map();
  const add = (roll, pitch, value) => {
    const what = overAll && quantity.ofState ? quantity.all : quantity.name;
    const shown = value === null ? "none" : CLASSES[value] ? className(value) : quantity.write(value, view.unit);
    values.set(keyOf(roll, pitch), { roll, pitch, value, text: `${placeText({ roll, pitch })}: ${what} ${shown}` });
  };
  if (!overAll) {
    for (const state of model.map?.states ?? []) add(state.roll, state.pitch, quantity.ofState(state));
    return values;
  }
  const falls = new Map((model.windows?.orientations ?? []).map((one) => [keyOf(one.roll, one.pitch), one]));
  for (const orientation of model.orientations ?? []) {
    const { roll, pitch } = orientation;
    add(roll, pitch, quantity.ofAll({ ...orientation, windows: [], ...falls.get(keyOf(roll, pitch)) }));
  }
  return values;
}

/** Which phase the map shows, where that is not over all of them. */
export function mapPhaseText(model, view) {
  if (needsSummaries(view) || model.map === null) return "";
  const shown = `Squares: at phase ${angleNumber(model.map.phase)} of the grid`;
  return model.map.phase === view.phase ? `${shown}.` : `${shown}; you are at ${angleNumber(view.phase)}.`;
}

function chosenText(model, view, cell, onGrid) {
  const { state } = model;
  const own = state !== null && state.state !== null && isAt(view, state.pose) ? state : null;
  if (!onGrid) {
    const beyond = Math.max(Math.abs(view.roll), Math.abs(view.pitch)) > model.library.grid.tilt_max;
    const place = `${placeText(view)} lies ${beyond ? "beyond" : "between"} the squares, computed now`;
    return own === null ? place : `${place}: ${className(own.state.class)} at phase ${angleNumber(own.pose.phase)}`;
  }
  if (cell === undefined) return "";
  const differs = !needsSummaries(view) && own !== null && model.map !== null && own.pose.phase !== model.map.phase && own.state.class !== cell.value;
  if (view.quantity !== "class" || !differs) return cell.text;
  return `${cell.text} at phase ${angleNumber(model.map.phase)}; ${className(own.state.class)} at ${angleNumber(own.pose.phase)}`;
}

function placeText({ roll, pitch }) {
  return `roll ${angleNumber(roll)}, pitch ${angleNumber(pitch)} deg`;
}

function isAt(one, other) {
  return one.roll === other.roll && one.pitch === other.pitch;
}

function keyOf(roll, pitch) {
  return `${roll} ${pitch}`;
}

function rangeOf(values, { range }) {
  const numbers = [...values.values()].map(({ value }) => value).filter((value) => typeof value === "number");
  if (numbers.length === 0) return null;
  return range ?? [Math.min(...numbers), Math.max(...numbers)];
}

function hasGaps(values, angles) {
  return values.size < angles.length ** 2 || [...values.values()].some(({ value }) => value === null);
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

/** Where an orientation lies in the picture; one beyond the grid at its border. */
function placesOf({ tilt_step: step }, angles, { left, bottom }, side) {
  const along = (tilt) => Math.min(Math.max((tilt - angles[0]) / step + 0.5, 0), angles.length) * side;
  return ({ roll, pitch }) => [left + along(roll), bottom - along(pitch)];
}

function cross([x, y]) {
  const d = `M${x - CROSS} ${y}h${2 * CROSS}M${x} ${y - CROSS}v${2 * CROSS}`;
  return svg("g", { class: "cross" }, [svg("path", { d, class: "cross-out" }), svg("path", { d, class: "cross-in" })]);
}

/** The class of the chosen state in the corner of its square, where that shows another phase's. */
function ownClass(model, view, [x, y], side) {
  const { state, map } = model;
  const shown = view.quantity === "class" && !needsSummaries(view);
  if (!shown || !state?.state || map === null || !isAt(view, state.pose) || state.pose.phase === map.phase) return [];
  const corner = Math.min(side * 0.36, 14);
  const [right, low] = [x + side / 2 - 1, y + side / 2 - 1];
  const d = `M${right} ${low}v${-corner}l${-corner} ${corner}z`;
  return [svg("path", { d, class: "own-class", fill: CLASS_COLOURS[state.state.class] }, svg("title", {}, `here, at phase ${angleNumber(view.phase)}: ${className(state.state.class)}`))];
}

function remainingMarks(remaining, placed, side) {
  return remaining.map((one) => {
    const [x, y] = placed(one);
    return svg("circle", { cx: x + side / 2 - 4.6, cy: y - side / 2 + 4.6, r: 2.6, class: "remains" });
  });
}

function axes(angles, { side: all, left, bottom }) {
  const marks = [];
  const side = all / angles.length;
  const every = Math.ceil(angles.length / 11);
  angles.forEach((tilt, k) => {
    if (k % every !== (angles.length >> 1) % every) return;
    const x = left + (k + 0.5) * side;
    const y = bottom - (k + 0.5) * side + 4;
    marks.push(svg("text", { x, y: bottom + 14, "text-anchor": "middle" }, angleNumber(tilt)));
    marks.push(svg("text", { x: left - 6, y, "text-anchor": "end" }, angleNumber(tilt)));
  });
  const [x, y] = [left - 34, TOP + all / 2];
  marks.push(svg("text", { x: left + all / 2, y: bottom + 29, "text-anchor": "middle", class: "title" }, "roll (deg)"));
  marks.push(svg("text", { x, y, "text-anchor": "middle", class: "title", transform: `rotate(-90 ${x} ${y})` }, "pitch (deg)"));
  return marks;
}

function legend(plot, view, range, gaps) {
  const top = plot.bottom + 38;
  if (range === null) return view.quantity === "class" ? classLegend(plot, top, gaps) : noneLegend(plot, top, view);
  return [...scaleLegend(plot, top, view, range), ...(gaps ? noneLegend(plot, top, view) : [])];
}

function classLegend({ left, side }, top, gaps) {
  const width = LEGEND_WIDTH + (gaps ? UNDECIDED_WIDTH : 0);
  const first = Math.max(left + side / 2 - width / 2, 2);
  const entries = Object.entries(CLASSES).flatMap(([key, { short, letter }], k) => {
    const x = first + LEGEND_PLACES[k];
    return [
      svg("rect", { x, y: top, width: 14, height: 14, fill: CLASS_COLOURS[key] }),
      svg("text", { x: x + 7, y: top + 11, "text-anchor": "middle", fill: textColourOn(CLASS_COLOURS[key]) }, letter),
      svg("text", { x: x + 19, y: top + 11 }, short),
    ];
  });
  return gaps ? [...entries, ...grey(first + LEGEND_WIDTH, top, "undecided")] : entries;
}

function scaleLegend({ left, side }, top, view, [low, high]) {
  const steps = 64;
  const width = side / steps;
  const bars = Array.from({ length: steps }, (_, k) =>
    svg("rect", { x: left + k * width, y: top - 2, width: width + 0.4, height: 9, fill: scaleColour(k / (steps - 1)) }),
  );
  const quantity = QUANTITIES[view.quantity];
  const label = (value, x, anchor, sign = "") => svg("text", { x, y: top + 20, "text-anchor": anchor }, sign + quantity.write(value, view.unit));
  const beyond = quantity.range ? "≥ " : "";
  return [...bars, label(low, left, "start"), label(high, left + side, "end", beyond)];
}

function noneLegend({ left, side }, top, { quantity }) {
  const text = QUANTITIES[quantity].none ?? "none";
  return grey(left + side / 2 - 14 - 3 * text.length, top + 9, text);
}

function grey(x, y, text) {
  return [
    svg("rect", { x, y, width: 14, height: 14, class: "none" }),
    svg("text", { x: x + 7, y: y + 11, "text-anchor": "middle" }, NONE),
    svg("text", { x: x + 19, y: y + 11 }, text),
  ];
}
