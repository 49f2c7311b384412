// Round numbers along an axis.

const MANTISSAS = [1, 2, 2.5, 5, 10];
const FINEST_TURN = 4;
const TURN_STEPS = [90, 60, 45, 30, 20, 15, 10, 5, 2, 1];

/** Round numbers from low to high, at most `most` of them. */
export function ticks(low, high, most) {
  const raw = (high - low) / most;
  const decade = 10 ** Math.floor(Math.log10(raw));
  const step = decade * MANTISSAS.find((mantissa) => mantissa * decade >= raw * (1 - 1e-9));
  return multiples(low, high, step);
}

/** Round angles in degrees from low to high, at most `most` of them: parts of a turn, or decimals of a degree. */
export function angleTicks(low, high, most) {
  if (high - low < FINEST_TURN) return ticks(low, high, most);
  return multiples(low, high, TURN_STEPS.filter((step) => (high - low) / step <= most).at(-1));
}

/** How many decimals the difference of neighbouring ticks needs. */
export function decimalsOf(values) {
  if (values.length < 2) return 0;
  const step = Math.abs(values[1] - values[0]);
  for (let decimals = 0; decimals < 12; decimals++) {
    const scaled = step * 10 ** decimals;
    if (Math.abs(scaled - Math.round(scaled)) < 1e-6 * scaled) return decimals;
  }
  return 12;
}

function multiples(low, high, step) {
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + step * 1e-9; k++) found.push(k * step + 0);
  return found;
}
