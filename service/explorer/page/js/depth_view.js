// Depth against phase: curves, boundaries, the snap and the clearance window, measured poses, another curve beside, the cursor.

import { CLASS_COLOURS, UNDECIDED_COLOUR } from "./colours.js";
import { depthCurves, heightAt, intervalAt, visibleParts } from "./curve.js";
import { jumpsOfSnap, snapText } from "./falls.js";
import { restHeight } from "./resting.js";
import { sizeOf } from "./size.js";
import { picture, pointIn, replaceContent, svg } from "./svg.js";
import { className } from "./terms.js";
import { angleTicks, decimalsOf, ticks } from "./ticks.js";
import { angle, angleNumber, fixed, wrapAngle } from "./units.js";
import { wrapped } from "./wrap.js";

const LEAST = { width: 320, height: 130 };
const LEFT = 86;
const RIGHT = 14;
const LINE = 15;
const BOTTOM = 38;
const RIBBON = 12;
const CLIP = "depth-clip";
/** About how wide a letter is: lines of the legend that do not fit beside each other are put below each other. */
const LETTER = 6.3;
const BOLD_LETTER = 6.9;
/** The mark before an entry of the legend, with the room behind it. */
const MARK = 27;
/** How many steps of the phase a key with Shift goes. */
const MANY_STEPS = 10;

/** The picture in a frame; `choose` is called with a phase that was pointed at, `step` with steps of the grid by keys. */
export class DepthView {
  #frame;
  #choose;
  #zoom;
  #step;
  #goTo;
  #cursor = null;
  #scale = null;
  #root = null;

  /** `zoom` is called with a factor and a phase (null: the middle; factor null: the whole turn), `goTo` with a measured pose. */
  constructor(frame, { choose, zoom, step, goTo }) {
    this.#frame = frame;
    this.#choose = choose;
    this.#zoom = zoom;
    this.#step = step;
    this.#goTo = goTo;
  }

  /** Draws everything but the cursor; `range` is {from, span}, `beside` another orientation {heights, library, text} or null. */
  draw({ heights, intervals, library, beside, measured }, view, range) {
    const focused = this.#frame.contains(document.activeElement);
    const curves = depthCurves(heights, library.pair.thread_pitch);
    const besideCurve = beside ? depthCurves(beside.heights, beside.library.pair.thread_pitch).first : [];
    const size = sizeOf(this.#frame, LEAST);
    const legendLines = legendOf(intervals?.history ?? null, beside, view, size.width);
    const scale = scaleOf([...curves.first, ...curves.rest, ...besideCurve], range, size, legendLines.length);
    this.#scale = scale;
    const root = picture(scale.width, scale.height, "Depth against phase", { class: "depth" });
    root.append(clip(scale));
    root.append(...windowBands(intervals, scale), ...snapSpan(intervals, scale));
    root.append(...axes(scale, view.unit));
    root.append(...boundaryLines(intervals, scale));
    root.append(...ribbon(intervals, scale));
    root.append(...curveLines(curves.rest, scale, "curve rest"), ...curveLines(besideCurve, scale, "curve beside"));
    root.append(...curveLines(curves.first, scale, "curve first"));
    root.append(...jumpMarks(intervals, scale));
    root.append(...legendLines.flatMap((entries, line) => legendLine(entries, LINE * line + 11)));
    root.append(...this.#poseMarks(measured ?? [], curves, view, scale));
    this.#cursor = svg("g", { class: "cursor" });
    root.append(this.#cursor);
    this.#root = root;
    this.#listen(root);
    this.#describe(view);
    replaceContent(this.#frame, root);
    if (focused) root.focus();
  }

  /** Moves the cursor to the state of the view. */
  moveCursor(model, view) {
    const scale = this.#scale;
    if (scale === null) return;
    const parts = [];
    for (const [low] of visibleParts(view.phase, view.phase, scale.from, scale.span)) {
      const x = scale.x(low);
      parts.push(svg("line", { x1: x, x2: x, y1: scale.plotTop, y2: scale.base + RIBBON + 4 }));
      const state = isOf(model.state, view) ? model.state.state : null;
      if (state) {
        const rest = restHeight(state);
        if (rest !== null) parts.push(svg("circle", { cx: x, cy: scale.y(rest), r: 4, class: "at-rest" }));
        parts.push(svg("circle", { cx: x, cy: scale.y(state.poses[0].translation[2]), r: 4, class: "at-first" }));
      }
    }
    replaceContent(this.#cursor, ...parts);
    this.#describe(view);
  }

  /** The picture is a slider of the phase, so that keys move it as the pointer does. */
  #describe({ phase }) {
    const ariaValues = { role: "slider", tabindex: 0, "aria-valuemin": 0, "aria-valuemax": 360, "aria-valuenow": phase };
    const keys = "Arrow keys move the phase, with Shift further; plus and minus zoom, 0 shows the whole turn";
    const texts = { "aria-label": `Depth against phase. ${keys}`, "aria-valuetext": `phase ${angle(phase)}` };
    for (const [name, value] of Object.entries({ ...ariaValues, ...texts })) this.#root.setAttribute(name, value);
  }

  #listen(root) {
    const phaseAt = (event) => wrapAngle(this.#scale.phase(pointIn(root, event).x));
    root.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || event.target.closest(".pose")) return;
      root.setPointerCapture(event.pointerId);
      this.#choose(phaseAt(event));
    });
    root.addEventListener("pointermove", (event) => {
      if (root.hasPointerCapture(event.pointerId)) this.#choose(phaseAt(event));
    });
    root.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.#zoom(event.deltaY < 0 ? 1 / 1.3 : 1.3, this.#scale.phase(pointIn(root, event).x));
      },
      { passive: false },
    );
    root.addEventListener("keydown", (event) => this.#key(event));
  }

