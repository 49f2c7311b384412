// Elements of SVG pictures.

const NAMESPACE = "http://www.w3.org/2000/svg";

/** An SVG element with attributes and children; a string among the children is text. */
export function svg(name, attributes = {}, children = []) {
  const element = document.createElementNS(NAMESPACE, name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== null && value !== undefined) element.setAttribute(key, value);
  }
  element.append(...[children].flat());
  return element;
}

/** The root of a picture of that size, which scales with its frame. */
export function picture(width, height, label, attributes = {}) {
  return svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": label, ...attributes });
}

/** Replaces the content of a frame. */
export function replaceContent(frame, ...elements) {
  frame.replaceChildren(...elements);
}

/** The point of a pointer's event in the coordinates of a picture. */
export function pointIn(root, event) {
  const matrix = root.getScreenCTM().inverse();
  return new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
}
