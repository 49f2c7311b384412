// The buttons that save each panel's picture and table.

import { requestOf } from "./assembly.js";
import { html } from "./html.js";
import { showToast } from "./messages.js";
import { lastStage } from "./resting.js";
import { mapRequestOf } from "./success_map.js";
import { mapNameWords, mapWords } from "./success_words.js";
import { saveFile, savePng, saveSvg, saveTable } from "./save.js";
import { comparisonTable, depthTable, followingTable, formationTable, intervalTable, jammingTable, mapTable, pathTable, poseTable, stateTable, successTable, turnedTable } from "./tables.js";

const PICTURES = { map: "#map svg", phase: "#depth svg", disks: "#disks svg", follows: "#follows svg", path: "#path svg", network: "#network svg", jamming: "#jamming svg", turned: "#turned-chart svg", success: "#success svg" };
const TABLES = {
  map: mapTable,
  phase: depthTable,
  disks: intervalTable,
  follows: followingTable,
  path: pathTable,
  network: formationTable,
  jamming: jammingTable,
  turned: turnedTable,
  success: successTable,
  state: stateTable,
  poses: poseTable,
  compared: comparisonTable,
};
const NAMES = {
  map: "orientations",
  phase: "depth",
  disks: "regions",
  follows: "what-follows",
  path: "way-to-the-window",
  network: "formations",
  jamming: "jamming-diagram",
  turned: "path-of-the-held-bolt",
  success: "success-map",
  scene: "bolt-and-nut",
  state: "state",
  poses: "measured-poses",
  compared: "threads",
};

/** What a picture is of, where its own words do not say so. */
const CAPTIONS = {
  success: ({ success, library }, { unit }) => `${library.designation}, ${mapNameWords(success.value.text, unit)}. ${mapWords(success.value, unit)}`,
};

/** Fills every place for save buttons; `sceneOf` returns the scene, or null. */
export function wireSaving(model, view, sceneOf) {
  for (const place of document.querySelectorAll("[data-save]")) {
    const panel = place.dataset.save;
    const name = () => fileName(NAMES[panel], model, view.value);
    const button = (kind, save) => {
      const made = html("button", { type: "button", "data-kind": kind, "aria-label": `save ${NAMES[panel]} as ${kind}` }, kind);
      made.addEventListener("click", () => Promise.resolve(save()).catch(() => showToast(`There is nothing to save as ${kind} yet.`)));
      place.append(made);
    };
    const picture = () => document.querySelector(PICTURES[panel]);
    if (PICTURES[panel]) {
      const caption = () => CAPTIONS[panel]?.(model, view.value) ?? "";
      button("SVG", async () => saveSvg(name(), picture(), caption()));
      button("PNG", async () => savePng(name(), picture(), caption()));
    }
    if (panel === "scene") button("PNG", async () => saveFile(`${name()}.png`, await sceneOf().png(), "image/png"));
    if (TABLES[panel]) button("CSV", async () => saveTable(name(), TABLES[panel](model, view.value)));
  }
}

/** A file name with library, orientation and phase, those of the view or of the pose at which a held bolt settles; of a success map with strategy and friction. */
function fileName(what, { library, state, success, assembly }, view) {
  if (what === NAMES.success && success.value !== null) {
    const { request, phases } = mapRequestOf(success.value.text);
    return `${library.slug}_${what}_${request.strategy}_mu${request.mu || 0}_phases${phases}`;
  }
  const { stage } = view;
  const { roll, pitch, phase } = what === NAMES.turned ? requestOf(assembly.text) : view;
  const staged = what === NAMES.scene && state?.state ? `_stage${Math.min(stage, lastStage(state.state)).toFixed(1)}` : "";
  return `${library.slug}_${what}_roll${roll}_pitch${pitch}_phase${phase}${staged}`;
}
