// The tab of success maps: where a device assembles the pair, cell by cell, and beside another device.

import { CHOICES, NUMBERS, isSameRequest, labelOf } from "./assembly.js";
import { textColourOn } from "./colours.js";
import { tilts } from "./grid.js";
import { byId, html } from "./html.js";
import { OUTCOMES, PHASE_COUNTS, cellOf, isWhole, keyOf, mapRequestOf, mapText, orientationsOf, pathText, placeOf, storedMapText } from "./success_map.js";
import { OF_MAP, criticalsWords, deviceWords, mapNameWords, mapWords, placeWords } from "./success_words.js";
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

/** How far in from its corner the mark of a square goes that ends otherwise in the kept map. */
const CORNER = 9;

/** The panel; `map` is called with a map's text, `keep` with whether one is kept, `play` with the text of a path and the pose where it starts. */
export class SuccessView {
  #actions;
  #request;
  /** The text of the map that the fields are of. */
  #filled = "";
  #model = null;
  #view = null;
  /** The stored maps that are listed, and the unit of their devices. */
  #listed = { maps: null, unit: null };

  constructor({ map, cancel, keep, play, findCritical, requestOfDevice, fillDevice }) {
    this.#actions = { play, fillDevice };
    this.#request = requestOfDevice;
    byId("success-phases").replaceChildren(...PHASE_COUNTS.map((count) => html("option", { value: count }, String(count))));
    byId("success-form").addEventListener("submit", (event) => {
      event.preventDefault();
      this.#filled = this.#askedText();
      map(this.#filled);
    });
    byId("success-stored").addEventListener("change", () => map(byId("success-stored").value));
    byId("success-cancel").addEventListener("click", cancel);
    byId("success-keep").addEventListener("click", () => keep(true));
    byId("success-drop").addEventListener("click", () => keep(false));
    byId("success-critical-find").addEventListener("click", () => findCritical(this.#chosen));
  }

  /** Takes over what a view asks for: the fields, those of the device too, are of its map. */
  show({ success, tab, assembly }) {
    if (success === this.#filled) return;
    this.#filled = success;
    if (success === "") return;
    const { stored, phases, request } = mapRequestOf(success);
    if (stored === null) byId("success-phases").value = phases;
    byId("success-mu").value = request.mu;
    // Beside a path that is seen the fields are of that.
    if (tab !== "device" || assembly === "") this.#actions.fillDevice(request);
  }

  /** The text of the map that the fields ask for. */
  #askedText() {
    return mapText(byId("success-phases").value, { ...this.#request(), mu: byId("success-mu").value.trim() });
  }

  /** The orientation that the view has chosen, {roll, pitch}; null where none is. */
  get #chosen() {
    return placeOf(this.#view.success_at);
  }

  /** Draws what is known of both maps. */
  draw(model, view) {
    this.#model = model;
    this.#view = view;
    const { value } = model.success;
    const kept = model.keptSuccess.value;
    const isRunning = value?.isRunning ?? false;
    this.#listStored(model.storedMaps, view);
    byId("success-cancel").disabled = !model.success.isRunning;
    byId("success-keep").disabled = value === null || value.cells.size === 0 || isRunning;
    byId("success-drop").hidden = kept === null;
    byId("success-progress").hidden = !isRunning;
    if (isRunning) byId("success-bar").max = tilts(value.grid).length ** 2 * mapRequestOf(value.text).phases;
    if (isRunning) byId("success-bar").value = [...value.cells.values()].flat().length;
    byId("success-problem").replaceChildren(...problemsOf(value, view.unit));
    byId("success-text").textContent = value === null || value.cells.size === 0 ? "" : mapWords(value, view.unit);
    this.#drawMap(byId("success"), value, kept);
    this.#drawMap(byId("success-kept"), kept, null);
    byId("success-device").textContent = value === null ? "" : mapNameWords(value.text, view.unit);
    byId("success-stale").hidden = value === null || isOfDevice(value.text, this.#askedText());
    byId("success-kept-text").textContent = kept === null ? "" : keptWords(kept, value, view.unit);
    this.#showCell(value, view);
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

  /** Draws a map; the main one marks where the map beside it ends otherwise. */
  #drawMap(frame, map, beside) {
    const isMain = frame.id === "success";
    if (map === null) {
      frame.replaceChildren();
      return;
    }
    const hadFocus = frame.contains(document.activeElement);
    const angles = tilts(map.grid);
    const size = angles.length * SIDE;
    const name = isMain ? "Success map" : "Success map that is kept";
    const root = picture(Math.max(LEFT + size + 4, LEGEND_WIDTH), size + BELOW + 46, name, { class: "map success-map", role: "group" });
    root.append(svg("defs", {}, svg("pattern", { id: `hatch-${frame.id}`, width: 6, height: 6, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" }, [
      svg("rect", { width: 6, height: 6, fill: "#e8e8e8" }),
      svg("rect", { width: 2, height: 6, fill: "#9a9a9a" }),
    ])));
    const cells = svg("g", { role: "grid", "aria-label": "orientations by pitch and roll" });
    const isThere = this.#chosen !== null && [this.#chosen.roll, this.#chosen.pitch].every((tilt) => angles.includes(tilt));
    const stop = isThere ? this.#chosen : { roll: 0, pitch: 0 };
    [...angles].reverse().forEach((pitch, row) => {
      const line = svg("g", { role: "row" });
      angles.forEach((roll, column) => line.append(this.#cell(map, { roll, pitch }, LEFT + column * SIDE, row * SIDE + 2, { isMain, beside, hatch: `url(#hatch-${frame.id})`, stop })));
      cells.append(line);
    });
    if (isMain) cells.addEventListener("keydown", (event) => this.#step(event, angles));
    root.append(cells, ...axesOf(angles, size), ...legendOf(size, `url(#hatch-${frame.id})`, map));
    frame.replaceChildren(root);
    if (hadFocus) frame.querySelector('.cell[tabindex="0"]')?.focus();
  }

  #cell(map, place, x, y, { isMain, beside, hatch, stop }) {
    const outcomes = map.cells.get(keyOf(place));
    const isPartial = outcomes !== undefined && !isWhole(map, outcomes);
    const change = changeOf(map, beside, place);
    const words = `${cellWords(place, outcomes, isPartial)}${change === 0 ? "" : change > 0 ? "; does not engage in the kept map" : "; engages in the kept map"}`;
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
    if (change !== 0) element.append(svg("path", { class: "changed", d: `M${x + SIDE - 1} ${y + 1}v${CORNER}l${-CORNER} ${-CORNER}z` }));
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
    const start = { ...place, phase: cellOf(outcomes).worst.phase };
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

  #showCell(map, { unit }) {
    const outcomes = this.#chosen === null ? undefined : map?.cells.get(keyOf(this.#chosen));
    byId("success-critical-find").disabled = outcomes === undefined;
    byId("success-cell").replaceChildren(...(outcomes === undefined ? [] : [cellTable(this.#chosen, outcomes, unitFactor(map.unit, unit), unit)]));
    byId("success-critical").textContent = map === null ? "" : criticalsWords(map);
  }
}

/** A stored map at a friction in one line. */
function storedOption(map, mu, unit) {
  const text = storedMapText(map, mu);
  const phases = Math.round(360 / map.grid.phase_step);
  const device = text === null ? `a device with a whole matrix, which the page has no fields for; ${CHOICES.strategy.values[map.strategy]}` : deviceWords(text, unit);
  return html("option", { value: text ?? "", disabled: text === null }, `${map.id}: μ ${mu}, ${phases} ${phases > 1 ? "phases" : "phase"}, ${device}`);
}

/** Whether a map is of the device and the strategy that another text asks for. */
function isOfDevice(text, asked) {
  return isSameRequest(mapRequestOf(text).request, mapRequestOf(asked).request, OF_MAP);
}

/** Whether all paths from a place engage here and not in the map beside it (1), there and not here (-1), or neither is known (0). */
function changeOf(map, beside, place) {
  const engages = [map, beside].map((one) => {
    const outcomes = one?.cells.get(keyOf(place));
    return outcomes !== undefined && isWhole(one, outcomes) ? outcomes.every(({ outcome }) => outcome === "engaged") : null;
  });
  return engages.includes(null) ? 0 : Number(engages[0]) - Number(engages[1]);
}

function problemsOf(map, unit) {
  if (map === null || map.problem === null) return [];
  const named = map.errors.map(({ location, value, valid }) => {
    const name = Object.keys(NUMBERS).find((one) => location.split(" ").includes(one));
    return `${name ? labelOf(name, unit) : location} is ${value}; valid: ${valid}`;
  });
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

function cellWords(place, outcomes, isPartial) {
  if (outcomes === undefined) return `${placeWords(place)}: not computed yet`;
  if (isPartial) return `${cellWords(place, outcomes, false)}, from phase ${outcomes.map(({ phase }) => angle(phase)).join(", ")} so far`;
  const { count, engaged, worst } = cellOf(outcomes);
  if (engaged === count) return `${placeWords(place)}: engages${count > 1 ? ` from all ${count} phases` : ""}`;
  return `${placeWords(place)}: ${OUTCOMES[worst.outcome].name} from phase ${angle(worst.phase)}${count > 1 ? `; ${engaged} of ${count} engage` : ""}`;
}

function keptWords(kept, map, unit) {
  const words = ["Kept for comparison:", `${mapNameWords(kept.text, unit)}:`, mapWords(kept, unit), criticalsWords(kept)].filter((one) => one !== "").join(" ");
  if (map === null) return words;
  const changes = orientationsOf(kept.grid).map((place) => changeOf(map, kept, place));
  const count = (change) => changes.filter((one) => one === change).length;
  return `${words} Beside it the other map engages at ${count(1)} more and ${count(-1)} fewer: squares with a mark.`;
}

function cellTable(place, outcomes, factor, unit) {
  const head = ["phase", "outcome", `torque (N ${unit})`, "tilt (deg)", `shift (${unit})`];
  const number = (value, digits) => (value === null ? "" : fixed(value, digits));
  const rows = outcomes.map(({ phase, outcome, flags, bounded, torque, tilt, shift }) => [
    angleNumber(phase), [OUTCOMES[outcome].name, ...flags, ...(bounded ? ["not followed to its end"] : [])].join(", "),
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

function legendOf(size, hatch, map) {
  const entries = [[NONE_ENGAGES, "none", 52], [SHADES[1], "some", 56], [SHADES[3], "all engage", 86], [hatch, "undecided", 80]];
  let x = LEFT;
  const found = new Set([...map.cells.values()].flat().map(({ outcome }) => outcome));
  const signs = Object.keys(OUTCOMES).filter((name) => found.has(name)).map((name) => `${OUTCOMES[name].letter} ${OUTCOMES[name].name}`);
  return [...entries.flatMap(([fill, text, width]) => {
    const at = x;
    x += width;
    return [svg("rect", { x: at, y: size + 42, width: 13, height: 13, fill }), svg("text", { x: at + 17, y: size + 53 }, text)];
  }), svg("text", { x: LEFT, y: size + 72 }, signs.join("   "))];
}
