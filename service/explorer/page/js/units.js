// Numbers, lengths and angles as text.

const MINUS = "−";

/** Decimals with which lengths are shown, by unit: a ten-thousandth of a thread pitch or so. */
const LENGTH_DECIMALS = { in: 6, mm: 5 };
/** Decimals of lengths in a sentence. */
const SHORT_DECIMALS = { in: 4, mm: 3 };
/** Round-off of a thread's lengths is some 1e-17: what is less than this is shown as zero. */
const ROUND_OFF = 1e-13;

const MILLIMETRES = { in: 25.4, mm: 1 };

/** By what a length in one unit is multiplied to be in another. */
export function unitFactor(from, to) {
  return MILLIMETRES[from] / MILLIMETRES[to];
}

/** A number with so many decimals, with a true minus sign; "none" for null. */
export function fixed(value, decimals) {
  if (value === null || value === undefined) return "none";
  const text = Math.abs(value).toFixed(decimals);
  return value < 0 && Number(text) !== 0 ? MINUS + text : text;
}

/** A length with its unit. */
export function length(value, unit) {
  if (value === null || value === undefined) return "none";
  return `${lengthNumber(value, unit)} ${unit}`;
}

/** A length without its unit; what would round to nothing is given as a power of ten, and round-off as zero. */
export function lengthNumber(value, unit) {
  return writtenLength(value, LENGTH_DECIMALS[unit]);
}

/** A length for a sentence, without its unit. */
export function shortLength(value, unit) {
  return writtenLength(value, SHORT_DECIMALS[unit]);
}

function writtenLength(value, decimals) {
  if (Math.abs(value) < ROUND_OFF) return fixed(0, decimals);
  if (value !== 0 && Math.abs(value) < 0.5 * 10 ** -decimals) return power(value);
  return fixed(value, decimals);
}

/** An angle in degrees, with its unit; trailing zeros left out. */
export function angle(value, decimals = 6) {
  return value === null || value === undefined ? "none" : `${angleNumber(value, decimals)} deg`;
}

/** An angle without its unit; trailing zeros left out. */
export function angleNumber(value, decimals = 6) {
  const text = fixed(value, decimals);
  return text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

/** A share as a percentage. */
export function percent(share) {
  const value = share * 100;
  if (value > 0 && value < 0.1) return "< 0.1 %";
  return `${value >= 10 ? value.toFixed(0) : value.toFixed(1)} %`;
}

function power(value) {
  return value.toExponential(1).replaceAll("-", MINUS);
}

/** The number of a text in decimals; NaN of any other, also of what JavaScript would read (0x10, blanks). */
export function parseDecimal(text) {
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text) ? Number(text) : NaN;
}

/** An angle wrapped to 0 <= angle < 360. */
export function wrapAngle(degrees) {
  const rest = degrees % 360;
  return rest < 0 ? rest + 360 : rest + 0;
}
