// A line of help beside whatever has one, while the pointer is on it or keys have led the focus there; Escape hides it.

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
  const show = (element) => {
    const next = element.closest?.("[data-help]") ?? null;
    if (next === owner) return;
    hide();
    if (next === null || next.dataset.help === "") return;
    owner = next;
    owner.setAttribute("aria-describedby", shown.id);
    shown.textContent = owner.dataset.help;
    shown.hidden = false;
    place(shown, owner.getBoundingClientRect());
  };
  document.addEventListener("pointerover", ({ target, pointerType }) => {
    if (pointerType !== "touch") show(target);
  });
  document.documentElement.addEventListener("pointerleave", hide);
  document.addEventListener("pointerdown", hide);
  // Touch has no hover: there a press of the button shows the help.
  document.addEventListener("click", ({ target }) => {
    const pressed = target.closest?.("button.help, button.term");
    if (pressed) show(pressed);
    else hide();
  });
  document.addEventListener("focusin", ({ target }) => {
    if (target.matches(":focus-visible")) show(target);
  });
  document.addEventListener("focusout", hide);
  document.addEventListener("scroll", hide, true);
  window.addEventListener("blur", hide);
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
