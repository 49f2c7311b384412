// The tab of success maps: where a device assembles the pair, cell by cell, and beside another device.

import { labelOf, NUMBERS, CHOICES } from "./assembly.js";
import { textColourOn } from "./colours.js";
import { tilts } from "./grid.js";
import { byId, html } from "./html.js";
import { OUTCOMES, PHASE_COUNTS, cellOf, isWhole, keyOf, mapRequestOf, mapText, pathText, storedMapText, totalsOf } from "./success_map.js";
import { picture, svg } from "./svg.js";
import { angle, angleNumber, fixed, unitFactor } from "./units.js";

const SIDE = 30;
const LEFT = 40;
const BELOW = 34;
const LEGEND_WIDTH = 330;
/** Of the square of an orientation from which some phases alone are computed. */
const PARTIAL_INSET = 8;
/** Up to a quarter of the starting phases that engage, a half, three quarters, and all. */
const SHADES = ["#bcd9e6", "#7db4d0", "#3f8fbf", "#0b5f99"];
const NONE_ENGAGES = "#f4e3d3";
const STEPS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** The panel; `map` and `keep` are called with a map's text, `play` with the text of a path and the pose where it starts. */
export class SuccessView {
  #actions;
  #request;
  /** The cell that was chosen, and the one that has the focus among all: {roll, pitch}. */
  #chosen = null;
  #model = null;
  #view = null;
  /** The stored maps that are listed, and the unit of their devices. */
  #listed = { maps: null, unit: null };

