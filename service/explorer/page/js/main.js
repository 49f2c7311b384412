// The page: what is chosen goes into the view, the model follows it, and the pictures are drawn of both.

import { keepAddress } from "./address_bar.js";
import { Api, LostError } from "./api.js";
import { showControls, wireControls } from "./controls.js";
import { nearestTilt } from "./grid.js";
import { wireHelp } from "./help.js";
import { byId } from "./html.js";
import { say, showExplorer, showTrouble, troubleOf } from "./messages.js";
import { Model } from "./model.js";
import { Pictures } from "./pictures.js";
import { wireSaving } from "./saving.js";
import { curlLine, pythonLines } from "./snippets.js";
import { showTab, wireTabs } from "./tabs.js";
import { viewOf } from "./url_state.js";
import { View } from "./view.js";

const RETRY_MS = 2000;

const api = new Api();
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
  const building = error instanceof LostError ? [] : await buildingNow();
  const trouble = troubleOf(error, building, model.library === null && view.value.library !== null);
  showTrouble(trouble);
  if (trouble.kind === "fault") throw error;
  setTimeout(again, RETRY_MS);
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
    return (await api.getAnew("/v1/building")).building;
  } catch {
    return [];
  }
}

function wireCopying(address) {
  const copies = {
    "copy-link": ["link", address],
    "copy-json": ["JSON", () => JSON.stringify(model.state.state, null, 1)],
    "copy-curl": ["curl line", () => curlLine(location.origin, model.library, model.state)],
    "copy-python": ["Python lines", () => pythonLines(location.origin, model.library, model.state)],
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
