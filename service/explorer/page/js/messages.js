// What the page says where there is nothing to explore: what is wrong, and what to do.

import { UnreachableError, ProblemError } from "./api.js";
import { byId, html } from "./html.js";

/** The database is not there yet, or not as this service expects it; the problem says how to fix it. */
const UNAVAILABLE = 503;
const NOT_FOUND = "urn:threadstate:problem:not-found";
export const UNAUTHORIZED = 401;
/** How long a toast is shown: so long, or as long as it takes to read. */
const LEAST_TOAST_MS = 4000;
const LETTER_MS = 70;

/**
 * Why the page cannot show a library: {kind, detail, building}; `building` is what progressOf lists, `named`
 * whether the view names a library.
 */
export function errorStateOf(error, building, named) {
  return { kind: kindOf(error, building, named), detail: error.message, building };
}

/**
 * What is being computed, of what the service says is building and of its jobs: {designation, done, orientations, waiting},
 * each library once. A job that no worker has begun is `waiting`.
 */
export function progressOf(building, jobs) {
  const begun = building.map(({ designation, done, orientations }) => ({ designation, done, orientations, waiting: false }));
  const waiting = jobs
    .filter(({ state, committed }) => state === "queued" && committed === 0)
    .map(({ designation, chunks }) => ({ designation, done: 0, orientations: chunks, waiting: true }));
  return [...begun, ...waiting];
}

function kindOf(error, building, named) {
  if (error instanceof UnreachableError) return "lost";
  if (!(error instanceof ProblemError)) return "fault";
  if (error.status === UNAUTHORIZED) return "key";
  if (error.status === UNAVAILABLE) return "empty";
  if (error.type !== NOT_FOUND) return "fault";
  if (named) return "unknown";
  return building.length > 0 ? "building" : "empty";
}

/** The message of the service, with its commands as code. */
function serviceMessage(detail) {
  const parts = detail.split("`").map((part, k) => (k % 2 === 1 ? html("code", {}, part) : part));
  return ["The service says: ", ...parts, "."];
}

const PAGES = {
  empty: ({ detail }) => [
    html("h2", {}, "There is no library to explore yet"),
    html("p", {}, serviceMessage(detail)),
    html("p", {}, ["Compute one with ", html("code", {}, "threadstate rebuild"), "; this page continues automatically when it is there."]),
  ],
  building: ({ building }) => [
    html("h2", {}, building.every(({ waiting }) => waiting) ? "The library is queued" : "The library is being computed"),
    ...building.map(({ designation, done, orientations, waiting }) =>
      html("div", {}, [
        html("p", {}, waiting ? [`${designation}: waits for a worker, `, html("code", {}, "threadstate worker")] : `${designation}: ${done} of ${orientations} orientations`),
        html("progress", { max: orientations, value: done, "aria-label": `progress of ${designation}` }),
      ]),
    ),
    html("p", {}, "This page continues automatically when it is there."),
  ],
  unknown: ({ detail }) => [
    html("h2", {}, "There is no such library here"),
    html("p", {}, serviceMessage(detail)),
    html("p", {}, ["The link may belong to another service. See ", html("a", { href: "/" }, "the latest one"), "."]),
  ],
  key: ({ detail, refused }) => [
    html("h2", {}, refused ? "This key is refused" : "This service needs an API key"),
    html("p", {}, serviceMessage(detail)),
    html("form", { id: "key-form" }, [
      html("label", { for: "key" }, "API key "),
      html("input", { id: "key", type: "password", autocomplete: "off", spellcheck: "false", required: true, placeholder: "ts_…" }),
      html("button", { type: "submit" }, "continue"),
    ]),
    html("p", { class: "note" }, [
      "The operator of the service creates one with ", html("code", {}, "threadstate key create"),
      ". It is stored in this tab until the tab is closed, and is sent in a header, never in an address.",
    ]),
  ],
  lost: () => [
    html("h2", {}, "The service does not answer"),
    html("p", {}, "It may have been stopped, or the network is down."),
    html("p", {}, "This page retries automatically, and your view stays as it is."),
  ],
  fault: ({ detail }) => [
    html("h2", {}, "Something went wrong"),
    html("p", {}, `${detail}.`),
    html("p", {}, [html("a", { href: "/" }, "Start again"), ", or see ", html("a", { href: "/docs" }, "the HTTP interface"), "."]),
  ],
};

/** Shows an error state in place of the explorer; where it is shown already, nothing changes. */
export function showErrorState(errorState) {
  const frame = byId("message");
  const shown = JSON.stringify(errorState);
  if (frame.dataset.shown === shown && !frame.hidden) return;
  frame.dataset.shown = shown;
  frame.replaceChildren(...PAGES[errorState.kind](errorState));
  frame.dataset.kind = errorState.kind;
  byId("explorer").hidden = true;
  frame.hidden = false;
  (frame.querySelector("input") ?? frame).focus();
}

/** Hides the error state, before the next attempt is known to succeed. */
export function hideErrorState() {
  byId("message").hidden = true;
}

/** Shows the explorer again. */
export function showExplorer() {
  hideErrorState();
  byId("explorer").hidden = false;
}

/** Shows a toast at the foot of the page. */
export function showToast(text) {
  const toast = byId("toast");
  toast.textContent = text;
  clearTimeout(Number(toast.dataset.timer));
  toast.dataset.timer = setTimeout(() => (toast.textContent = ""), Math.max(LEAST_TOAST_MS, text.length * LETTER_MS));
}

/** Shows what is being computed; nothing where nothing is. */
export function showBusy(texts) {
  byId("busy").hidden = texts.length === 0;
  byId("busy-text").textContent = texts.length === 0 ? "" : `${texts.join("; ")} …`;
}
