// Colours that colour-blind readers can distinguish (classes after Okabe and Ito, numbers after cividis).

export const CLASS_COLOURS = {
  stable_three_point: "#0072b2",
  quasi_stable_two_point: "#f2b92f",
  unstable_two_point: "#d55e00",
};
export const UNDECIDED_COLOUR = "#8a8a8a";

/** Positive sides are blue and negative ones orange, the lighter the nearer to the crest. */
export const REGION_COLOURS = {
  root: "#6f6f6f",
  root_fillet_pos: "#08306b",
  flank_pos: "#2f7fc1",
  crest_fillet_pos: "#9ecae9",
  crest: "#f7f2c4",
  crest_fillet_neg: "#fdc086",
  flank_neg: "#e0701a",
  root_fillet_neg: "#7f2704",
  surface: "#8fb59a",
  base: "#8fb59a",
};

/** Contacts of the three stages, in the scene and its legend. */
export const STAGE_COLOURS = ["#cc79a7", "#008860", "#f2b92f"];

const SCALE = [
  [0, 32, 76], [0, 42, 102], [34, 56, 112], [59, 73, 108], [80, 87, 109], [101, 103, 112], [122, 119, 120],
  [146, 137, 120], [170, 156, 115], [196, 176, 104], [223, 196, 86], [253, 220, 59],
];

/** The colour at a place of the scale, 0 (dark blue) to 1 (yellow). */
export function scaleColour(place) {
  const along = Math.min(Math.max(place, 0), 1) * (SCALE.length - 1);
  const low = Math.min(Math.floor(along), SCALE.length - 2);
  const mixed = SCALE[low].map((part, k) => Math.round(part + (SCALE[low + 1][k] - part) * (along - low)));
  return `#${mixed.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
}

/** Black or white, whichever has more contrast with a colour "#rrggbb". */
export function textColourOn(colour) {
  const [red, green, blue] = [1, 3, 5].map((k) => linear(parseInt(colour.slice(k, k + 2), 16) / 255));
  const luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  return luminance > 0.179 ? "#000000" : "#ffffff";
}

function linear(part) {
  return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
}
