// What success maps say, in words.

import { CHOICES, NUMBERS, labelOf } from "./assembly.js";
import { OUTCOMES, lateSnapsOf, mapRequestOf, totalsOf } from "./success_map.js";
import { angle, fixed, unitFactor } from "./units.js";

/** What of a request a map has for all its paths, but the friction. */
export const OF_MAP = [...Object.keys(NUMBERS), ...Object.keys(CHOICES)].filter((name) => !["roll", "pitch", "phase", "mu", "confirm"].includes(name));

export function placeWords({ roll, pitch }) {
  return `roll ${angle(roll)}, pitch ${angle(pitch)}`;
}

function needsWords({ torque, tilt, shift }, factor, unit) {
  return `up to ${fixed(torque * factor, 3)} N ${unit} of torque, ${fixed(tilt, 2)} deg of tilt and ${fixed(shift * factor, 4)} ${unit} of shift`;
}

/** What a map says, in words. */
export function mapWords(map, unit) {
  const totals = totalsOf(map);
  const { request, phases } = mapRequestOf(map.text);
  const of = totals.done < totals.orientations ? `${totals.done} computed so far (of ${totals.orientations})` : `${totals.orientations} orientations`;
  const from = phases > 1 ? ` from each of ${phases} phases` : " from phase 0";
  if (totals.done === 0) return `From phase 0 alone ${map.cells.size} orientations are computed so far (of ${totals.orientations}): small squares.`;
  const open = totals.undecided > 0 ? `; ${totals.undecided} ${totals.undecided === 1 ? "is" : "are"} undecided` : "";
  const least = totals.failure === null ? "" : ` The least tilt that fails: ${placeWords(totals.failure)}, which ${OUTCOMES[totals.failure.worst.outcome].name}.`;
  const needs = totals.engaged > 0 ? ` Paths that engage ask for ${needsWords(totals, unitFactor(map.unit, unit), unit)}.` : "";
  return `Of ${of} ${totals.engaged} engage${from} at μ = ${request.mu === "" ? "0" : request.mu}${open}.${least}${needs}${lateSnapWords(map)}`;
}

function lateSnapWords(map) {
  const { paths, turn } = lateSnapsOf(map);
  if (paths === 0) return "";
  return ` ${paths} ${paths === 1 ? "path ends" : "paths end"} before a snap that others of ${paths === 1 ? "its orientation" : "their orientations"} meet: a ccw turn of ${Math.ceil(turn)} deg reaches ${paths === 1 ? "it" : "them"}.`;
}

/** What of a map's device differs from the default, in words. */
export function deviceWords(text, unit) {
  const { request } = mapRequestOf(text);
  const numbers = OF_MAP.filter((name) => Object.hasOwn(NUMBERS, name) && request[name] !== "");
  const given = numbers.map((name) => `${labelOf(name, request.unit)} ${request[name].replace("-", "−")}`);
  const strategy = CHOICES.strategy.values[request.strategy];
  return `${given.length > 0 ? given.join(", ") : "the default device"}; ${strategy}${given.length > 0 && request.unit !== unit ? ` (lengths in ${request.unit})` : ""}`;
}

/** Which map it is, in words. */
export function mapNameWords(text, unit) {
  const { stored } = mapRequestOf(text);
  return `${stored === null ? "" : `stored map ${stored}: `}${deviceWords(text, unit)}`;
}

/** The critical frictions that were asked for of a map, in words. */
export function criticalsWords({ criticals }) {
  return [...criticals.values()].map(criticalWords).join(" ");
}

/** A critical friction in words. */
export function criticalWords({ roll, pitch, last, first, outcome, isRunning, problem }) {
  const place = placeWords({ roll, pitch });
  if (problem) return `${place}: ${problem}`;
  if (isRunning) return `${place}: ${last === null ? "" : `engages at μ = ${last}, `}${first === null ? "" : `not at μ = ${first}, `}more so far …`;
  if (last === null && first === null) return "";
  if (last === null) return `${place}: ${OUTCOMES[outcome].name} even without friction.`;
  if (first === null) return `${place}: engages up to μ = ${last}, the largest that is tried.`;
  const certain = outcome === "undecided" ? "no certain answer at" : `${OUTCOMES[outcome].name} at`;
  return `${place}: engages up to μ = ${last}, ${certain} μ = ${first}.`;
}
