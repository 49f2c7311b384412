// The poses that a library holds, and those that can be requested.

import { wrapAngle } from "./units.js";

/** Roll and pitch go to this either way, in degrees. */
export const TILT_LIMIT = 10;
/** The largest tolerance on measured angles, in degrees. */
export const TOLERANCE_LIMIT = 2;

/** The values of roll, and of pitch, of a grid: -tilt_max to tilt_max. */
export function tilts(grid) {
  const steps = Math.round(grid.tilt_max / grid.tilt_step);
  return Array.from({ length: 2 * steps + 1 }, (_, k) => multiple(k - steps, grid.tilt_step));
}

/** Whether an orientation is one of a grid's. */
export function isOnGrid(grid, { roll, pitch }) {
  const angles = tilts(grid);
  return angles.includes(roll) && angles.includes(pitch);
}

/** The phase of the grid nearest to a phase. */
export function nearestPhase(grid, phase) {
  return wrapAngle(multiple(Math.round(wrapAngle(phase) / grid.phase_step), grid.phase_step));
}

/** The next phase of the grid in the sense of `steps`, so many steps on. */
export function steppedPhase(grid, phase, steps) {
  return wrapAngle(stepped(phase, grid.phase_step, steps));
}

/** The next multiple of the grid's step of tilt in the sense of `steps`, so many steps on; within what can be requested. */
export function steppedTilt(grid, tilt, steps) {
  return Math.min(Math.max(stepped(tilt, grid.tilt_step, steps), -TILT_LIMIT), TILT_LIMIT);
}

/** The tilt of the grid nearest to a tilt. */
export function nearestTilt(grid, tilt) {
  const bounded = Math.min(Math.max(tilt, -grid.tilt_max), grid.tilt_max);
  return multiple(Math.round(bounded / grid.tilt_step), grid.tilt_step);
}

/** A phase just after another one, with six decimals: exactly where a state changes the solver may decide no pose. */
export function justAfter(phase) {
  return wrapAngle((Math.ceil(phase * 1e6) + 1) / 1e6);
}

/** A grid in few words. */
export function gridText({ tilt_max: most, tilt_step: tilt, phase_step: phase }) {
  return `±${most} by ${tilt}°, phase by ${phase}°`;
}

function stepped(value, step, steps) {
  const at = value / step;
  const first = steps > 0 ? Math.floor(at + 1e-9) : Math.ceil(at - 1e-9);
  return multiple(first + steps, step);
}

/** So many steps as the decimal number that a reader would write: 0.3 and not 0.30000000000000004; a step is 0.01 at least. */
function multiple(count, step) {
  const [whole, fraction = ""] = String(step).split(".");
  const digits = BigInt(count) * BigInt(whole + fraction);
  return Number(`${digits}e-${fraction.length}`) + 0;
}
