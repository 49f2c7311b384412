// The picture of the axes: what roll, pitch and phase turn about.

import { byId } from "./html.js";

/** Lets the buttons open and close the picture. */
export function wireAxes() {
  const dialog = byId("axes");
  byId("show-axes").addEventListener("click", () => dialog.showModal());
  byId("hide-axes").addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
}
