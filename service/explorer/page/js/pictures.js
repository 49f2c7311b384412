// All pictures of the page: which is drawn anew when what has come or changed.

import { CLASS_COLOURS } from "./colours.js";
import { intervalAt, nextFormations } from "./curve.js";
import { DepthView, depthReadout } from "./depth_view.js";
import { DisksView } from "./disks_view.js";
import { FollowsView } from "./follows_view.js";
import { behind, nearestPhase, steppedPhase } from "./grid.js";
import { byId } from "./html.js";
import { MapView } from "./map_view.js";
import { markPainted } from "./marks.js";
import { lastStage } from "./motion.js";
import { followed } from "./neighbours.js";
import { NetworkView } from "./network_view.js";
import { firstCamera } from "./orbit.js";
import { drawPath, pathText } from "./path_view.js";
import { Player } from "./player.js";
import { QUANTITIES, needsSummaries } from "./quantities.js";
import { followSize } from "./size.js";
import { showState } from "./state_panel.js";
import { stateLine } from "./terms.js";
import { WHOLE_TURN, aroundWindow, middleOf, zoomed } from "./zoom.js";

const STAGES_PER_SECOND = 0.55;
const PHASE_STEPS_PER_SECOND = 30;
/** Where less motion is preferred: a picture a second, and stages whole. */
const STILL_STEPS_PER_SECOND = 1;
const UNITED = ["roll", "pitch"];
const NO_NETWORK = "There is none: the library was computed by meshes, or the phase is undecided.";

/** The pictures, and what is played in them. */
export class Pictures {
  scene = null;
  #api;
  #model;
  #view;
  #map;
  #depth;
  #disks;
  #follows;
  #network;
  #player;
  #solids = null;

