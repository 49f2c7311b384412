// Depth against phase: curves, boundaries, the snap and the clearance window, and the cursor.

import { CLASS_COLOURS, UNDECIDED_COLOUR } from "./colours.js";
import { depthCurves, intervalAt, seen } from "./curve.js";
import { sizeOf } from "./size.js";
import { picture, pointIn, put, svg } from "./svg.js";
import { className } from "./terms.js";
import { angleTicks, decimalsOf, ticks } from "./ticks.js";
import { angle, angleNumber, fixed, inTurn, length } from "./units.js";

const LEAST = { width: 420, height: 180 };
const LEFT = 78;
const RIGHT = 14;
const TOP = 24;
const BOTTOM = 38;
const RIBBON = 12;
const CLIP = "depth-clip";

/** The picture in a frame; `choose` is called with a phase that was pointed at. */
export class DepthView {
  #frame;
  #choose;
  #zoom;
  #cursor = null;
  #scale = null;

  constructor(frame, choose, zoom) {
    this.#frame = frame;
    this.#choose = choose;
    this.#zoom = zoom;
  }

  /** Draws everything but the cursor. */
  draw({ heights, intervals, library }, view) {
    const curves = depthCurves(heights, library.pair.thread_pitch);
    const scale = scaleOf(curves, view, sizeOf(this.#frame, LEAST));
    this.#scale = scale;
    const root = picture(scale.width, scale.height, "Depth against phase", { class: "depth", tabindex: 0, role: "img" });
    root.append(clip(scale));
    root.append(...windowBands(intervals, scale));
    root.append(...axes(scale, view.unit));
    root.append(...boundaryLines(intervals, scale));
    root.append(...ribbon(intervals, scale));
    root.append(...curveLines(curves.last, scale, "curve last"), ...curveLines(curves.first, scale, "curve first"));
    root.append(...snapMarks(intervals, scale, view));
    root.append(...key());
    this.#cursor = svg("g", { class: "cursor" });
    root.append(this.#cursor);
    this.#listen(root);
    put(this.#frame, root);
  }

  /** Moves the cursor to the state of the view. */
  moveCursor(model, view) {
    const scale = this.#scale;
    if (scale === null) return;
    const parts = [];
    for (const [low] of seen(view.phase, view.phase, scale.from, scale.span)) {
      const x = scale.x(low);
      parts.push(svg("line", { x1: x, x2: x, y1: TOP, y2: scale.base + RIBBON + 4 }));
      const state = model.state?.pose.phase === view.phase ? model.state.state : null;
      if (state) {
        parts.push(svg("circle", { cx: x, cy: scale.y(state.poses.at(-1).translation[2]), r: 4, class: "at-last" }));
        parts.push(svg("circle", { cx: x, cy: scale.y(state.poses[0].translation[2]), r: 4, class: "at-first" }));
      }
    }
    put(this.#cursor, ...parts);
  }

  #listen(root) {
    const phaseAt = (event) => inTurn(this.#scale.phase(pointIn(root, event).x));
    root.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
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
  }
}

/** What is to be said of a phase in one line. */
export function depthReadout(model, view) {
  const interval = intervalAt(model.intervals, view.phase);
  if (interval === null) return "";
  const within = interval.in_window ? ", in the clearance window" : "";
  const end = inTurn(interval.end);
  return `${className(interval.formation.class)} from ${angle(interval.start)} to ${angle(end)}${within}`;
}

function scaleOf(curves, { from, span }, { width, height }) {
  const heights = [...curves.first, ...curves.last].flat();
  const inRange = heights.filter(({ phase }) => seen(phase, phase, from, span).length > 0).map((point) => point.height);
  const shown = inRange.length > 1 ? inRange : heights.map((point) => point.height);
  const low = shown.length > 0 ? Math.min(...shown) : 0;
  const high = shown.length > 0 ? Math.max(...shown) : 1;
  const room = (high - low || Math.abs(high) || 1) * 0.08;
  const [bottom, top] = [low - room, high + room];
  const [x0, x1, y0, y1] = [LEFT, width - RIGHT, height - BOTTOM, TOP];
  return {
    width,
    height,
    base: y0,
    right: x1,
    from,
    span,
    bottom,
    top,
    x: (phase) => round(x0 + ((phase - from) / span) * (x1 - x0)),
    y: (value) => round(y0 + ((value - bottom) / (top - bottom)) * (y1 - y0)),
    phase: (x) => from + (Math.min(Math.max(x, x0), x1) - x0) / (x1 - x0) * span,
  };
}

function round(value) {
  return Math.round(value * 100) / 100;
}

function clip(scale) {
  const box = { x: LEFT, y: TOP, width: scale.right - LEFT, height: scale.base - TOP };
  return svg("clipPath", { id: CLIP }, svg("rect", box));
}

function axes(scale, unit) {
  const marks = [];
  const heights = ticks(scale.bottom, scale.top, Math.max(2, Math.round((scale.base - TOP) / 30)));
  const decimals = decimalsOf(heights);
  for (const height of heights) {
    const y = scale.y(height);
    marks.push(svg("line", { x1: LEFT, x2: scale.right, y1: y, y2: y, class: height === 0 ? "zero" : "grid" }));
    marks.push(svg("text", { x: LEFT - 7, y: y + 4, "text-anchor": "end" }, fixed(height, decimals)));
  }
  const base = scale.base + RIBBON;
  const phases = angleTicks(scale.from, scale.from + scale.span, 12);
  for (const phase of phases) {
    const x = scale.x(phase);
    marks.push(svg("line", { x1: x, x2: x, y1: base + 2, y2: base + 7, class: "tick" }));
    const shown = scale.span === 360 ? phase : inTurn(phase);
    marks.push(svg("text", { x, y: base + 20, "text-anchor": "middle" }, angleNumber(shown, decimalsOf(phases))));
  }
  marks.push(svg("text", { x: LEFT - 7, y: base + 20, "text-anchor": "end", class: "title" }, "phase (deg)"));
  marks.push(svg("text", { x: LEFT - 7, y: TOP - 11, "text-anchor": "end", class: "title" }, `z (${unit})`));
  return marks;
}

function curveLines(runs, scale, name) {
  return runs.flatMap((run) =>
    [-360, 0, 360].map((shift) => {
      const shown = run.filter(({ phase }) => Math.abs(phase + shift - scale.from - scale.span / 2) <= scale.span / 2 + 2);
      const path = shown.map(({ phase, height }, k) => `${k ? "L" : "M"}${scale.x(phase + shift)} ${scale.y(height)}`);
      return shown.length > 1 ? svg("path", { d: path.join(""), class: name, "clip-path": `url(#${CLIP})` }) : "";
    }),
  ).filter((line) => line !== "");
}

function windowBands(intervals, scale) {
  return (intervals?.history.windows ?? []).flatMap((window) =>
    seen(window.enter, window.leave, scale.from, scale.span).map(([low, high]) =>
      svg("rect", { x: scale.x(low), width: Math.max(scale.x(high) - scale.x(low), 1), y: TOP, height: scale.base - TOP, class: "window" }, [
        svg("title", {}, `clearance window, ${angle(window.width, 3)} wide`),
      ]),
    ),
  );
}

function boundaryLines(intervals, scale) {
  const places = (intervals?.history.boundaries ?? []).flatMap(({ phase }) => seen(phase, phase, scale.from, scale.span));
  return places.map(([phase]) => {
    const x = scale.x(phase);
    return svg("line", { x1: x, x2: x, y1: TOP, y2: scale.base, class: "boundary" });
  });
}

function ribbon(intervals, scale) {
  return (intervals?.history.intervals ?? []).flatMap((interval) =>
    seen(interval.start, interval.end, scale.from, scale.span).map(([low, high]) => {
      const colour = CLASS_COLOURS[interval.formation.class] ?? UNDECIDED_COLOUR;
      const width = Math.max(scale.x(high) - scale.x(low), 0.5);
      return svg("rect", { x: scale.x(low), width, y: scale.base + 2, height: RIBBON - 2, fill: colour }, [
        svg("title", {}, interval.formation.text),
      ]);
    }),
  );
}

function snapMarks(intervals, scale, view) {
  return (intervals?.history.windows ?? [])
    .filter((window) => window.snap !== null)
    .flatMap(({ snap }) =>
      seen(snap.phase, snap.phase, scale.from, scale.span).map(([phase]) => {
        const x = scale.x(phase);
        const text = `snap at ${angle(snap.phase, 3)}: falls ${length(snap.fall, view.unit)}`;
        return svg("g", { class: "snap" }, [
          svg("line", { x1: x, x2: x, y1: scale.y(snap.height_before), y2: scale.y(snap.height_after) }),
          svg("text", { x: scale.right, y: TOP - 11, "text-anchor": "end" }, text),
        ]);
      }),
    );
}

function key() {
  const entry = (x, name, text) => [
    svg("line", { x1: x, x2: x + 22, y1: TOP - 15, y2: TOP - 15, class: `curve ${name}` }),
    svg("text", { x: x + 27, y: TOP - 11 }, text),
  ];
  return [...entry(LEFT + 6, "first", "first contact"), ...entry(LEFT + 122, "last", "at rest")];
}