  #key(event) {
    const many = event.shiftKey ? MANY_STEPS : 1;
    const steps = { ArrowRight: many, ArrowUp: many, ArrowLeft: -many, ArrowDown: -many, PageUp: MANY_STEPS, PageDown: -MANY_STEPS }[event.key];
    const factor = { "+": 0.5, "=": 0.5, "-": 2, 0: null, Home: null }[event.key];
    if (steps === undefined && factor === undefined) return;
    event.preventDefault();
    if (steps === undefined) this.#zoom(factor, null);
    else this.#step(steps);
  }

  /** Measured poses: those of this orientation on the curve, the others at the foot. */
  #poseMarks(measured, curves, view, scale) {
    return measured.flatMap(({ pose, state }, k) => {
      const here = pose.roll === view.roll && pose.pitch === view.pitch;
      return visibleParts(pose.phase, pose.phase, scale.from, scale.span).map(([phase]) => {
        const height = here ? (state?.poses[0].translation[2] ?? heightAt(curves.first, pose.phase)) : null;
        const [x, y] = [scale.x(phase), height === null ? scale.base - 6 : scale.y(height)];
        const mark = svg("g", { class: here ? "pose here" : "pose", "data-pose": k }, [
          svg("path", { d: `M${x} ${y - 6}l5 6l-5 6l-5 -6z` }),
          svg("title", {}, `measured pose ${k + 1}: ${poseText(pose)}`),
        ]);
        mark.addEventListener("click", () => this.#goTo(pose));
        return mark;
      });
    });
  }
}

/** A pose in words. */
export function poseText({ roll, pitch, phase }) {
  return `roll ${angleNumber(roll)}, pitch ${angleNumber(pitch)}, phase ${angle(phase)}`;
}

/** The text about a phase, in one line. */
export function depthReadout(model, view) {
  const interval = intervalAt(model.intervals, view.phase);
  if (interval === null) return "";
  const within = interval.in_window ? ", in the clearance window" : "";
  const end = wrapAngle(interval.end);
  return `${className(interval.formation.class)} from ${angle(interval.start)} to ${angle(end)}${within}`;
}

