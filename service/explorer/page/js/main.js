// The page: what is chosen goes into the view, the model follows it, and the pictures are drawn of both.

import { keepAddress } from "./address_bar.js";
import { Api, ProblemError } from "./api.js";
import { wireAxes } from "./axes.js";
import { Busy } from "./busy.js";
import { showComparison } from "./compare_view.js";
import { fitControls, showControls, showLibraries, wireControls } from "./controls.js";
import { wireHelp } from "./help.js";
import { byId } from "./html.js";
import { forgetKey, keepKey, keptKey } from "./kept_key.js";
import { KEY_WANTED, hideTrouble, progressOf, say, showBusy, showExplorer, showTrouble, troubleOf } from "./messages.js";
import { Model } from "./model.js";
import { Pictures } from "./pictures.js";
import { rememberedUnit } from "./remembered.js";
import { wireSaving } from "./saving.js";
import { curlLine, pythonLines } from "./snippets.js";
import { showTab, wireTabs } from "./tabs.js";
import { readFragment } from "./url_state.js";
import { View } from "./view.js";

const RETRY_MS = 2000;
const NOT_FOUND = 404;

const linked = readFragment(location.hash);
const api = new Api(keptKey());
const view = new View({ unit: rememberedUnit(), ...linked.view });
const model = new Model(api, new Busy(showBusy), came, failed);
const pictures = new Pictures(api, model, view);
let troubled = false;

async function begin() {
  document.documentElement.dataset.theme = view.value.theme;
  await model.open(view.value);
  view.set({ library: model.library.id, unit: model.library.unit });
  wireControls(view, () => model.library.grid);
  showLibraries({ all: [model.library], latest: null }, model.library);
  fitControls(model.library.grid);
  wireTabs(view);
  wireHelp();
  wireAxes();
  wireCopying(keepAddress(view, (remarks) => say(remarks.join(". "))));
  byId("forget-key").hidden = !api.hasKey;
  byId("forget-key").addEventListener("click", () => {
    forgetKey();
    location.reload();
  });
  wireSaving(model, view, () => pictures.scene);
  showControls(view.value);
  showTab(view.value);
  showExplorer();
  if (linked.remarks.length > 0) say(linked.remarks.join(". "));
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

/** A part of the model has come. */
function came(part) {
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

/** Says what is wrong, and tries again until it is not. */
async function failed(error, part) {
  if (part === "library" && error instanceof ProblemError && error.status === NOT_FOUND) {
    say(error.message);
    view.set({ library: model.library.id }, "corrected");
    return;
  }
  if (troubled) return;
  troubled = true;
  const asks = error instanceof ProblemError && error.status !== KEY_WANTED;
  const trouble = troubleOf(error, asks ? await buildingNow() : [], model.library === null && view.value.library !== null);
  showTrouble({ ...trouble, refused: api.hasKey });
  if (trouble.kind === "fault") throw error;
  if (trouble.kind === "key") takeKey();
  else setTimeout(again, RETRY_MS);
}

/** Forgets a key that was refused, and goes on with the one that is given in the form. */
function takeKey() {
  forgetKey();
  api.use(null);
  byId("key-form").onsubmit = (event) => {
    event.preventDefault();
    const key = byId("key").value.trim();
    hideTrouble();
    keepKey(key);
    api.use(key);
    again();
  };
}

function again() {
  troubled = false;
  if (model.library === null) {
    begin().catch(failed);
    return;
  }
  api.getAnew("/healthz").then(() => {
    showExplorer();
    model.retry(view.value);
    pictures.begin();
  }, failed);
}

async function buildingNow() {
  try {
    const [{ building }, { jobs }] = await Promise.all([api.getAnew("/v1/building"), api.getAnew("/v1/jobs")]);
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
        say(`${what} on the clipboard.`);
      } catch {
        say(content);
      }
    });
  }
}

begin().catch(failed);
