// What the page says where there is nothing to explore: friendly, and with what to do.

import { LostError, ProblemError } from "./api.js";
import { byId, html } from "./html.js";

/** The database is not there yet, or not as this service expects it; the problem says what mends it. */
const UNAVAILABLE = 503;
const NOT_FOUND = "urn:threadstate:problem:not-found";

/**
 * What keeps the page from showing a library: {kind, detail, building}; `building` is as the service lists it, `named`
 * whether the view names a library.
 */
export function troubleOf(error, building, named) {
  return { kind: kindOf(error, building, named), detail: error.message, building };
}

function kindOf(error, building, named) {
  if (error instanceof LostError) return "lost";
  if (!(error instanceof ProblemError)) return "fault";
  if (error.status === UNAVAILABLE) return "empty";
  if (error.type !== NOT_FOUND) return "fault";
  if (named) return "unknown";
  return building.length > 0 ? "building" : "empty";
}

const PAGES = {
  empty: ({ detail }) => [
    html("h2", {}, "There is no library to explore yet"),
    html("p", {}, `The service says: ${detail}.`),
    html("p", {}, ["Compute one with ", html("code", {}, "threadstate rebuild"), "; this page goes on by itself when it is there."]),
  ],
  building: ({ building }) => [
    html("h2", {}, "The library is being computed"),
    ...building.map(({ designation, done, orientations }) =>
      html("p", {}, [
        `${designation}: ${done} of ${orientations} orientations `,
        html("progress", { max: orientations, value: done, "aria-label": `progress of ${designation}` }),
      ]),
    ),
    html("p", {}, "This page goes on by itself when it is there."),
  ],
  unknown: ({ detail }) => [
    html("h2", {}, "There is no such library here"),
    html("p", {}, `The service says: ${detail}.`),
    html("p", {}, ["The link may belong to another service. See ", html("a", { href: "/" }, "the latest one"), "."]),
  ],
  lost: ({ detail }) => [
    html("h2", {}, "The service does not answer"),
    html("p", {}, `It may have been stopped, or the network is down (${detail}).`),
    html("p", {}, "This page tries again by itself, and keeps your view."),
  ],
  fault: ({ detail }) => [
    html("h2", {}, "Something went wrong"),
    html("p", {}, `${detail}.`),
    html("p", {}, [html("a", { href: "/" }, "Begin anew"), ", or see ", html("a", { href: "/docs" }, "the HTTP interface"), "."]),
  ],
};

/** Shows a trouble in place of the explorer. */
export function showTrouble(trouble) {
  const frame = byId("message");
  frame.replaceChildren(...PAGES[trouble.kind](trouble));
  frame.dataset.kind = trouble.kind;
  byId("explorer").hidden = true;
  frame.hidden = false;
}

/** Shows the explorer again. */
export function showExplorer() {
  byId("message").hidden = true;
  byId("explorer").hidden = false;
}

/** Says something in passing, at the foot of the page. */
export function say(text) {
  const toast = byId("toast");
  toast.textContent = text;
  clearTimeout(Number(toast.dataset.timer));
  toast.dataset.timer = setTimeout(() => (toast.textContent = ""), 4000);
}
