// A line of help beside whatever has one, while the pointer or the focus is on it; Escape hides it.

import { byId } from "./html.js";

const APART = 6;

/** Shows the help of elements with `data-help`, now and later ones. */
export function wireHelp() {
  const shown = byId("help");
  let owner = null;

  const hide = () => {
    owner?.removeAttribute("aria-describedby");
    owner = null;
    shown.hidden = true;
  };
  const show = (event) => {
    const next = event.target.closest?.("[data-help]") ?? null;
    if (next === owner) return;
    hide();
    if (next === null) return;
    owner = next;
    owner.setAttribute("aria-describedby", shown.id);
    shown.textContent = owner.dataset.help;
    shown.hidden = false;
    place(shown, owner.getBoundingClientRect());
  };
  document.addEventListener("pointerover", show);
  document.addEventListener("focusin", show);
  document.addEventListener("focusout", hide);
  document.addEventListener("scroll", hide, true);
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") hide();
  });
}

/** Below what it is about, or above where there is no room; never beyond the edge of the window. */
function place(shown, { left, top, bottom }) {
  const { offsetWidth: width, offsetHeight: height } = shown;
  const below = bottom + APART + height <= innerHeight;
  shown.style.left = `${Math.max(APART, Math.min(left, innerWidth - width - APART))}px`;
  shown.style.top = `${below ? bottom + APART : Math.max(APART, top - APART - height)}px`;
}
