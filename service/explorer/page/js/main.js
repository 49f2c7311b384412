// The page: what is chosen goes into the view, the model loads its data, and the pictures are drawn from both.

import { syncAddress } from "./address_bar.js";
import { Api, ProblemError } from "./api.js";
import { wireAxes } from "./axes.js";
import { Busy } from "./busy.js";
import { showComparison } from "./compare_view.js";
import { fitControls, showControls, showLibraries, wireControls } from "./controls.js";
import { wireHelp } from "./help.js";
import { byId } from "./html.js";
import { forgetKey, storeKey, storedKey } from "./api_key.js";
import { UNAUTHORIZED, hideErrorState, progressOf, showToast, showBusy, showExplorer, showErrorState, errorStateOf } from "./messages.js";
import { Model } from "./model.js";
import { Pictures } from "./pictures.js";
import { preferredUnit } from "./preferences.js";
import { wireSaving } from "./saving.js";
import { curlLine, pythonLines } from "./snippets.js";
import { showTab, wireTabs } from "./tabs.js";
import { readFragment } from "./url_state.js";
import { View } from "./view.js";

const RETRY_MS = 2000;
const NOT_FOUND = 404;

const linked = readFragment(location.hash);
const api = new Api(storedKey());
const view = new View({ unit: preferredUnit(), ...linked.view });
const model = new Model(api, new Busy(showBusy), partArrived, partFailed);
const pictures = new Pictures(api, model, view);
let inErrorState = false;

async function start() {
  document.documentElement.dataset.theme = view.value.theme;
  await model.open(view.value);
  view.set({ library: model.library.id, unit: model.library.unit });
  wireControls(view, () => model.library.grid);
  showLibraries({ all: [model.library], latest: null }, model.library);
  fitControls(model.library.grid);
  wireTabs(view);
  wireHelp();
  wireAxes();
  wireCopying(syncAddress(view, (remarks) => showToast(remarks.join(". "))));
  byId("forget-key").hidden = !api.hasKey;
  byId("forget-key").addEventListener("click", () => {
    forgetKey();
    location.reload();
  });
  wireSaving(model, view, () => pictures.scene);
  showControls(view.value);
  showTab(view.value);
  showExplorer();
  if (linked.remarks.length > 0) showToast(linked.remarks.join(". "));
  pictures.followSizes();
  view.follow((now, changed) => {
    showControls(now);
    if (changed.has("tab")) showTab(now);
    pictures.follow(changed);
    model.follow(now);
  });
  model.follow(view.value);
  pictures.begin();
}

/** Called with the name of a part of the model that has arrived. */
function partArrived(part) {
  if (part === "library") fitControls(model.library.grid);
  if (part === "libraries") showLibraries(model.libraries, model.library);
  if (part === "state") model.followLibraries();
  pictures.redraw(part);
  if (part === "library") model.follow(view.value);
  if (part === "libraries") {
    showControls(view.value);
    showComparison(view.value);
  }
}

/** Shows what is wrong, and retries until it is not. */
async function partFailed(error, part) {
  if (part === "library" && error instanceof ProblemError && error.status === NOT_FOUND) {
    showToast(error.message);
    view.set({ library: model.library.id }, "corrected");
    return;
  }
  if (inErrorState) return;
  inErrorState = true;
  const isOpen = error instanceof ProblemError && error.status !== UNAUTHORIZED;
  const errorState = errorStateOf(error, isOpen ? await fetchProgress() : [], model.library === null && view.value.library !== null);
  showErrorState({ ...errorState, refused: api.hasKey });
  if (errorState.kind === "fault") throw error;
  if (errorState.kind === "key") requestKey();
  else setTimeout(retry, RETRY_MS);
}

/** Removes a key that was refused, and continues with the one that is entered in the form. */
function requestKey() {
  forgetKey();
  api.use(null);
  byId("key-form").onsubmit = (event) => {
    event.preventDefault();
    const key = byId("key").value.trim();
    hideErrorState();
    storeKey(key);
    api.use(key);
    retry();
  };
}

function retry() {
  inErrorState = false;
  if (model.library === null) {
    start().catch(partFailed);
    return;
  }
  api.getFresh("/healthz").then(() => {
    showExplorer();
    model.retry(view.value);
    pictures.begin();
  }, partFailed);
}

async function fetchProgress() {
  try {
    const [{ building }, { jobs }] = await Promise.all([api.getFresh("/v1/building"), api.getFresh("/v1/jobs")]);
    return progressOf(building, jobs);
  } catch {
    return [];
  }
}

function wireCopying(address) {
  const copies = {
    "copy-link": ["The link is", address],
    "copy-json": ["The JSON is", () => JSON.stringify(model.state.state, null, 1)],
    "copy-curl": ["The curl line is", () => curlLine(location.origin, model.library, model.state, api.hasKey)],
    "copy-python": ["The Python lines are", () => pythonLines(location.origin, model.library, model.state, api.hasKey)],
  };
  for (const [id, [what, text]] of Object.entries(copies)) {
    byId(id).addEventListener("click", async () => {
      const content = text();
      try {
        await navigator.clipboard.writeText(content);
        showToast(`${what} on the clipboard.`);
      } catch {
        showToast(content);
      }
    });
  }
}

start().catch(partFailed);
