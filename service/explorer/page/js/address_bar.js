// The view in the browser's address and history. A jump to another place is an entry of the history, a gradual change is not.

import { fragmentOf, readFragment } from "./url_state.js";
import { DEFAULTS } from "./view.js";

/** Browsers limit how often the address may change. */
const REST_MS = 200;
/** Changes of the same kind that follow one another sooner are one step. */
const ONE_STEP_MS = 800;
const NO_STEP = { names: "", at: -Infinity };
const STEPS = ["library", "roll", "pitch", "tab"];

/** Whether a change of the view is a step of the browser's history. */
export function isStep(changed, how) {
  return how === "entry" || (how === null && STEPS.some((name) => changed.has(name)));
}

/** Keeps the address and a view in step; `remark` is called with what is not valid in an address. Returns the present address. */
export function syncAddress(view, remark) {
  let timer = null;
  let written = view.value;
  let last = NO_STEP;
  const addressOf = (value) => `#${fragmentOf(value)}`;
  const write = () => {
    clearTimeout(timer);
    timer = null;
    written = view.value;
    history.replaceState(null, "", addressOf(written));
  };
  view.follow((now, changed, how) => {
    if (how === "restored") {
      written = now;
      last = NO_STEP;
      return;
    }
    const names = [...changed].sort().join(" ");
    const goesOn = names === last.names && performance.now() - last.at < ONE_STEP_MS;
    if (isStep(changed, how)) last = { names, at: performance.now() };
    if (isStep(changed, how) && !goesOn) {
      // Gradual changes since the last step belong to that one.
      if (timer !== null) history.replaceState(null, "", addressOf(written));
      clearTimeout(timer);
      timer = null;
      history.pushState(null, "", addressOf(now));
    } else {
      clearTimeout(timer);
      timer = setTimeout(write, REST_MS);
    }
    written = now;
  });
  window.addEventListener("popstate", () => {
    clearTimeout(timer);
    timer = null;
    const { library, unit } = view.value;
    const { view: found, remarks } = readFragment(location.hash);
    view.set({ ...DEFAULTS, library, unit, ...found }, "restored");
    if (remarks.length > 0) {
      remark(remarks);
      write();
    }
  });
  write();
  return () => `${location.origin}${location.pathname}${addressOf(view.value)}`;
}