  constructor(api, model, view) {
    this.#api = api;
    this.#model = model;
    this.#view = view;
    const toPhase = (phase) => view.set({ phase: nearestPhase(model.library.grid, phase) });
    this.#map = new MapView(
      byId("map"),
      (roll, pitch) => view.set({ roll, pitch }),
      (text) => (byId("map-readout").textContent = text),
    );
    this.#depth = new DepthView(byId("depth"), toPhase, (factor, middle) => view.set(zoomed(view.value, factor, middle)));
    this.#disks = new DisksView(byId("disks"), toPhase);
    this.#follows = new FollowsView(byId("follows"), (key, move) => this.#followFormation(key, move));
    this.#network = new NetworkView(
      byId("network"),
      (key) => this.#followFormation(key, null),
      (text) => (byId("network-readout").textContent = text),
    );
    this.#player = new Player((name) => this.#showPlaying(name));
    this.#wireZoom();
    this.#wireScene();
  }

  /** Draws what is as large as its frame anew whenever that changes. */
  followSizes() {
    followSize([byId("map"), byId("depth")], (frame) => (frame === byId("map") ? this.#drawMap() : this.#drawCurves()));
  }

  /** Begins with what the view's tab needs. */
  begin() {
    this.#showTab();
  }

  /** Loads the solids, after the first numbers were seen. */
  async #beginSolids() {
    if (this.#solids !== null) return;
    this.#solids = this.#loadScene();
    try {
      await this.#solids;
    } catch (error) {
      this.#solids = null;
      byId("scene").textContent = `The solids cannot be shown: ${error.message}`;
    }
  }

  /** Draws what a part of the model that has come is seen in. */
  redraw(part) {
    const view = this.#view.value;
    if (["map", "orientations", "windows", "library"].includes(part)) this.#drawMap();
    if (["heights", "intervals"].includes(part)) this.#drawCurves();
    if (part === "state") {
      this.#drawState();
      this.#model.followHistory(view);
      this.#beginSolids();
    }
    if (part === "node") this.#drawFollowing();
    if (part === "path") this.#drawPath();
    if (part === "formations") this.#drawNetwork();
    if (["node", "path"].includes(part)) this.#markNetwork();
    if (part === "library") this.#model.follow(view);
  }

  /** Draws what parts of the view that have changed are seen in. */
  follow(changed) {
    const has = (...names) => names.some((name) => changed.has(name));
    if (has("roll", "pitch", "quantity", "over")) this.#drawMap();
    if (has("from", "span")) this.#drawCurves();
    if (has("phase")) this.#moveCursors();
    if (has(...UNITED)) this.#showSnap();
    if (has("stage", "nut", "azimuth", "elevation", "distance")) this.#drawScene();
    if (has("tab")) this.#showTab();
    if (has(...UNITED, "stage") && !["stages", "phase"].includes(this.#player.playing)) this.#player.stop();
  }

  #drawMap() {
    const { map, orientations, windows } = this.#model;
    const view = this.#view.value;
    const quantity = QUANTITIES[view.quantity];
    byId("quantity").dataset.help = `${quantity.name}: ${quantity.help}.`;
    if (needsSummaries(view) ? !(orientations && (quantity.ofState || windows)) : !map) return;
    this.#map.draw(this.#model, view);
    markPainted("map");
  }

  #drawCurves() {
    const { heights, library } = this.#model;
    if (heights === null) return;
    const intervals = this.#intervals();
    this.#depth.draw({ heights, intervals, library }, this.#view.value);
    if (this.#isSeen("regions")) this.#disks.draw(intervals);
    this.#moveCursors();
    this.#showSnap();
    markPainted("depth");
  }

  #moveCursors() {
    const view = this.#view.value;
    const intervals = this.#intervals();
    const interval = intervalAt(intervals, view.phase);
    this.#depth.moveCursor(this.#model, view);
    if (this.#isSeen("regions")) this.#disks.moveCursor(interval, view.phase);
    byId("depth-readout").textContent = depthReadout({ intervals }, view);
    this.#followInterval(interval);
  }

  #followInterval(interval) {
    const { value } = this.#view;
    if (!this.#isSeen("follows", "network")) return;
    if (UNITED.every((name) => this.#intervals()?.history[name] === value[name])) this.#model.followFormation(value, interval);
  }

  #isSeen(...tabs) {
    return tabs.includes(this.#view.value.tab);
  }

  /** Draws what a tab holds that has come into sight. */
  #showTab() {
    if (this.#isSeen("network")) this.#model.followNetwork();
    this.#drawCurves();
    if (this.#isSeen("follows")) {
      this.#drawFollowing();
      this.#drawPath();
    }
    this.#drawState();
  }

  #drawState() {
    const { state } = this.#model;
    if (state === null) return;
    showState(byId("state"), state, state.unit);
    byId("state-line").textContent = state.state ? stateLine(state.state) : "undecided";
    byId("state-line").style.setProperty("--class", CLASS_COLOURS[state.state?.class] ?? "transparent");
    this.#depth.moveCursor(this.#model, this.#view.value);
    this.#drawScene();
    markPainted("state");
  }

  #drawScene() {
    const { state, library } = this.#model;
    if (this.scene === null || state === null) return;
    const { thread_pitch: threadPitch, nominal_diameter: nominal } = library.pair;
    const readout = state.state ? sceneReadout(state.state, this.#view.value.stage) : "no state at this pose";
    const { roll, pitch, phase } = state.pose;
    this.scene.show(state.state, this.#view.value, threadPitch, nominal, `roll ${roll}, pitch ${pitch}, phase ${phase} deg, ${readout}`);
    byId("scene-readout").textContent = readout;
  }

  #drawFollowing() {
    if (this.#model.node) this.#follows.draw(this.#model.node.node, nextFormations(this.#intervals(), this.#view.value.phase));
    else this.#follows.tell(NO_NETWORK);
  }

  #drawNetwork() {
    const { formations } = this.#model;
    if (formations === null) this.#network.tell(NO_NETWORK);
    else this.#network.draw(formations);
    this.#markNetwork();
  }

  #markNetwork() {
    const { node, path } = this.#model;
    const here = node?.node ?? null;
    const way = path?.path ?? null;
    this.#network.mark(here, way?.steps[0].formation === here?.formation.key ? way : null);
  }

  #drawPath() {
    const path = this.#model.path?.path ?? null;
    byId("path-text").textContent = this.#model.path ? pathText(path) : "";
    byId("path").replaceChildren();
    if (path) drawPath(byId("path"), path, ({ roll, pitch, phase }) => this.#view.set({ roll, pitch, phase: behind(phase) }));
  }

  /** The intervals where they belong to the heights that are drawn. */
  #intervals() {
    const { heights, intervals } = this.#model;
    return UNITED.every((name) => intervals?.history[name] === heights?.[name]) ? intervals : null;
  }

  async #followFormation(key, move) {
    const { unit, roll, pitch, phase } = this.#view.value;
    const { node } = await this.#api.get(`${this.#model.root}/network/formations/${key}`, { unit });
    this.#view.set(followed(node, { roll, pitch, phase }, move, this.#model.library.grid));
  }

  #window() {
    return this.#intervals()?.history.windows[0] ?? null;
  }

  #showSnap() {
    byId("to-snap").disabled = this.#window() === null;
    byId("zoom-window").disabled = this.#window() === null;
  }

  #wireZoom() {
    const view = this.#view;
    byId("to-snap").addEventListener("click", () => view.set({ phase: behind(this.#window().lowest_phase) }));
    byId("zoom-in").addEventListener("click", () => view.set(zoomed(view.value, 0.5, middleOf(view.value))));
    byId("zoom-out").addEventListener("click", () => view.set(zoomed(view.value, 2, middleOf(view.value))));
    byId("zoom-turn").addEventListener("click", () => view.set(WHOLE_TURN));
    byId("zoom-window").addEventListener("click", () => view.set(aroundWindow(this.#window())));
  }

  #wireScene() {
    byId("camera-reset").addEventListener("click", () => this.#view.set(firstCamera()));
    byId("play-stages").addEventListener("click", () => this.#toggle("stages", () => this.#playStages()));
    byId("play-phase").addEventListener("click", () => this.#toggle("phase", () => this.#playPhase()));
  }

  #toggle(name, play) {
    if (this.#player.playing === name) this.#player.stop();
    else play();
  }

  #playStages() {
    const last = this.#model.state?.state ? lastStage(this.#model.state.state) : 0;
    this.#player.play("stages", (seconds) => {
      const played = Math.min(seconds * STAGES_PER_SECOND, last);
      const stage = prefersStillness() ? Math.floor(played) : played;
      this.#view.set({ stage });
      return stage < last;
    });
  }

  #playPhase() {
    const { grid } = this.#model.library;
    const first = this.#view.value.phase;
    this.#player.play("phase", (seconds) => {
      const steps = Math.floor(seconds * (prefersStillness() ? STILL_STEPS_PER_SECOND : PHASE_STEPS_PER_SECOND));
      if (steps > 0) this.#view.set({ phase: steppedPhase(grid, first, steps) });
      return true;
    });
  }

  #showPlaying(name) {
    for (const [id, own] of [["play-stages", "stages"], ["play-phase", "phase"]]) {
      byId(id).setAttribute("aria-pressed", name === own);
    }
  }

  async #loadScene() {
    const { root, library } = this.#model;
    const [{ SceneView, canDrawSolids }, bolt, nut] = await Promise.all([
      import("./scene_view.js"),
      this.#api.bytes(`${root}/meshes/bolt`),
      this.#api.bytes(`${root}/meshes/nut`),
    ]);
    if (!canDrawSolids()) throw new Error("this browser has no WebGL");
    this.scene = new SceneView(byId("scene"), (camera) => this.#view.set(camera));
    this.scene.setSolids(bolt, nut, 1 / nominalOf(library));
    this.#drawScene();
    markPainted("solids");
  }
}

/** The nominal diameter in the unit that the library is stored in, as its meshes are. */
function nominalOf({ pair, unit, stored_unit: stored }) {
  const millimetres = { in: 25.4, mm: 1 };
  return (pair.nominal_diameter * millimetres[unit]) / millimetres[stored];
}

function prefersStillness() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}

function sceneReadout(state, stage) {
  const names = ["above the nut", "first contact", "second contact", "third contact"];
  const at = Math.min(stage, lastStage(state));
  const whole = Math.floor(at);
  return at === whole ? names[whole] : `from ${names[whole]} to ${names[whole + 1]}`;
}
