// The page: what is chosen goes into the view, the model follows it, and the pictures are drawn of both.

import { keepAddress } from "./address_bar.js";
import { Api, ProblemError } from "./api.js";
import { showControls, wireControls } from "./controls.js";
import { nearestTilt } from "./grid.js";
import { wireHelp } from "./help.js";
import { byId } from "./html.js";
import { forgetKey, keepKey, keptKey } from "./kept_key.js";
import { KEY_WANTED, hideTrouble, progressOf, say, showExplorer, showTrouble, troubleOf } from "./messages.js";
import { Model } from "./model.js";
import { Pictures } from "./pictures.js";
import { wireSaving } from "./saving.js";
import { curlLine, pythonLines } from "./snippets.js";
import { showTab, wireTabs } from "./tabs.js";
import { viewOf } from "./url_state.js";
import { View } from "./view.js";

const RETRY_MS = 2000;


const api = new Api(keptKey());
const view = new View(viewOf(location.hash));
const model = new Model(api, (part) => pictures.redraw(part), failed);
const pictures = new Pictures(api, model, view);
let troubled = false;

async function begin() {
  document.documentElement.dataset.theme = view.value.theme;
  await model.open(view.value);
  const { grid, id, unit, designation } = model.library;
  view.set({
    library: id,
    unit: view.value.unit ?? unit,
    roll: nearestTilt(grid, view.value.roll),
    pitch: nearestTilt(grid, view.value.pitch),
  });
  byId("library").textContent = `${designation}, library ${id}`;
  wireControls(view, grid);
  wireTabs(view);
  wireHelp();
  const address = keepAddress(view);
  wireCopying(address);
  byId("forget-key").hidden = !api.hasKey;
  byId("forget-key").addEventListener("click", () => {
    forgetKey();
    location.reload();
  });
  wireSaving(model, view, () => pictures.scene);
  showControls(view.value);
  showTab(view.value);
  showExplorer();
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

/** Says what is wrong, and tries again until it is not. */
async function failed(error) {
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
    "copy-link": ["link", address],
    "copy-json": ["JSON", () => JSON.stringify(model.state.state, null, 1)],
    "copy-curl": ["curl line", () => curlLine(location.origin, model.library, model.state, api.hasKey)],
    "copy-python": ["Python lines", () => pythonLines(location.origin, model.library, model.state, api.hasKey)],
  };
  for (const [id, [name, text]] of Object.entries(copies)) {
    byId(id).addEventListener("click", async () => {
      const content = text();
      try {
        await navigator.clipboard.writeText(content);
        say(`The ${name} is on the clipboard.`);
      } catch {
        say(content);
      }
    });
  }
}

begin().catch(failed);