function isOf(state, view) {
  return state !== null && ["roll", "pitch", "phase"].every((name) => state.pose[name] === view[name]);
}

/**
 * The lines of the legend, each with entries {name, text, x}: beside each other where they fit. A text that is longer than the
 * picture is wide goes on in the next line, without a mark.
 */
function legendOf(history, beside, view, width) {
  const entries = [
    { name: "first", text: "first contact" },
    { name: "rest", text: "at rest" },
    ...(beside ? [{ name: "beside", text: `first contact at ${beside.text}` }] : []),
    ...(history?.snap ? [{ name: "snap", text: snapText(history.snap, view.unit) }] : []),
  ];
  const lines = [[]];
  let x = LEFT + MARK / 4;
  for (const { name, text } of entries) {
    const letters = Math.floor((width - LEFT - MARK) / (name === "snap" ? BOLD_LETTER : LETTER));
    const parts = wrapped(text, letters, 3);
    const taken = MARK + 12 + text.length * (name === "snap" ? BOLD_LETTER : LETTER);
    if (x + taken > width && lines.at(-1).length > 0) {
      lines.push([]);
      x = LEFT + MARK / 4;
    }
    parts.forEach((part, k) => {
      if (k > 0) lines.push([]);
      lines.at(-1).push({ name, text: part, x, marked: k === 0 });
    });
    x += taken;
  }
  return lines;
}

function scaleOf(curves, { from, span }, { width, height }, legendLines) {
  const heights = curves.flat();
  const inRange = heights.filter(({ phase }) => visibleParts(phase, phase, from, span).length > 0).map((point) => point.height);
  const shown = inRange.length > 1 ? inRange : heights.map((point) => point.height);
  const low = shown.length > 0 ? Math.min(...shown) : 0;
  const high = shown.length > 0 ? Math.max(...shown) : 1;
  const room = (high - low || Math.abs(high) || 1) * 0.08;
  const [bottom, top] = [low - room, high + room];
  const [x0, x1, y0, y1] = [LEFT, width - RIGHT, height - BOTTOM, 9 + LINE * legendLines];
  return {
    width,
    height,
    base: y0,
    right: x1,
    from,
    span,
    bottom,
    top,
    /** Where the plot begins in the picture. */
    plotTop: y1,
    x: (phase) => round(x0 + ((phase - from) / span) * (x1 - x0)),
    y: (value) => round(y0 + ((value - bottom) / (top - bottom)) * (y1 - y0)),
    phase: (x) => from + (Math.min(Math.max(x, x0), x1) - x0) / (x1 - x0) * span,
  };
}

function round(value) {
  return Math.round(value * 100) / 100;
}

function clip(scale) {
  const box = { x: LEFT, y: scale.plotTop, width: scale.right - LEFT, height: scale.base - scale.plotTop };
  return svg("clipPath", { id: CLIP }, svg("rect", box));
}

function axes(scale, unit) {
  const marks = [];
  const heights = ticks(scale.bottom, scale.top, Math.max(2, Math.round((scale.base - scale.plotTop) / 30)));
  const decimals = decimalsOf(heights);
  for (const height of heights) {
    const y = scale.y(height);
    marks.push(svg("line", { x1: LEFT, x2: scale.right, y1: y, y2: y, class: height === 0 ? "zero" : "grid" }));
    marks.push(svg("text", { x: LEFT - 7, y: y + 4, "text-anchor": "end" }, fixed(height, decimals)));
  }
  const base = scale.base + RIBBON;
  const phases = angleTicks(scale.from, scale.from + scale.span, scale.width < 500 ? 6 : 12);
  for (const phase of phases) {
    const x = scale.x(phase);
    marks.push(svg("line", { x1: x, x2: x, y1: base + 2, y2: base + 7, class: "tick" }));
    marks.push(svg("text", { x, y: base + 20, "text-anchor": "middle" }, angleNumber(wrapAngle(phase), decimalsOf(phases))));
  }
  marks.push(svg("text", { x: LEFT - 14, y: base + 20, "text-anchor": "end", class: "title" }, "phase (deg)"));
  marks.push(svg("text", { x: LEFT - 7, y: 11, "text-anchor": "end", class: "title" }, `z (${unit})`));
  return marks;
}