  constructor({ map, cancel, keep, play, findCritical, requestOfDevice }) {
    this.#actions = { play };
    this.#request = requestOfDevice;
    byId("success-phases").replaceChildren(...PHASE_COUNTS.map((count) => html("option", { value: count }, String(count))));
    byId("success-form").addEventListener("submit", (event) => {
      event.preventDefault();
      this.#chosen = null;
      map(mapText(byId("success-phases").value, { ...this.#request(), mu: byId("success-mu").value.trim() }));
    });
    byId("success-stored").addEventListener("change", () => {
      this.#chosen = null;
      map(byId("success-stored").value);
    });
    byId("success-cancel").addEventListener("click", cancel);
    byId("success-keep").addEventListener("click", () => keep(this.#model.success.value.text));
    byId("success-drop").addEventListener("click", () => keep(""));
    byId("success-critical-find").addEventListener("click", () => findCritical(this.#chosen));
  }

  /** Takes over what a view asks for. */
  show({ success }) {
    if (success === "") return;
    const { stored, phases, request } = mapRequestOf(success);
    if (stored === null) byId("success-phases").value = phases;
    byId("success-mu").value = request.mu;
  }

  /** Draws what is known of both maps. */
  draw(model, view) {
    this.#model = model;
    this.#view = view;
    const { value, critical } = model.success;
    const kept = model.keptSuccess.value;
    const isRunning = value?.isRunning ?? false;
    this.#listStored(model.storedMaps, view);
    byId("success-cancel").disabled = !isRunning;
    byId("success-keep").disabled = value === null || value.cells.size === 0;
    byId("success-drop").hidden = kept === null;
    byId("success-progress").hidden = !isRunning;
    if (isRunning) byId("success-bar").max = tilts(value.grid).length ** 2 * mapRequestOf(value.text).phases;
    if (isRunning) byId("success-bar").value = [...value.cells.values()].flat().length;
    byId("success-problem").replaceChildren(...problemsOf(value));
    byId("success-text").textContent = value === null || value.cells.size === 0 ? "" : mapWords(value, view.unit);
    this.#drawMap(byId("success"), value, true);
    this.#drawMap(byId("success-kept"), kept, false);
    byId("success-device").textContent = value === null ? "" : mapNameWords(value.text, view.unit);
    byId("success-kept-text").textContent = kept === null ? "" : keptWords(kept, value, view.unit);
    this.#showCell(value, critical, view);
  }

  /** Lists the stored maps of the pair, each at each of its frictions, and marks the one that is shown. */
  #listStored(maps, { success, unit }) {
    const select = byId("success-stored");
    byId("success-stored-field").hidden = maps === null || maps.length === 0;
    if (maps === null) return;
    if (this.#listed.maps !== maps || this.#listed.unit !== unit) {
      this.#listed = { maps, unit };
      select.replaceChildren(html("option", { value: "" }, "none"), ...maps.flatMap((one) => one.mu.map((mu) => storedOption(one, mu, unit))));
    }
    select.value = [...select.options].some(({ value }) => value === success) ? success : "";
  }

  #drawMap(frame, map, isMain) {
    if (map === null) {
      frame.replaceChildren();
      return;
    }
    const hadFocus = frame.contains(document.activeElement);
    const angles = tilts(map.grid);
    const size = angles.length * SIDE;
    const name = isMain ? "Success map" : "Success map that is kept";
    const root = picture(Math.max(LEFT + size + 4, LEGEND_WIDTH), size + BELOW + 30, name, { class: "map success-map", role: "group" });
    root.append(svg("defs", {}, svg("pattern", { id: `hatch-${frame.id}`, width: 6, height: 6, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" }, [
      svg("rect", { width: 6, height: 6, fill: "#e8e8e8" }),
      svg("rect", { width: 2, height: 6, fill: "#9a9a9a" }),
    ])));
    const cells = svg("g", { role: "grid", "aria-label": "orientations by pitch and roll" });
    const stop = this.#chosen ?? { roll: 0, pitch: 0 };
    [...angles].reverse().forEach((pitch, row) => {
      const line = svg("g", { role: "row" });
      angles.forEach((roll, column) => line.append(this.#cell(map, { roll, pitch }, LEFT + column * SIDE, row * SIDE + 2, { isMain, hatch: `url(#hatch-${frame.id})`, stop })));
      cells.append(line);
    });
    if (isMain) cells.addEventListener("keydown", (event) => this.#step(event, angles));
    root.append(cells, ...axesOf(angles, size), ...legendOf(size, `url(#hatch-${frame.id})`));
    frame.replaceChildren(root);
    if (hadFocus) frame.querySelector('.cell[tabindex="0"]')?.focus();
  }

  #cell(map, place, x, y, { isMain, hatch, stop }) {
    const outcomes = map.cells.get(keyOf(place));
    const isPartial = outcomes !== undefined && !isWhole(map, outcomes);
    const words = cellWords(place, outcomes, isPartial);
    const isStop = isMain && stop.roll === place.roll && stop.pitch === place.pitch;
    const element = svg("g", {
      role: "gridcell", class: isMain && this.#chosen !== null && isStop ? "cell chosen" : "cell", tabindex: isStop ? 0 : -1, "aria-label": words, "data-roll": place.roll, "data-pitch": place.pitch,
      "aria-selected": isMain && this.#chosen !== null && isStop,
    });
    const look = lookOf(outcomes, hatch);
    const inset = isPartial ? PARTIAL_INSET : 0.75;
    const box = { x: x + inset, y: y + inset, width: SIDE - 2 * inset, height: SIDE - 2 * inset };
    const kind = look.fill === null ? "none" : isPartial ? "partial" : null;
    element.append(svg("rect", { ...box, fill: look.fill, class: kind }), svg("title", {}, words));
    if (look.text !== "" && !isPartial) element.append(svg("text", { x: x + SIDE / 2, y: y + SIDE / 2 + 4.5, "text-anchor": "middle", fill: look.ink }, look.text));
    if (isMain) {
      const frame = { x: x + 2, y: y + 2, width: SIDE - 4, height: SIDE - 4 };
      element.append(svg("rect", { ...frame, class: "frame-out" }), svg("rect", { ...frame, class: "frame-in" }));
    }
    element.addEventListener("click", () => this.#choose(map, place));
    return element;
  }

  #choose(map, place) {
    const outcomes = map.cells.get(keyOf(place));
    if (outcomes === undefined) return;
    this.#chosen = place;
    const start = { ...place, phase: cellOf(outcomes).worst.phase };
    this.draw(this.#model, this.#view);
    this.#actions.play(pathText(map.text, start), start);
  }

  #step(event, angles) {
    const from = this.#chosen ?? { roll: 0, pitch: 0 };
    const focused = event.target.closest(".cell");
    const at = focused === null ? from : { roll: Number(focused.dataset.roll), pitch: Number(focused.dataset.pitch) };
    if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      this.#choose(this.#model.success.value, at);
      return;
    }
    const step = STEPS[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const moved = (value, by) => angles[Math.min(Math.max(angles.indexOf(value) + by, 0), angles.length - 1)];
    const next = { roll: moved(at.roll, step[0]), pitch: moved(at.pitch, step[1]) };
    const cell = byId("success").querySelector(`.cell[data-roll="${next.roll}"][data-pitch="${next.pitch}"]`);
    focused.setAttribute("tabindex", -1);
    cell.setAttribute("tabindex", 0);
    cell.focus();
  }

  #showCell(map, critical, { unit }) {
    const outcomes = this.#chosen === null ? undefined : map?.cells.get(keyOf(this.#chosen));
    byId("success-critical-find").disabled = outcomes === undefined || (critical?.isRunning ?? false);
    byId("success-cell").replaceChildren(...(outcomes === undefined ? [] : [cellTable(this.#chosen, outcomes, unitFactor(map.unit, unit), unit)]));
    byId("success-critical").textContent = critical === null ? "" : criticalWords(critical);
  }
}

/** A stored map at a friction in one line. */
function storedOption(map, mu, unit) {
  const text = storedMapText(map, mu);
  const phases = Math.round(360 / map.grid.phase_step);
  const device = text === null ? `a device with a whole matrix, which the page has no fields for; ${CHOICES.strategy.values[map.strategy]}` : deviceWords(text, unit);
  return html("option", { value: text ?? "", disabled: text === null }, `${map.id}: μ ${mu}, ${phases} ${phases > 1 ? "phases" : "phase"}, ${device}`);
}

function problemsOf(map) {
  if (map === null || map.problem === null) return [];
  const named = map.errors.map(({ location, value, valid }) => `${location} is ${value}; valid: ${valid}`);
  return (named.length > 0 ? named : [map.problem]).map((text) => html("li", {}, text));
}

function lookOf(outcomes, hatch) {
  if (outcomes === undefined) return { fill: null, text: "", ink: null };
  const { count, engaged, undecided, worst } = cellOf(outcomes);
  const shade = engaged === 0 ? NONE_ENGAGES : SHADES[Math.ceil((4 * engaged) / count) - 1];
  const fill = engaged < count && engaged + undecided === count ? hatch : shade;
  const text = count > 1 && engaged < count ? String(engaged) : OUTCOMES[worst.outcome].letter;
  return { fill, text, ink: fill === hatch ? "#000000" : textColourOn(fill) };
}

function placeWords({ roll, pitch }) {
  return `roll ${angle(roll)}, pitch ${angle(pitch)}`;
}

function cellWords(place, outcomes, isPartial) {
  if (outcomes === undefined) return `${placeWords(place)}: not computed yet`;
  if (isPartial) return `${cellWords(place, outcomes, false)}, from phase ${outcomes.map(({ phase }) => angle(phase)).join(", ")} so far`;
  const { count, engaged, worst } = cellOf(outcomes);
  if (engaged === count) return `${placeWords(place)}: engages${count > 1 ? ` from all ${count} phases` : ""}`;
  return `${placeWords(place)}: ${OUTCOMES[worst.outcome].name} from phase ${angle(worst.phase)}${count > 1 ? `; ${engaged} of ${count} engage` : ""}`;
}

function needsWords({ torque, tilt, shift }, factor, unit) {
  return `up to ${fixed(torque * factor, 3)} N ${unit} of torque, ${fixed(tilt, 2)} deg of tilt and ${fixed(shift * factor, 4)} ${unit} of shift`;
}

/** What a map says, in words. */
export function mapWords(map, unit) {
  const totals = totalsOf(map);
  const { request, phases } = mapRequestOf(map.text);
  const of = totals.done < totals.orientations ? `${totals.done} computed so far (of ${totals.orientations})` : `${totals.orientations} orientations`;
  const from = phases > 1 ? ` from each of ${phases} phases` : "";
  if (totals.done === 0) return `From phase 0 alone ${map.cells.size} orientations are computed so far (of ${totals.orientations}): small squares.`;
  const open = totals.undecided > 0 ? `; ${totals.undecided} are undecided` : "";
  const least = totals.failure === null ? "" : ` The least tilt that fails: ${placeWords(totals.failure)}, which ${OUTCOMES[totals.failure.worst.outcome].name}.`;
  const needs = totals.engaged > 0 ? ` Paths that engage ask for ${needsWords(totals, unitFactor(map.unit, unit), unit)}.` : "";
  return `Of ${of} ${totals.engaged} engage${from} at μ = ${request.mu === "" ? "0" : request.mu}${open}.${least}${needs}`;
}

/** What of a map's device differs from the default, in words. */
function deviceWords(text, unit) {
  const { request } = mapRequestOf(text);
  const numbers = Object.keys(NUMBERS).filter((name) => !["roll", "pitch", "phase", "mu"].includes(name) && request[name] !== "");
  const given = numbers.map((name) => `${labelOf(name, request.unit)} ${request[name]}`);
  const strategy = CHOICES.strategy.values[request.strategy];
  return `${given.length > 0 ? given.join(", ") : "the default device"}; ${strategy}${given.length > 0 && request.unit !== unit ? ` (lengths in ${request.unit})` : ""}`;
}

/** Which map it is, in words. */
function mapNameWords(text, unit) {
  const { stored } = mapRequestOf(text);
  return `${stored === null ? "" : `stored map ${stored}: `}${deviceWords(text, unit)}`;
}

function keptWords(kept, map, unit) {
  const words = `Kept for comparison: ${mapNameWords(kept.text, unit)}: ${mapWords(kept, unit)}`;
  if (map === null) return words;
  const whole = (one) => new Set([...one.cells].filter(([, outcomes]) => isWhole(one, outcomes) && outcomes.every(({ outcome }) => outcome === "engaged")).map(([key]) => key));
  const [here, there] = [whole(map), whole(kept)];
  const more = [...here].filter((key) => kept.cells.has(key) && !there.has(key)).length;
  const fewer = [...there].filter((key) => map.cells.has(key) && !here.has(key)).length;
  return `${words} Beside it the map above engages at ${more} more and ${fewer} fewer.`;
}

/** A critical friction in words. */
export function criticalWords({ roll, pitch, last, first, outcome, isRunning, problem }) {
  const place = placeWords({ roll, pitch });
  if (problem) return `${place}: ${problem}`;
  if (isRunning) return `${place}: between ${last ?? 0} and ${first ?? "…"} so far …`;
  if (last === null) return `${place}: ${OUTCOMES[outcome].name} even without friction.`;
  if (first === null) return `${place}: engages up to μ = ${last}, the largest that is tried.`;
  const certain = outcome === "undecided" ? "no certain answer at" : `${OUTCOMES[outcome].name} at`;
  return `${place}: engages up to μ = ${last}, ${certain} μ = ${first}.`;
}

function cellTable(place, outcomes, factor, unit) {
  const head = ["phase", "outcome", `torque (N ${unit})`, "tilt (deg)", `shift (${unit})`];
  const number = (value, digits) => (value === null ? "" : fixed(value, digits));
  const rows = outcomes.map(({ phase, outcome, flags, torque, tilt, shift }) => [
    angleNumber(phase), [OUTCOMES[outcome].name, ...flags].join(", "),
    number(torque === null ? null : torque * factor, 3), number(tilt, 2), number(shift === null ? null : shift * factor, 4),
  ]);
  return html("table", {}, [
    html("caption", {}, `paths from ${placeWords(place)}`),
    html("thead", {}, html("tr", {}, head.map((text) => html("th", { scope: "col" }, text)))),
    html("tbody", {}, rows.map((cells) => html("tr", {}, cells.map((text) => html("td", {}, text))))),
  ]);
}

function axesOf(angles, size) {
  const every = Math.ceil(angles.length / 11);
  const marks = angles.flatMap((tilt, k) => (k % every !== (angles.length >> 1) % every ? [] : [
    svg("text", { x: LEFT + (k + 0.5) * SIDE, y: size + 16, "text-anchor": "middle" }, angleNumber(tilt)),
    svg("text", { x: LEFT - 6, y: size - (k + 0.5) * SIDE + 6, "text-anchor": "end" }, angleNumber(tilt)),
  ]));
  const [x, y] = [10, size / 2];
  return [
    ...marks,
    svg("text", { x: LEFT + size / 2, y: size + 31, "text-anchor": "middle", class: "title" }, "roll (deg)"),
    svg("text", { x, y, "text-anchor": "middle", class: "title", transform: `rotate(-90 ${x} ${y})` }, "pitch (deg)"),
  ];
}

function legendOf(size, hatch) {
  const entries = [[NONE_ENGAGES, "none", 52], [SHADES[1], "some", 56], [SHADES[3], "all engage", 86], [hatch, "undecided", 80]];
  let x = LEFT;
  return entries.flatMap(([fill, text, width]) => {
    const at = x;
    x += width;
    return [svg("rect", { x: at, y: size + 42, width: 13, height: 13, fill }), svg("text", { x: at + 17, y: size + 53 }, text)];
  });
}
