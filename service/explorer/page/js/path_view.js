// The way from the present formation to the clearance window, step by step.

import { CLASS_COLOURS, UNDECIDED_COLOUR } from "./colours.js";
import { picture, replaceContent, svg } from "./svg.js";
import { className } from "./terms.js";
import { angle, angleNumber, wrapAngle } from "./units.js";

const WIDTH = 396;
const PER_ROW = 6;
const STEP = WIDTH / PER_ROW;
const ROW = 40;
const BOX = { width: 58, height: 22 };

/** Draws a path; `choose` is called with the pose of a step. */
export function drawPath(frame, path, choose) {
  const rows = Math.ceil(path.steps.length / PER_ROW);
  const root = picture(WIDTH, rows * ROW + 6, "Way to the clearance window", { class: "path", role: "group" });
  const labels = stepLabels(path.steps);
  path.steps.forEach((step, k) => {
    const [x, y] = placeOf(k);
    if (k > 0) {
      const [x0, y0] = placeOf(k - 1);
      const line = y0 === y ? `M${x0 + BOX.width} ${y0 + 11}H${x}` : `M${x0 + 29} ${y0 + BOX.height}V${y0 + 31}H${x + 29}V${y}`;
      root.append(svg("path", { d: line, class: "link" }));
    }
    root.append(stepBox(step, labels[k], x, y, k === 0, choose));
  });
  replaceContent(frame, root);
}

/** The path in one line. */
export function pathText(path) {
  if (path === null) return "No counter-clockwise turn leads to a clearance window from here.";
  if (path.steps[0].in_window) return "Here the bolt is in the clearance window.";
  const count = path.transitions === 1 ? "1 transition" : `${path.transitions} transitions`;
  return `${count}; the window begins at ${angle(wrapAngle(path.steps.at(-1).phase), 4)}`;
}

/** What stands in the box of each step: the phase where it begins, with the decimals that distinguish it from its neighbours. */
export function stepLabels(steps) {
  const written = (k, decimals) => angleNumber(wrapAngle(steps[k].phase), decimals);
  return steps.map(({ in_window: within }, k) => {
    if (within) return "window";
    if (k === 0) return "here";
    const beside = [k - 1, k + 1].filter((other) => other > 0 && other < steps.length);
    const decimals = [2, 3, 4].find((one) => beside.every((other) => written(other, one) !== written(k, one))) ?? 4;
    return written(k, decimals);
  });
}

function placeOf(k) {
  return [(k % PER_ROW) * STEP + 4, Math.floor(k / PER_ROW) * ROW + 4];
}

function stepBox(step, text, x, y, first, choose) {
  const name = step.in_window ? "step window" : "step";
  const label = `${text}: ${className(step.class)} from phase ${angle(wrapAngle(step.phase))}`;
  const box = svg("g", { class: first ? `${name} first` : name, role: "button", tabindex: 0, "aria-label": label });
  box.append(svg("rect", { x, y, ...BOX, rx: 4, class: "box" }, svg("title", {}, step.text)));
  box.append(svg("rect", { x, y, width: 5, height: BOX.height, rx: 2, fill: CLASS_COLOURS[step.class] ?? UNDECIDED_COLOUR }));
  box.append(svg("text", { x: x + 32, y: y + 15, "text-anchor": "middle" }, text));
  const go = () => choose(step);
  box.addEventListener("click", go);
  box.addEventListener("keydown", (event) => {
    if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      go();
    }
  });
  return box;
}
