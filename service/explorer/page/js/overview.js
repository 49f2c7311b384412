// Where each formation of the network stands: in rows by how far the bolt still has to be turned to the window.

/** Degrees of turning that share a row. */
const BAND_DEG = 15;
const CLASS_ORDER = ["unstable_two_point", "quasi_stable_two_point", "stable_three_point", null];
const WINDOW = -1;

/**
 * The bands of formations, the farthest from the window first: {title, lines}, where each line has at most `most`
 * formations. Those that occur nowhere but in the window are the last band; within a band they stand by class, then by turning.
 */
export function bandsOf(formations, most) {
  const bands = new Map();
  for (const formation of formations) {
    const band = bandOf(formation);
    if (!bands.has(band)) bands.set(band, []);
    bands.get(band).push(formation);
  }
  return [...bands.keys()].sort((a, b) => b - a).map((band) => ({
    title: titleOf(band),
    lines: linesOf(bands.get(band).sort(byClassAndTurning), most),
  }));
}

/** The keys of the formations along a path, without repeats in a row. */
export function formationsAlong(path) {
  const keys = (path?.steps ?? []).map(({ formation }) => formation);
  return keys.filter((key, k) => key !== keys[k - 1]);
}

function bandOf({ to_window: { least } }) {
  return least === null ? WINDOW : Math.min(Math.floor(least / BAND_DEG), 360 / BAND_DEG - 1);
}

function titleOf(band) {
  return band === WINDOW ? "within" : `${band * BAND_DEG}–${(band + 1) * BAND_DEG}`;
}

function byClassAndTurning(a, b) {
  const [first, second] = [a, b].map((one) => CLASS_ORDER.indexOf(one.class));
  return first - second || b.to_window.least - a.to_window.least || (a.key < b.key ? -1 : 1);
}

function linesOf(formations, most) {
  const lines = [];
  for (let k = 0; k < formations.length; k += most) lines.push(formations.slice(k, k + most));
  return lines;
}
