// Pictures and tables as files.

import { csvOf } from "./csv.js";

/** What the style sheets give to a picture and a file needs by itself. */
const STYLES = [
  "fill", "fill-opacity", "stroke", "stroke-width", "stroke-opacity", "stroke-dasharray", "stroke-linejoin",
  "font-family", "font-size", "font-weight", "opacity",
];
const PIXEL_RATIO = 2;
const MARGIN = 12;

/** Hands a file to the browser. */
export function saveFile(name, content, type) {
  const url = URL.createObjectURL(new Blob([content], { type }));
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

export function saveTable(name, rows) {
  saveFile(`${name}.csv`, csvOf(rows), "text/csv");
}

export function saveSvg(name, element) {
  saveFile(`${name}.svg`, svgText(element), "image/svg+xml");
}

export async function savePng(name, element) {
  saveFile(`${name}.png`, await pngOf(element), "image/png");
}

/** A picture of the page as an SVG file of its own: with its styles, a margin and the panel's ground. */
function svgText(element) {
  const copy = element.cloneNode(true);
  withStyles(element, copy);
  const { width, height } = element.viewBox.baseVal;
  const ground = document.createElementNS(copy.namespaceURI, "rect");
  const around = { x: -MARGIN, y: -MARGIN, width: width + 2 * MARGIN, height: height + 2 * MARGIN };
  for (const [key, value] of Object.entries(around)) ground.setAttribute(key, value);
  ground.setAttribute("fill", getComputedStyle(element.closest(".panel")).backgroundColor);
  copy.prepend(ground);
  copy.setAttribute("viewBox", Object.values(around).join(" "));
  copy.setAttribute("width", around.width);
  copy.setAttribute("height", around.height);
  return `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(copy)}\n`;
}

/** A picture of the page as PNG, twice as sharp as it is large. */
async function pngOf(element) {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svgText(element))}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = image.width * PIXEL_RATIO;
  canvas.height = image.height * PIXEL_RATIO;
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}

function withStyles(from, to) {
  const styles = getComputedStyle(from);
  for (const name of STYLES) to.setAttribute(name, styles.getPropertyValue(name));
  for (const name of ["class", "tabindex", "role", "aria-selected"]) to.removeAttribute(name);
  [...from.children].forEach((child, k) => withStyles(child, to.children[k]));
}
