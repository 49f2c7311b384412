// The view in the browser's address, written when it has come to rest: browsers limit how often it may change.

import { fragmentOf, viewOf } from "./url_state.js";

const REST_MS = 200;

/** Keeps the address and a view the same; returns the address of exactly the present view. */
export function keepAddress(view) {
  let timer = null;
  const write = () => history.replaceState(null, "", `#${fragmentOf(view.value)}`);
  view.follow(() => {
    clearTimeout(timer);
    timer = setTimeout(write, REST_MS);
  });
  window.addEventListener("hashchange", () => view.set(viewOf(location.hash)));
  write();
  return () => `${location.origin}${location.pathname}#${fragmentOf(view.value)}`;
}
