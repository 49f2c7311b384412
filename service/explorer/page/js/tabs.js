// The tabs beside the pictures: one panel is seen, its name is in the view.

import { byId } from "./html.js";

export const TABS = ["state", "load", "device", "success", "regions", "follows", "network", "locate", "poses", "threads"];

/** Lets the tabs set the view: by a click, and by arrows, Home and End. */
export function wireTabs(view) {
  for (const name of TABS) tabOf(name).addEventListener("click", () => view.set({ tab: name }));
  byId("skip").addEventListener("click", () => tabOf(view.value.tab).focus());
  byId("tabs").addEventListener("keydown", (event) => {
    const next = tabAfter(event.key, view.value.tab);
    if (next === null) return;
    event.preventDefault();
    view.set({ tab: next });
    tabOf(next).focus();
  });
}

/** The tab that a key leads to, or null where the key means nothing. */
export function tabAfter(key, tab) {
  const at = TABS.indexOf(tab);
  switch (key) {
    case "ArrowRight": return TABS[(at + 1) % TABS.length];
    case "ArrowLeft": return TABS[(at + TABS.length - 1) % TABS.length];
    case "Home": return TABS[0];
    case "End": return TABS.at(-1);
    default: return null;
  }
}

/** Shows the tab of a view. */
export function showTab({ tab }) {
  for (const name of TABS) {
    const chosen = name === tab;
    tabOf(name).setAttribute("aria-selected", chosen);
    tabOf(name).tabIndex = chosen ? 0 : -1;
    byId(`panel-${name}`).hidden = !chosen;
  }
}

function tabOf(name) {
  return byId(`tab-${name}`);
}
