// Depth against phase, and the intervals along it.

import { restHeight } from "./resting.js";
import { wrapAngle } from "./units.js";

/** Between two phases nearer than this a step of the height by more than that part of the thread's pitch is a jump. */
const JUMP_WITHIN_DEG = 1e-6;
const JUMP_IN_PITCHES = 1 / 2000;

/** Height of first contact of a state. */
export function firstHeight(state) {
  return state.poses[0].translation[2];
}

/** The heights of a history's states, in the form of the service's heights: for a library that has none of its own. */
export function heightsOf({ roll, pitch, states, undecided }) {
  const points = [
    ...states.map((state) => [state.phase, firstHeight(state), restHeight(state)]),
    ...undecided.map(({ phase }) => [phase, null, null]),
  ].sort(([a], [b]) => a - b);
  if (points.length > 0) points.push([360, points[0][1], points[0][2]]);
  const [phases, first, rest] = [0, 1, 2].map((k) => points.map((point) => point[k]));
  return { roll, pitch, phases, first_heights: first, rest_heights: rest };
}

/**
 * The curves of an orientation over one turn, `first` and `rest`: arrays of unbroken runs of {phase, height}, phases
 * ascending from 0 to 360. A run ends where a phase is undecided, where the bolt does not rest and where the height jumps.
 */
export function depthCurves({ phases, first_heights: first, rest_heights: rest }, threadPitch) {
  return { first: runs(phases, first, threadPitch), rest: rest ? runs(phases, rest, threadPitch) : [] };
}

/** The height of a curve at a phase, by straight lines; null where it has none. */
export function heightAt(found, phase) {
  for (const run of found) {
    const k = run.findIndex((point) => point.phase >= phase);
    if (k < 0 || (k === 0 && run[0].phase > phase)) continue;
    if (run[k].phase === phase) return run[k].height;
    const [a, b] = [run[k - 1], run[k]];
    return a.height + ((phase - a.phase) / (b.phase - a.phase)) * (b.height - a.height);
  }
  return null;
}

function runs(phases, heights, threadPitch) {
  const found = [[]];
  phases.forEach((phase, k) => {
    const height = heights[k];
    const before = found.at(-1).at(-1);
    const jumps = before && phase - before.phase < JUMP_WITHIN_DEG && Math.abs(height - before.height) > threadPitch * JUMP_IN_PITCHES;
    if (height === null || jumps) found.push([]);
    if (height !== null) found.at(-1).push({ phase, height });
  });
  return found.filter((run) => run.length > 1);
}

/** The interval that holds a phase, or null; its `start` and `end` are as in the answer, `inside` is its middle. */
export function intervalAt(intervals, phase) {
  for (const interval of intervals?.history.intervals ?? []) {
    for (const turns of [0, 360]) {
      if (interval.start <= phase + turns && phase + turns < interval.end) {
        return { ...interval, inside: wrapAngle((interval.start + interval.end) / 2) };
      }
    }
  }
  return null;
}

/** The keys of the formations that come next by turning from a phase, {ccw, cw}; null where none other comes. */
export function nextFormations(intervals, phase) {
  const cells = intervals?.history.intervals ?? [];
  const here = cells.findIndex(({ start, end }) => [0, 360].some((turn) => start <= phase + turn && phase + turn < end));
  const next = (step) => {
    for (let k = 1; here >= 0 && k < cells.length; k++) {
      const { key } = cells[(here + k * step + k * cells.length) % cells.length].formation;
      if (key !== cells[here].formation.key) return key;
    }
    return null;
  };
  return { ccw: next(1), cw: next(-1) };
}

/** Parts [low, high] of a stretch of phase, repeated every turn, that are visible in the range from `from` over `span`. */
export function visibleParts(start, end, from, span) {
  const found = [];
  const first = Math.floor((from - end) / 360);
  for (let turns = first; start + turns * 360 < from + span; turns++) {
    const low = Math.max(start + turns * 360, from);
    const high = Math.min(end + turns * 360, from + span);
    if (high >= low) found.push([low, high]);
  }
  return found;
}
