// Elements of the page.

/** An HTML element with attributes and children; a string among the children is text. */
export function html(name, attributes = {}, children = []) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === true) element.setAttribute(key, "");
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(key, value);
  }
  element.append(...[children].flat());
  return element;
}

/** The element of the page with that id. */
export function byId(id) {
  return document.getElementById(id);
}
