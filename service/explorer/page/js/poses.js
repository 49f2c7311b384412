// Measured poses: read from a table that was pasted or opened, and written into the link.

import { TILT_LIMIT } from "./grid.js";
import { wrapAngle, parseDecimal } from "./units.js";

/** The most poses that are read. */
export const MOST_POSES = 500;
const ANGLES = ["roll", "pitch", "phase"];
const SEPARATORS = /[\s,;]+/;

/**
 * The poses of a table, {poses: [{roll, pitch, phase}], faults: [text]}: a pose a line, angles in degrees separated by commas,
 * semicolons, tabs or spaces. A first line with the names roll, pitch and phase gives their order; lines beginning with # and
 * columns that the names do not cover are left out. A phase is brought into the turn.
 */
export function posesOf(text) {
  const lines = text.split(/\r\n|\r|\n/).map((line, k) => ({ number: k + 1, cells: cellsOf(line) })).filter(({ cells }) => cells.length > 0);
  const names = lines[0]?.cells.map((cell) => cell.toLowerCase().replace(/_deg$/, "")).filter((cell) => !/^\W*(deg|°)\W*$/.test(cell)) ?? [];
  const named = ANGLES.every((name) => names.includes(name));
  const order = named ? ANGLES.map((name) => names.indexOf(name)) : [0, 1, 2];
  const poses = [];
  const faults = [];
  for (const { number, cells } of named ? lines.slice(1) : lines) {
    const fault = poseFault(order.map((place) => cells[place]));
    if (fault !== null) {
      faults.push(`line ${number}: ${fault}`);
      continue;
    }
    const [roll, pitch, phase] = order.map((place) => parseDecimal(cells[place]) + 0);
    poses.push({ roll, pitch, phase: wrapAngle(phase) });
  }
  if (poses.length > MOST_POSES) faults.push(`${poses.length} poses; the first ${MOST_POSES} are taken`);
  return { poses: poses.slice(0, MOST_POSES), faults };
}

/** Poses as a text without spaces; every number reads back the same. */
export function posesText(poses) {
  return poses.map(({ roll, pitch, phase }) => `${roll},${pitch},${phase}`).join(";");
}

/** The text if all of it is valid, or undefined. */
export function checkedPoses(text) {
  const { poses, faults } = posesOf(text.replaceAll(";", "\n"));
  return faults.length === 0 ? posesText(poses) : undefined;
}

/** The poses of a view. */
export function posesOfView({ poses }) {
  return posesOf(poses.replaceAll(";", "\n")).poses;
}

function cellsOf(line) {
  const text = line.trim();
  if (text === "" || text.startsWith("#")) return [];
  return text.split(SEPARATORS).filter((cell) => cell !== "").map((cell) => cell.replace(/^"(.*)"$/, "$1").replace("−", "-"));
}

function poseFault(cells) {
  for (const [k, name] of ANGLES.entries()) {
    const text = cells[k];
    if (text === undefined) return `there is no ${name}; a line has roll, pitch and phase in deg`;
    const value = parseDecimal(text);
    const most = name === "phase" ? Infinity : TILT_LIMIT;
    if (!Number.isFinite(value)) return `${name} is ${text}; valid: a number`;
    if (Math.abs(value) > most) return `${name} is ${text}; valid: ${-TILT_LIMIT} to ${TILT_LIMIT} deg`;
  }
  return null;
}