/** The runs of a curve as paths that reach the borders of the plot: also the points next to it on both sides are drawn. */
function curveLines(runs, scale, name) {
  const [from, to] = [scale.from, scale.from + scale.span];
  return runs.flatMap((run) =>
    [-720, -360, 0, 360, 720].map((shift) => {
      const first = Math.max(run.findIndex(({ phase }) => phase + shift > from) - 1, 0);
      const beyond = run.findIndex(({ phase }) => phase + shift >= to);
      const shown = run.slice(first, beyond < 0 ? run.length : beyond + 1);
      if (shown.length < 2 || shown[0].phase + shift > to || shown.at(-1).phase + shift < from) return "";
      const path = shown.map(({ phase, height }, k) => `${k ? "L" : "M"}${scale.x(phase + shift)} ${scale.y(height)}`);
      return svg("path", { d: path.join(""), class: name, "clip-path": `url(#${CLIP})` });
    }),
  ).filter((line) => line !== "");
}

function band(start, end, scale, name, text) {
  return visibleParts(start, end, scale.from, scale.span).map(([low, high]) =>
    svg("rect", { x: scale.x(low), width: Math.max(scale.x(high) - scale.x(low), 1), y: scale.plotTop, height: scale.base - scale.plotTop, class: name }, [
      svg("title", {}, text),
    ]),
  );
}

function windowBands(intervals, scale) {
  return (intervals?.history.windows ?? []).flatMap(({ enter, leave, width }) =>
    band(enter, leave, scale, "window", `clearance window, ${angle(width, 3)} wide`),
  );
}

function snapSpan(intervals, scale) {
  const snap = intervals?.history.snap;
  return snap ? band(snap.from, snap.to, scale, "snap-span", "the snap: here the bolt goes down") : [];
}

function boundaryLines(intervals, scale) {
  const places = (intervals?.history.boundaries ?? []).flatMap(({ phase }) => visibleParts(phase, phase, scale.from, scale.span));
  return places.map(([phase]) => {
    const x = scale.x(phase);
    return svg("line", { x1: x, x2: x, y1: scale.plotTop, y2: scale.base, class: "boundary" });
  });
}

function ribbon(intervals, scale) {
  return (intervals?.history.intervals ?? []).flatMap((interval) =>
    visibleParts(interval.start, interval.end, scale.from, scale.span).map(([low, high]) => {
      const colour = CLASS_COLOURS[interval.formation.class] ?? UNDECIDED_COLOUR;
      const width = Math.max(scale.x(high) - scale.x(low), 0.5);
      return svg("rect", { x: scale.x(low), width, y: scale.base + 2, height: RIBBON - 2, fill: colour }, [
        svg("title", {}, interval.formation.text),
      ]);
    }),
  );
}

function jumpMarks(intervals, scale) {
  if (!intervals) return [];
  return jumpsOfSnap(intervals.history).flatMap(({ phase, height_before: before, height_after: after }) =>
    visibleParts(phase, phase, scale.from, scale.span).map(([at]) =>
      svg("line", { x1: scale.x(at), x2: scale.x(at), y1: scale.y(before), y2: scale.y(after), class: "snap-jump" }),
    ),
  );
}

/** A line of the legend: each entry's mark and text, beside each other. */
function legendLine(entries, y) {
  return entries.flatMap(({ name, text, x, marked }) => {
    const words = svg("text", { x: x + MARK, y, class: name === "snap" ? "snap-text" : null }, text);
    if (!marked) return [words];
    const mark = name === "snap"
      ? svg("rect", { x, y: y - 9, width: 22, height: 10, class: "snap-span" })
      : svg("line", { x1: x, x2: x + 22, y1: y - 4, y2: y - 4, class: `curve ${name}` });
    return [mark, words];
  });
}
