// What the page says where there is nothing to explore: friendly, and with what to do.

import { LostError, ProblemError } from "./api.js";
import { byId, html } from "./html.js";

/** The database is not there yet, or not as this service expects it; the problem says what mends it. */
const UNAVAILABLE = 503;
const NOT_FOUND = "urn:threadstate:problem:not-found";
export const KEY_WANTED = 401;
/** How long something said in passing is seen: so long, or as long as it takes to read. */
const LEAST_TOAST_MS = 4000;
const LETTER_MS = 70;

/**
 * What keeps the page from showing a library: {kind, detail, building}; `building` is what progressOf lists, `named`
 * whether the view names a library.
 */
export function troubleOf(error, building, named) {
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
  if (error instanceof LostError) return "lost";
  if (!(error instanceof ProblemError)) return "fault";
  if (error.status === KEY_WANTED) return "key";
  if (error.status === UNAVAILABLE) return "empty";
  if (error.type !== NOT_FOUND) return "fault";
  if (named) return "unknown";
  return building.length > 0 ? "building" : "empty";
}

/** What the service says, with its commands as such. */
function said(detail) {
  const parts = detail.split("`").map((part, k) => (k % 2 === 1 ? html("code", {}, part) : part));
  return ["The service says: ", ...parts, "."];
}

const PAGES = {
  empty: ({ detail }) => [
    html("h2", {}, "There is no library to explore yet"),
    html("p", {}, said(detail)),
    html("p", {}, ["Compute one with ", html("code", {}, "threadstate rebuild"), "; this page goes on by itself when it is there."]),
  ],
  building: ({ building }) => [
    html("h2", {}, building.every(({ waiting }) => waiting) ? "The library is asked for" : "The library is being computed"),
    ...building.map(({ designation, done, orientations, waiting }) =>
      html("div", {}, [
        html("p", {}, waiting ? [`${designation}: waits for a worker, `, html("code", {}, "threadstate worker")] : `${designation}: ${done} of ${orientations} orientations`),
        html("progress", { max: orientations, value: done, "aria-label": `progress of ${designation}` }),
      ]),
    ),
    html("p", {}, "This page goes on by itself when it is there."),
  ],
  unknown: ({ detail }) => [
    html("h2", {}, "There is no such library here"),
    html("p", {}, said(detail)),
    html("p", {}, ["The link may belong to another service. See ", html("a", { href: "/" }, "the latest one"), "."]),
  ],
  key: ({ detail, refused }) => [
    html("h2", {}, refused ? "This key is refused" : "This service asks for a key"),
    html("p", {}, said(detail)),
    html("form", { id: "key-form" }, [
      html("label", { for: "key" }, "key for reading "),
      html("input", { id: "key", type: "password", autocomplete: "off", spellcheck: "false", required: true, placeholder: "ts_…" }),
      html("button", { type: "submit" }, "go on"),
    ]),
    html("p", { class: "note" }, [
      "Whoever runs the service makes one with ", html("code", {}, "threadstate key create"),
      ". It stays in this tab until the tab is closed, and goes into a header, never into an address.",
    ]),
  ],
  lost: () => [
    html("h2", {}, "The service does not answer"),
    html("p", {}, "It may have been stopped, or the network is down."),
    html("p", {}, "This page tries again by itself, and keeps your view."),
  ],
  fault: ({ detail }) => [
    html("h2", {}, "Something went wrong"),
    html("p", {}, `${detail}.`),
    html("p", {}, [html("a", { href: "/" }, "Start again"), ", or see ", html("a", { href: "/docs" }, "the HTTP interface"), "."]),
  ],
};

/** Shows a trouble in place of the explorer; where it is shown already, nothing moves. */
export function showTrouble(trouble) {
  const frame = byId("message");
  const told = JSON.stringify(trouble);
  if (frame.dataset.told === told && !frame.hidden) return;
  frame.dataset.told = told;
  frame.replaceChildren(...PAGES[trouble.kind](trouble));
  frame.dataset.kind = trouble.kind;
  byId("explorer").hidden = true;
  frame.hidden = false;
  (frame.querySelector("input") ?? frame).focus();
}

/** Takes a trouble away, before it is known whether all is well. */
export function hideTrouble() {
  byId("message").hidden = true;
}

/** Shows the explorer again. */
export function showExplorer() {
  hideTrouble();
  byId("explorer").hidden = false;
}

/** Says something in passing, at the foot of the page. */
export function say(text) {
  const toast = byId("toast");
  toast.textContent = text;
  clearTimeout(Number(toast.dataset.timer));
  toast.dataset.timer = setTimeout(() => (toast.textContent = ""), Math.max(LEAST_TOAST_MS, text.length * LETTER_MS));
}

/** Says what is being computed; nothing where nothing is. */
export function showBusy(texts) {
  byId("busy").hidden = texts.length === 0;
  byId("busy-text").textContent = texts.length === 0 ? "" : `${texts.join("; ")} …`;
}
