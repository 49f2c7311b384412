// The jamming diagram of a state: which loads beside a push its contacts can balance.

import { pieceText } from "./load.js";
import { picture, svg } from "./svg.js";
import { decimalsOf, ticks } from "./ticks.js";
import { fixed } from "./units.js";

const WIDTH = 460;
const HEIGHT = 300;
const LEFT = 46;
const RIGHT = 10;
const TOP = 8;
const BELOW = 36;
const MARGIN = 0.08;
const LEAST_HALF = 1e-3;
const COLOURS = 6;
/** Pieces shorter than so many pixels have no letter. */
const LETTER_FROM = 16;
const MOST_NAMED = 8;
const NAMES = { fx: "Fx / push", fy: "Fy / push", mx: "Mx / (push r)", my: "My / (push r)", mz: "Mz / (push r)" };

/** The picture of a diagram, and the rows of its legend: [letter, colour, text]. */
export function jammingPicture(diagram) {
  const view = viewOf(diagram);
  const pieces = diagram.pieces.filter((piece) => !piece.window).map((piece) => ({ piece, points: pointsOf(diagram, piece).map((point) => view.at(point)) }));
  pieces.sort((one, other) => lengthOf(other.points) - lengthOf(one.points));
  const named = pieces.slice(0, MOST_NAMED);
  const root = picture(WIDTH, HEIGHT, `Jamming diagram, ${diagram.kind}`, { class: "jamming" });
  root.append(...frame(view, diagram.axes));
  if (diagram.vertices.length > 2) root.append(svg("polygon", { class: "inside", points: diagram.vertices.map((point) => view.at(point).join(" ")).join(",") }));
  if (diagram.vertices.length === 1) root.append(dot(view.at(diagram.vertices[0]), "point"));
  pieces.forEach(({ points }, k) => root.append(svg("polyline", { class: `edge c${1 + (k % COLOURS)}`, points: points.map((point) => point.join(" ")).join(",") })));
  named.forEach(({ points }, k) => {
    if (lengthOf(points) < LETTER_FROM) return;
    const [x, y] = points[points.length >> 1];
    const [p, q] = points.length === 2 ? [(x + points[0][0]) / 2, (y + points[0][1]) / 2] : [x, y];
    root.append(svg("text", { x: p, y: q + 4, class: "letter", "text-anchor": "middle" }, letterOf(k)));
  });
  root.append(dot(view.at(diagram.load_at), "load"));
  const rows = named.map(({ piece }, k) => [letterOf(k), `c${1 + (k % COLOURS)}`, pieceText(piece, diagram.contacts)]);
  return { root, rows, more: pieces.length - named.length };
}

/** What a diagram is, in a sentence. */
export function jammingText({ kind, wedged, hull_gap: gap }) {
  const kinds = {
    empty: "No load with this push is held.",
    point: "One load alone is held.",
    segment: "The loads on a line are held.",
    bounded: "Loads within the outline are held.",
    unbounded: "Loads within the outline are held, which has no end.",
    plane: "All these loads are held.",
  };
  const wedging = wedged.length > 0 ? ` Contacts ${wedged.join(", ")} can wedge.` : "";
  return kinds[kind] + wedging + (gap > 0 ? ` The patch may reach beyond its points by ${gap.toExponential(0)} of the radius.` : "");
}

function viewOf({ vertices, load_at: load, window }) {
  const points = [...vertices, load, [0, 0]];
  const ranges = [0, 1].map((k) => {
    if (window !== null) return [Math.min(-window[k], load[k]), Math.max(window[k], load[k])];
    const values = points.map((point) => point[k]);
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const half = Math.max((high - low) / 2, LEAST_HALF) * (1 + 2 * MARGIN);
    return [(low + high) / 2 - half, (low + high) / 2 + half];
  });
  const [[left, right], [bottom, top]] = ranges;
  const x = (value) => LEFT + ((value - left) / (right - left)) * (WIDTH - LEFT - RIGHT);
  const y = (value) => TOP + ((top - value) / (top - bottom)) * (HEIGHT - TOP - BELOW);
  return { ranges, x, y, at: ([p, q]) => [Number(x(p).toFixed(2)), Number(y(q).toFixed(2))] };
}

function frame({ ranges: [[left, right], [bottom, top]], x, y }, [across, up]) {
  const marks = [];
  const columns = ticks(left, right, 6);
  const rows = ticks(bottom, top, 5);
  const [a, b] = [decimalsOf(columns), decimalsOf(rows)];
  for (const value of columns) {
    marks.push(svg("line", { x1: x(value), x2: x(value), y1: TOP, y2: HEIGHT - BELOW, class: value === 0 ? "zero" : "grid" }));
    marks.push(svg("text", { x: x(value), y: HEIGHT - BELOW + 14, "text-anchor": "middle" }, fixed(value, a)));
  }
  for (const value of rows) {
    marks.push(svg("line", { x1: LEFT, x2: WIDTH - RIGHT, y1: y(value), y2: y(value), class: value === 0 ? "zero" : "grid" }));
    marks.push(svg("text", { x: LEFT - 5, y: y(value) + 4, "text-anchor": "end" }, fixed(value, b)));
  }
  const middle = (TOP + HEIGHT - BELOW) / 2;
  marks.push(svg("text", { x: (LEFT + WIDTH - RIGHT) / 2, y: HEIGHT - 6, "text-anchor": "middle", class: "title" }, NAMES[across]));
  marks.push(svg("text", { x: 10, y: middle, "text-anchor": "middle", class: "title", transform: `rotate(-90 10 ${middle})` }, NAMES[up]));
  return marks;
}

function pointsOf({ vertices }, { first, last }) {
  const count = vertices.length;
  const steps = first === last ? 0 : (last - first + count) % count;
  return Array.from({ length: steps + 1 }, (_, k) => vertices[(first + k) % count]);
}

function lengthOf(points) {
  return points.slice(1).reduce((sum, [x, y], k) => sum + Math.hypot(x - points[k][0], y - points[k][1]), 0);
}

function letterOf(k) {
  return String.fromCharCode(97 + k);
}

function dot([x, y], name) {
  return svg("circle", { cx: x, cy: y, r: name === "load" ? 5 : 3.5, class: name });
}
