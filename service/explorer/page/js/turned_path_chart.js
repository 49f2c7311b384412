// Curves over the phase of a held bolt that is turned: height, torque, contact forces, tilt, shift and energies, with the point that is shown.

import { picture, pointIn, replaceContent, svg } from "./svg.js";
import { angleTicks, decimalsOf, ticks } from "./ticks.js";
import { leadLine, legsOf, nearestPoint, pointsOfEvents } from "./turned_path.js";
import { sizeOf } from "./size.js";
import { angle, angleNumber, fixed } from "./units.js";

const LEAST = { width: 300, height: 200 };
const LEFT = 52;
const RIGHT = 8;
const LINE = 15;
const ABOVE = 2;
const BELOW = 20;
const GAP = 6;
/** The least width of a plot beside others, and the least height of one below others. */
const LEAST_PLOT = 250;
const PHASE_TICK = 48;
const VALUE_TICK = 20;
/** Of so many steps at most there are at least two. */
const FEWEST_TICKS = 4;
/** About how wide a letter is, and the mark before a name. */
const LETTER = 6.4;
const MARK = 16;
const ROOM = 0.06;
/** A range below this part of the largest value is one of round-off. */
const FLAT = 1e-9;

/** The plots: title, and curves by the name of their numbers with the text beside their mark. */
function plotsOf(unit, hasFriction) {
  const energies = { elastic: "elastic", work: "hand", push: "push", falls: "falls", ...(hasFriction && { friction: "friction" }) };
  return [
    { title: `height z (${unit})`, curves: { height: "" }, hasLead: true },
    { title: `torque (N ${unit})`, curves: { torque: "" } },
    { title: "forces (N)", curves: { largest_force: "largest", all_forces: "sum" } },
    { title: "tilt (deg)", curves: { tilt: "bolt", device_tilt: "device" } },
    { title: `shift (${unit})`, curves: { shift: "" } },
    { title: `energy (N ${unit})`, curves: energies },
  ];
}

/** The picture in a frame; `choose` is called with the point that was pointed at. */
export class TurnedPathChart {
  #frame;
  #choose;
  #curves = null;
  #legs = [];
  #plots = [];
  #cursor = null;
  #at = 0;

  constructor(frame, choose) {
    this.#frame = frame;
    this.#choose = choose;
  }

