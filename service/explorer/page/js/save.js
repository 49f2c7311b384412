// Pictures and tables as files.

import { csvOf } from "./csv.js";

/** What the style sheets give to a picture and a file needs by itself. */
const STYLES = [
  "fill", "fill-opacity", "stroke", "stroke-width", "stroke-opacity", "stroke-dasharray", "stroke-linejoin",
  "font-family", "font-size", "font-weight", "opacity", "visibility",
];
const PIXEL_RATIO = 2;
const MARGIN = 12;
/** Height of a line of the caption, and about how wide a letter of it is. */
const CAPTION_LINE = 15;
const CAPTION_LETTER = 6.2;

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

/** Saves a picture, with a caption below it that says what it is of; an empty one: none. */
export function saveSvg(name, element, caption = "") {
  saveFile(`${name}.svg`, svgText(element, caption), "image/svg+xml");
}

export async function savePng(name, element, caption = "") {
  saveFile(`${name}.png`, await pngOf(element, caption), "image/png");
}

/** A picture of the page as an SVG file of its own: with its styles, a caption, a margin and the panel's ground. */
function svgText(element, caption) {
  const copy = element.cloneNode(true);
  withStyles(element, copy);
  const { width, height } = element.viewBox.baseVal;
  const lines = linesOf(caption, Math.floor(width / CAPTION_LETTER));
  const { fontFamily, color } = getComputedStyle(element.closest(".panel"));
  lines.forEach((line, k) => {
    const text = document.createElementNS(copy.namespaceURI, "text");
    for (const [key, value] of Object.entries({ x: 0, y: height + CAPTION_LINE * (k + 1), fill: color, "font-family": fontFamily, "font-size": "11.5px" })) text.setAttribute(key, value);
    text.textContent = line;
    copy.append(text);
  });
  const ground = document.createElementNS(copy.namespaceURI, "rect");
  const around = { x: -MARGIN, y: -MARGIN, width: width + 2 * MARGIN, height: height + CAPTION_LINE * lines.length + 2 * MARGIN };
  for (const [key, value] of Object.entries(around)) ground.setAttribute(key, value);
  ground.setAttribute("fill", getComputedStyle(element.closest(".panel")).backgroundColor);
  copy.prepend(ground);
  copy.setAttribute("viewBox", Object.values(around).join(" "));
  copy.setAttribute("width", around.width);
  copy.setAttribute("height", around.height);
  return `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(copy)}\n`;
}

/** A picture of the page as PNG, twice as sharp as it is large. */
async function pngOf(element, caption) {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svgText(element, caption))}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = image.width * PIXEL_RATIO;
  canvas.height = image.height * PIXEL_RATIO;
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}

/** The words of a text in lines of so many letters at most. */
export function linesOf(text, letters) {
  const lines = [];
  for (const word of text.split(" ").filter((one) => one !== "")) {
    if (lines.length > 0 && lines.at(-1).length + 1 + word.length <= letters) lines[lines.length - 1] += ` ${word}`;
    else lines.push(word);
  }
  return lines;
}

function withStyles(from, to) {
  const styles = getComputedStyle(from);
  for (const name of STYLES) to.setAttribute(name, styles.getPropertyValue(name));
  for (const name of ["class", "tabindex", "role", "aria-selected"]) to.removeAttribute(name);
  [...from.children].forEach((child, k) => withStyles(child, to.children[k]));
}