  /** Draws the curves of an answer, lengths in a unit; `pair` has the lead in that unit. */
  draw(answer, curves, pair, unit) {
    const { width, height } = sizeOf(this.#frame, LEAST);
    this.#curves = curves;
    this.#legs = legsOf(curves);
    const range = [Math.min(...curves.phase), Math.max(...curves.phase)];
    const lead = leadLine(curves, this.#legs, pair);
    const wanted = plotsOf(unit, answer.mu > 0);
    const cells = cellsOf(wanted.length, width, height);
    this.#plots = wanted.map((plot, k) => {
      const names = namesOf(plot, cells[k].width - LEFT - RIGHT);
      return { ...plot, names, ...scaleOf(cells[k], range, valuesOf(plot, curves, lead), 1 + (names.at(-1)?.row ?? 0)) };
    });
    const root = picture(width, height, "Height, torque, contact forces, tilt, shift and energies over the phase of the turned bolt", { class: "turned-curves" });
    const marks = marksOf(answer);
    for (const plot of this.#plots) {
      root.append(...axes(plot), ...eventLines(plot, marks));
      if (plot.hasLead) root.append(line(lead.map(([phase, value]) => [plot.x(phase), plot.y(value)]), "lead"));
      Object.keys(plot.curves).forEach((name, k) => root.append(...this.#lines(plot, name, k)));
    }
    this.#cursor = svg("g", { class: "cursor" });
    root.append(this.#cursor);
    this.#listen(root);
    replaceContent(this.#frame, root);
    this.moveCursor(this.#at);
  }

  clear() {
    this.#curves = null;
    this.#frame.replaceChildren();
  }

  /** Marks a point in every plot. */
  moveCursor(at) {
    this.#at = at;
    if (this.#curves === null) return;
    const curves = this.#curves;
    const phase = curves.phase[at];
    const parts = this.#plots.flatMap((plot) => [
      svg("line", { x1: plot.x(phase), x2: plot.x(phase), y1: plot.top, y2: plot.base }),
      ...Object.keys(plot.curves).map((name, k) => svg("circle", { cx: plot.x(phase), cy: plot.y(curves[name][at]), r: 3.5, class: `c${k + 1}` })),
    ]);
    replaceContent(this.#cursor, ...parts);
  }

  #lines(plot, name, k) {
    const { phase } = this.#curves;
    return this.#legs.map(([first, last], leg) => {
      const points = phase.slice(first, last + 1).map((value, i) => [plot.x(value), plot.y(this.#curves[name][first + i])]);
      return line(points, `curve c${k + 1}${leg < this.#legs.length - 1 ? " earlier" : ""}`);
    });
  }

  #listen(root) {
    const choose = (event) => {
      const { x, y } = pointIn(root, event);
      const plot = this.#plots.find((one) => x >= one.left - LEFT && x <= one.right + RIGHT && y >= one.cellTop && y <= one.base + BELOW);
      if (plot) this.#choose(nearestPoint(this.#curves, this.#legs, plot.phase(x), this.#at));
    };
    root.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      root.setPointerCapture(event.pointerId);
      choose(event);
    });
    root.addEventListener("pointermove", (event) => {
      if (root.hasPointerCapture(event.pointerId)) choose(event);
    });
  }
}

/** The cells {x, y, width, height} of so many plots: as many beside each other as fit, the last one over what remains of its row. */
export function cellsOf(count, width, height) {
  const columns = Math.min(Math.max(Math.floor(width / LEAST_PLOT), 1), 3);
  const rows = Math.ceil(count / columns);
  const [wide, high] = [width / columns, height / rows];
  return Array.from({ length: count }, (_, k) => {
    const span = k === count - 1 ? columns * rows - count + 1 : 1;
    return { x: (k % columns) * wide, y: Math.floor(k / columns) * high, width: wide * span, height: high };
  });
}

function valuesOf(plot, curves, lead) {
  return [...Object.keys(plot.curves).flatMap((name) => curves[name]), ...(plot.hasLead ? lead.map(([, height]) => height) : [])];
}

function scaleOf(cell, [from, to], values, headingLines) {
  const [least, most] = [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
  const size = Math.max(Math.abs(least), Math.abs(most)) || 1;
  const room = most - least > FLAT * size ? (most - least) * ROOM : size;
  const [bottom, top] = [least - room, most + room];
  const [left, right] = [cell.x + LEFT, cell.x + cell.width - RIGHT - GAP];
  const [plotTop, base] = [cell.y + LINE * headingLines + ABOVE, cell.y + cell.height - BELOW];
  const span = to - from || 1;
  return {
    left, right, top: plotTop, base, cellTop: cell.y, titleY: cell.y + LINE - 3, from, to: from + span, bottom, most: top,
    x: (phase) => rounded(left + ((phase - from) / span) * (right - left)),
    y: (value) => rounded(base + ((value - bottom) / (top - bottom)) * (plotTop - base)),
    phase: (x) => from + (Math.min(Math.max(x, left), right) - left) / (right - left) * span,
  };
}

function rounded(value) {
  return Math.round(value * 100) / 100;
}

function axes(plot) {
  const { left, right, top, base } = plot;
  const values = ticks(plot.bottom, plot.most, Math.max(FEWEST_TICKS, Math.floor((base - top) / VALUE_TICK)));
  const phases = angleTicks(plot.from, plot.to, Math.max(2, Math.floor((right - left) / PHASE_TICK)));
  const [decimals, places] = [decimalsOf(values), decimalsOf(phases)];
  return [
    ...values.flatMap((value) => [
      svg("line", { x1: left, x2: right, y1: plot.y(value), y2: plot.y(value), class: value === 0 ? "zero" : "grid" }),
      svg("text", { x: left - 5, y: plot.y(value) + 4, "text-anchor": "end" }, fixed(value, decimals)),
    ]),
    ...phases.flatMap((phase) => [
      svg("line", { x1: plot.x(phase), x2: plot.x(phase), y1: base, y2: base + 4, class: "tick" }),
      svg("text", { x: plot.x(phase), y: base + 15, "text-anchor": "middle" }, angleNumber(phase, places)),
    ]),
    ...heading(plot),
  ];
}

/** The names of a plot's curves {text, kind, x, line} from the left, in as many lines as they need beside and below the title. */
function namesOf({ title, curves, hasLead }, width) {
  const names = [...Object.values(curves).map((text, k) => [text, `curve c${k + 1}`]), ...(hasLead ? [["the lead", "lead"]] : [])];
  let [x, row] = [title.length * LETTER + 10, 0];
  return names.filter(([text]) => text !== "").map(([text, kind]) => {
    const taken = MARK + text.length * LETTER;
    if (x + taken > width) [x, row] = [0, row + 1];
    const found = { text, kind, x, row };
    x += taken + 8;
    return found;
  });
}

function heading({ title, names, left, titleY }) {
  return [
    svg("text", { x: left, y: titleY, class: "title" }, title),
    ...names.flatMap(({ text, kind, x, row }) => {
      const [from, y] = [left + x, titleY + row * LINE];
      return [svg("line", { x1: from, x2: from + MARK - 4, y1: y - 4, y2: y - 4, class: kind }), svg("text", { x: from + MARK, y }, text)];
    }),
  ];
}

function marksOf({ path, events }) {
  const at = pointsOfEvents(path, events);
  return events.map(({ kind }, k) => ({ kind, phase: path.phase[at[k]] })).filter(({ kind }) => ["fall", "snap"].includes(kind));
}

function eventLines(plot, marks) {
  return marks.map(({ kind, phase }) =>
    svg("line", { x1: plot.x(phase), x2: plot.x(phase), y1: plot.top, y2: plot.base, class: kind }, [svg("title", {}, `${kind} at phase ${angle(phase, 2)}`)]),
  );
}

function line(points, name) {
  return svg("polyline", { points: points.map((point) => point.join(" ")).join(","), class: name });
}
