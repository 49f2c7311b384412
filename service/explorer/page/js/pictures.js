// All pictures of the page: which of them are redrawn when data has arrived or the view has changed.

import { deviceOf } from "./assembly.js";
import { CLASS_COLOURS } from "./colours.js";
import { besideText, placeText, showComparison, showSnaps, wireComparison } from "./compare_view.js";
import { intervalAt, nextFormations } from "./curve.js";
import { DepthView, depthReadout } from "./depth_view.js";
import { afterSnap, noSnapText, toleranceText } from "./falls.js";
import { justAfter, isOnGrid, nearestPhase, steppedPhase } from "./grid.js";
import { byId } from "./html.js";
import { MapView, mapPhaseText } from "./map_view.js";
import { LOAD_FIELDS } from "./load.js";
import { markPainted } from "./marks.js";
import { showToast } from "./messages.js";
import { followed } from "./neighbours.js";
import { remaining } from "./observation.js";
import { firstCamera } from "./orbit.js";
import { Player, prefersReducedMotion } from "./player.js";
import { QUANTITIES, needsSummaries } from "./quantities.js";
import { lastStage, rests } from "./resting.js";
import { followSize } from "./size.js";
import { showState } from "./state_panel.js";
import { keyOf } from "./success_map.js";
import { stateLine } from "./terms.js";
import { pointText } from "./turned_path.js";
import { unitFactor, wrapAngle } from "./units.js";
import { DEFAULTS } from "./view.js";
import { WHOLE_TURN, aroundEvent, middleOf, rangeOf, zoomed } from "./zoom.js";

const STAGES_PER_SECOND = 0.55;
const PHASE_STEPS_PER_SECOND = 30;
/** Where less motion is preferred: a picture a second, and stages whole. */
const REDUCED_MOTION_STEPS_PER_SECOND = 1;
const TILT_FIELDS = ["roll", "pitch"];
const NO_NETWORK = "No network: the library was computed by meshes, or the phase is undecided.";
const NOT_IN_NETWORK = "This formation occurs at no orientation of the grid: the network does not have it. The way below is by turning alone.";
/** Parts of the model that are seen in the tabs behind the first one alone. */
const TAB_PARTS = ["statics", "jamming", "assembly", "progress", "success", "storedMaps", "node", "path", "formations", "located", "measured", "comparison", "profiles"];
const BESIDE = ["beside_library", "beside_roll", "beside_pitch"];

/** The pictures, and what is played in them. */
export class Pictures {
  scene = null;
  #api;
  #model;
  #view;
  #map;
  #depth;
  #player;
  /** The views of the tabs behind the first one, null until they have been fetched, and what arrived meanwhile. */
  #tabs = null;
  #tabsRequested = false;
  /** Whether the path that arrives next is played. */
  #playsNext = false;
  #missed = new Set();
  /** What the scene has the solids of: a library's number. */
  #solids = null;

  constructor(api, model, view) {
    this.#api = api;
    this.#model = model;
    this.#view = view;
    const toPhase = (phase) => view.set({ phase: nearestPhase(model.library.grid, phase) });
    const goTo = ({ roll, pitch, phase }) => view.set({ roll, pitch, phase }, "entry");
    this.#map = new MapView(byId("map"), {
      choose: (roll, pitch) => view.set({ roll, pitch }),
      showText: (text) => (byId("map-readout").textContent = text),
      goTo,
    });
    this.#depth = new DepthView(byId("depth"), {
      choose: toPhase,
      zoom: (factor, middle) => this.#zoom(factor, middle),
      step: (steps) => view.set({ phase: steppedPhase(model.library.grid, view.value.phase, steps) }),
      goTo,
    });
    wireComparison(view, () => model.library.grid);
    showComparison(view.value);
    this.#player = new Player((name) => this.#showPlaying(name));
    this.#wireZoom();
    this.#wireScene();
  }

  /** Redraws what is as large as its frame whenever that changes. */
  followSizes() {
    followSize([byId("map"), byId("depth")], (frame) => (frame === byId("map") ? this.#drawMap() : this.#drawCurves()));
  }

  /** Begins with what the view's tab needs. */
  begin() {
    this.#showTab();
  }

  /** Fetches the views of the tabs behind the first one, and shows what arrived before. */
  async #beginTabs() {
    if (this.#tabsRequested) return;
    this.#tabsRequested = true;
    const { tabViews } = await import("./tab_views.js");
    const view = this.#view;
    this.#tabs = tabViews({
      choosePhase: (phase) => view.set({ phase: nearestPhase(this.#model.library.grid, phase) }),
      choosePose: ({ roll, pitch, phase }) => view.set({ roll, pitch, phase }, "entry"),
      chooseFormation: (key, move) => this.#followFormation(key, move),
      observe: (observed) => view.set({ observed }),
      measure: (poses) => view.set({ poses }),
      load: (parts) => view.set(parts),
      device: {
        compute: (assembly) => this.#compute(assembly),
        cancel: () => view.set({ assembly: "", point: 0 }),
        goTo: (point) => view.set({ point }),
      },
      success: {
        map: (success) => {
          view.set({ success, success_critical: "" }, "entry");
          this.#followSuccess();
        },
        cancel: () => this.#model.success.cancel(),
        keep: (isKept) => {
          if (isKept) this.#model.keptSuccess.adopt(this.#model.success);
          view.set({ kept_success: isKept ? this.#model.success.value.text : "", kept_success_critical: isKept ? view.value.success_critical : "" });
        },
        play: (assembly, { roll, pitch, phase }) => {
          view.set({ roll, pitch, phase: wrapAngle(phase), success_at: keyOf({ roll, pitch }) });
          this.#playsNext = true;
          this.#compute(assembly);
        },
        findCritical: (place) => {
          view.set({ success_critical: keyOf(place) });
          this.#model.success.findCritical(place);
        },
      },
      player: this.#player,
      chooseLibrary: (library) => view.set({ library }),
      chooseThread: (thread) => view.set({ thread }),
    });
    this.#tabs.device.takePose(view.value);
    this.#showTab();
    for (const part of this.#missed) this.redraw(part);
  }

  /** Loads the solids, after the first numbers were seen. */
  async #beginSolids() {
    const { id } = this.#model.library;
    if (this.#solids === id) return;
    this.#solids = id;
    try {
      await this.#loadScene();
    } catch (error) {
      this.#solids = null;
      byId("scene").textContent = `The solids cannot be shown: ${error.message}`;
    }
  }

  /** Draws the pictures of a part of the model that has arrived. */
  redraw(part) {
    const view = this.#view.value;
    if (["map", "orientations", "windows", "library", "measured", "located"].includes(part)) this.#drawMap();
    if (["depth", "beside", "measured"].includes(part)) this.#drawCurves();
    if (part === "falls") this.#showFalls();
    if (["located", "measured"].includes(part)) this.#drawLists();
    if (part === "state") {
      this.#drawState();
      this.#map.markState(this.#model, view);
      this.#model.followHistory(view);
      this.#beginSolids();
      this.#beginTabs();
    }
    if (this.#tabs === null) {
      if (TAB_PARTS.includes(part)) this.#missed.add(part);
      return;
    }
    if (["libraries", "library"].includes(part)) this.#followThreads();
    if (["comparison", "profiles"].includes(part)) this.#drawThreads();
    if (part === "statics") this.#drawLoad();
    if (["assembly", "progress", "library"].includes(part)) this.#showAssembly();
    if (part === "assembly") this.#playAnswer();
    if (["success", "storedMaps"].includes(part)) this.#showSuccess();
    if (part === "jamming") this.#tabs.load.showJamming(this.#model.jamming);
    if (part === "node") this.#drawFollowing();
    if (part === "path") this.#drawPath();
    if (part === "formations") this.#drawNetwork();
    if (["node", "path"].includes(part)) this.#markNetwork();
  }

  /** Draws the pictures of the parts of the view that have changed. */
  follow(changed) {
    const has = (...names) => names.some((name) => changed.has(name));
    if (has("roll", "pitch", "quantity", "over", "tab")) this.#drawMap();
    if (has("from", "span")) this.#drawCurves();
    if (has(...BESIDE)) showComparison(this.#view.value);
    if (has("observed")) this.#tabs?.locate.show(this.#view.value.observed);
    if (has(...TILT_FIELDS, "phase")) this.#markLists();
    if (has(...TILT_FIELDS, "tolerance")) this.#showFalls();
    if (has("phase")) this.#moveCursors();
    if (has(...TILT_FIELDS)) this.#showSnap();
    if (has("stage", "nut", "azimuth", "elevation", "distance")) this.#drawScene();
    if (has(...TILT_FIELDS, "phase")) this.#tabs?.device.takePose(this.#view.value);
    if (has("tab")) this.#showTab();
    if (has("assembly", "library", "unit")) this.#followAssembly();
    if (has("success", "success_at", "kept_success", "library", "unit")) this.#followSuccess();
    if (has("assembly", "unit")) this.#showAssembly();
    if (has("point")) this.#showPoint();
    if (has("thread", "library", "unit")) this.#followThreads();
    if (has(...LOAD_FIELDS, "plane", ...TILT_FIELDS, "phase", "unit")) this.#followLoad();
    if (has(...TILT_FIELDS, "stage") && !["stages", "phase"].includes(this.#player.playing)) this.#player.stop();
  }

  #drawMap() {
    const { map, orientations, windows } = this.#model;
    const view = this.#view.value;
    const quantity = QUANTITIES[view.quantity];
    byId("quantity").dataset.help = `${quantity.name}: ${quantity.help}.`;
    if (needsSummaries(view) ? !(orientations && (quantity.ofState || windows)) : !map) return;
    this.#map.draw(this.#model, view, this.#remaining());
    byId("map-phase").textContent = mapPhaseText(this.#model, view);
    markPainted("map");
  }

  #drawCurves() {
    const { heights, library, measured } = this.#model;
    if (heights === null) return;
    const intervals = this.#intervals();
    const beside = this.#beside();
    this.#depth.draw({ heights, intervals, library, measured, beside }, this.#view.value, this.#range());
    this.#showBeside(beside);
    if (this.#isSeen("regions")) this.#tabs?.disks.draw(intervals);
    this.#moveCursors();
    this.#showSnap();
    markPainted("depth");
  }

  #moveCursors() {
    const view = this.#view.value;
    const intervals = this.#present();
    const interval = intervalAt(intervals, view.phase);
    this.#depth.moveCursor(this.#model, view);
    if (this.#isSeen("regions")) this.#tabs?.disks.moveCursor(interval, view.phase);
    byId("depth-readout").textContent = depthReadout({ intervals }, view);
    byId("map-phase").textContent = mapPhaseText(this.#model, view);
    this.#followInterval(interval);
  }

  #followInterval(interval) {
    const { value } = this.#view;
    if (!this.#isSeen("follows", "network")) return;
    if (this.#present() !== null) this.#model.followFormation(value, interval);
  }

  #isSeen(...tabs) {
    return tabs.includes(this.#view.value.tab);
  }

  /** Requests what the load does where that is seen. */
  #followLoad() {
    this.#tabs?.load.show(this.#view.value);
    if (this.#isSeen("load")) this.#model.followLoad(this.#view.value);
  }

  /** Requests the path of the held bolt where that is seen, or none is asked for. */
  #followAssembly() {
    const { value } = this.#view;
    this.#tabs?.device.show(value);
    if (this.#seesDevice || value.assembly === "") this.#model.followAssembly(value);
  }

  /** Whether the tab of the device is seen, or that of its success maps. */
  get #seesDevice() {
    return this.#isSeen("device") || this.#isSeen("success");
  }

  /** Requests the success maps where they are seen, or none is asked for. */
  #followSuccess() {
    const { value } = this.#view;
    this.#tabs?.success.show(value);
    if (this.#isSeen("success") || value.success === "") this.#model.followSuccess(value);
    this.#showSuccess();
  }

  #showSuccess() {
    this.#tabs?.success.draw(this.#model, this.#view.value);
  }

  /** Plays a path that a cell of a success map has asked for. */
  #playAnswer() {
    if (!this.#playsNext || this.#turned() === null || this.#model.assembly.problem) return;
    this.#playsNext = false;
    this.#tabs.turned.play();
  }

  #compute(assembly) {
    this.#model.repeatAssembly();
    this.#view.set({ assembly, point: 0 }, "entry");
    this.#followAssembly();
    this.#showAssembly();
  }

  /** The path that is shown below the solids while the tab of the device is. */
  #turned() {
    const path = this.#model.assembly?.path ?? null;
    return this.#seesDevice && path?.path.phase.length > 0 ? path : null;
  }

  #showAssembly() {
    if (this.#tabs === null) return;
    const { value } = this.#view;
    const { library } = this.#model;
    const turned = this.#turned();
    document.querySelector(".panel.turned").hidden = turned === null;
    document.querySelector(".panel.phase").hidden = turned !== null;
    this.#tabs.device.showAnswer(this.#model, value);
    if (library.unit === value.unit) this.#tabs.turned.show(turned, library.pair, value.unit);
    for (const id of ["play-stages", "play-phase", "stage"]) byId(id).disabled = turned !== null;
    this.#showPoint();
  }

  /** Shows the point of the view, or the last one of a path that has fewer. */
  #showPoint() {
    const turned = this.#turned();
    if (turned !== null && this.#tabs !== null) {
      const at = pointOf(turned, this.#view.value);
      this.#tabs.turned.moveTo(at);
      this.#tabs.device.mark(at, turned.path);
    }
    this.#drawScene();
  }

  /** Requests the libraries' figures and the sections where these are seen. */
  #followThreads() {
    this.#tabs?.threads.show(this.#view.value);
    if (this.#isSeen("threads")) this.#model.followThreads(this.#view.value);
  }

  #drawThreads() {
    this.#tabs.threads.showProfiles(this.#model.profiles);
    this.#tabs.threads.list(this.#model.comparison, this.#model.library.id);
  }

  #drawLoad() {
    this.#tabs.load.showStatics(this.#model.statics, this.#view.value.unit);
    this.#drawScene();
  }

  /** What the load does to the state that is shown, where its tab and the state's last pose are seen. */
  #loaded() {
    const { statics, state } = this.#model;
    const found = statics?.statics;
    const isHere = found && state?.state && ["roll", "pitch", "phase"].every((name) => found[name] === state.pose[name]);
    const isLast = isHere && lastStage(state.state) === state.state.poses.length && this.#view.value.stage >= lastStage(state.state);
    return this.#isSeen("load") && isLast ? found : null;
  }

  /** Draws what a tab holds that has become visible. */
  #showTab() {
    this.#followLoad();
    this.#followAssembly();
    this.#showAssembly();
    this.#followSuccess();
    this.#followThreads();
    if (this.#isSeen("network")) this.#model.followNetwork();
    this.#drawCurves();
    if (!this.#isSeen("state")) this.#beginTabs();
    if (this.#isSeen("follows")) {
      this.#drawFollowing();
      this.#drawPath();
    }
    this.#drawLists();
    this.#drawState();
  }

  /** Draws the tabs with forms: what remains of an observation, and measured poses. */
  #drawLists() {
    const { value } = this.#view;
    this.#tabs?.locate.show(value.observed);
    if (this.#isSeen("locate")) this.#tabs?.locate.list(this.#model.located);
    if (this.#isSeen("poses")) this.#tabs?.poses.list(this.#model.measured, value.unit);
    this.#markLists();
  }

  #markLists() {
    this.#tabs?.locate.mark(this.#view.value);
    this.#tabs?.poses.mark(this.#view.value);
  }

  /** The orientations that an observation leaves, while its tab is shown. */
  #remaining() {
    const { located } = this.#model;
    return this.#isSeen("locate") && located?.stretches ? remaining(located.stretches) : [];
  }

  #range() {
    return rangeOf(this.#view.value, this.#intervals()?.history ?? null);
  }

  #zoom(factor, middle) {
    const { value } = this.#view;
    const range = this.#range();
    this.#view.set(factor === null ? WHOLE_TURN : zoomed(range, factor, middle ?? middleOf({ ...range, phase: value.phase })));
  }

  /** The other orientation, where it has arrived and is the one that was chosen. */
  #beside() {
    const { beside, library } = this.#model;
    const { value } = this.#view;
    if (!beside?.library) return null;
    const isChosen = beside.id === value.beside_library && beside.roll === value.beside_roll && beside.pitch === value.beside_pitch;
    return isChosen ? { ...beside, text: besideText(beside, library) } : null;
  }

  #showBeside(beside) {
    const frame = byId("snaps");
    frame.hidden = this.#view.value.beside_library === null;
    if (frame.hidden) return;
    if (beside === null) {
      frame.textContent = this.#model.beside?.library === null ? `There is no library ${this.#model.beside.id} here.` : "";
      return;
    }
    const here = { text: placeText(this.#view.value), history: this.#present()?.history ?? null };
    showSnaps(frame, here, beside, this.#view.value.unit);
  }

  #showFalls() {
    const { falls } = this.#model;
    const { value } = this.#view;
    const isChosen = falls !== null && [...TILT_FIELDS, "tolerance"].every((name) => falls[name] === value[name]);
    byId("falls").hidden = value.tolerance === null;
    if (!isChosen) byId("falls").textContent = "";
    else byId("falls").textContent = falls.problem ? `Nothing is known within ±${value.tolerance} deg: ${falls.problem}` : toleranceText(falls, value.unit);
  }

  #drawState() {
    const { state } = this.#model;
    if (state === null) return;
    showState(byId("state"), state, state.unit);
    byId("state-line").textContent = state.state ? stateLine(state.state) : "undecided";
    byId("state-line").style.setProperty("--class", CLASS_COLOURS[state.state?.class] ?? "transparent");
    byId("stage").max = state.state ? lastStage(state.state) : 3;
    byId("stage").value = this.#view.value.stage;
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
    const turned = this.#turned();
    const loaded = this.#loaded();
    byId("force-legend").hidden = loaded === null;
    byId("turned-legend").hidden = turned === null;
    byId("stage-legend").hidden = loaded !== null || turned !== null;
    if (turned !== null) {
      this.#drawPoint(turned);
      return;
    }
    this.scene.show(state.state, loaded, this.#view.value, threadPitch, nominal, `roll ${roll}, pitch ${pitch}, phase ${phase} deg, ${readout}`);
    byId("scene-readout").textContent = readout;
  }

  /** Draws the bolt at the point of a path that the view has; its lengths are in the answer's unit. */
  #drawPoint(turned) {
    const { value } = this.#view;
    const { unit, pair } = this.#model.library;
    const at = pointOf(turned, value);
    const readout = pointText(turned.path, at);
    const point = { pose: turned.path.pose[at], contacts: turned.path.contacts[at] };
    const nominal = pair.nominal_diameter * unitFactor(unit, turned.unit);
    this.scene.showPoint(point, deviceOf(this.#model.assembly.text, turned.unit), value, nominal, `the path of the held bolt, ${readout}`);
    byId("scene-readout").textContent = readout;
  }

  #drawFollowing() {
    if (this.#model.node) this.#tabs?.follows.draw(this.#model.node.node, nextFormations(this.#intervals(), this.#view.value.phase));
    else this.#tabs?.follows.showEmpty(isOnGrid(this.#model.library.grid, this.#view.value) ? NO_NETWORK : NOT_IN_NETWORK);
  }

  #drawNetwork() {
    const { formations } = this.#model;
    if (formations === null) this.#tabs.network.showEmpty(NO_NETWORK);
    else this.#tabs.network.draw(formations);
    this.#markNetwork();
  }

  #markNetwork() {
    const { node, path } = this.#model;
    const here = node?.node ?? null;
    const way = path?.path ?? null;
    this.#tabs.network.mark(here, way?.steps[0].formation === here?.formation.key ? way : null);
  }

  #drawPath() {
    const path = this.#model.path?.path ?? null;
    this.#tabs?.showPath(path, this.#model.path !== null, ({ roll, pitch, phase }) =>
      this.#view.set({ roll, pitch, phase: justAfter(phase) }, "entry"),
    );
  }

  /** The intervals where they belong to the heights that are drawn. */
  #intervals() {
    const { heights, intervals } = this.#model;
    return TILT_FIELDS.every((name) => intervals?.history[name] === heights?.[name]) ? intervals : null;
  }

  /** The intervals where they belong to the orientation that was chosen. */
  #present() {
    const { intervals } = this.#model;
    return TILT_FIELDS.every((name) => intervals?.history[name] === this.#view.value[name]) ? intervals : null;
  }

  async #followFormation(key, move) {
    const { unit, roll, pitch, phase } = this.#view.value;
    const { node } = await this.#api.get(`${this.#model.root}/network/formations/${key}`, { unit });
    this.#view.set(followed(node, { roll, pitch, phase }, move, this.#model.library.grid), "entry");
  }

  #showSnap() {
    const history = this.#present()?.history ?? null;
    const noSnap = history?.snap ? null : noSnapText(history, this.#view.value.unit);
    const noEvent = history && aroundEvent(history) ? null : "There is neither a window nor a snap here.";
    for (const [id, reason] of [["to-snap", noSnap], ["zoom-window", noEvent]]) {
      const button = byId(id);
      button.dataset.can ??= button.dataset.help;
      button.setAttribute("aria-disabled", reason !== null);
      button.dataset.help = reason ?? button.dataset.can;
    }
  }

  #wireZoom() {
    const unless = (id, act) => byId(id).addEventListener("click", () => {
      if (byId(id).getAttribute("aria-disabled") === "true") showToast(byId(id).dataset.help);
      else act(this.#present().history);
    });
    unless("to-snap", ({ snap }) => this.#view.set({ phase: afterSnap(snap) }, "entry"));
    unless("zoom-window", (history) => this.#view.set(aroundEvent(history)));
    byId("zoom-in").addEventListener("click", () => this.#zoom(0.5, null));
    byId("zoom-out").addEventListener("click", () => this.#zoom(2, null));
    byId("zoom-turn").addEventListener("click", () => this.#zoom(null, null));
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
      const stage = prefersReducedMotion() ? Math.floor(played) : played;
      const ended = stage >= last;
      this.#view.set({ stage: ended ? DEFAULTS.stage : stage });
      return !ended;
    });
  }

  #playPhase() {
    const { grid } = this.#model.library;
    const first = this.#view.value.phase;
    this.#player.play("phase", (seconds) => {
      const steps = Math.floor(seconds * (prefersReducedMotion() ? REDUCED_MOTION_STEPS_PER_SECOND : PHASE_STEPS_PER_SECOND));
      if (steps > 0) this.#view.set({ phase: steppedPhase(grid, first, steps) });
      return true;
    });
  }

  #showPlaying(name) {
    for (const [id, own] of [["play-stages", "stages"], ["play-phase", "phase"], ["turned-play", "path"]]) {
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
    if (this.#model.library.id !== library.id) return;
    this.scene ??= new SceneView(byId("scene"), (camera) => this.#view.set(camera));
    this.scene.setSolids(bolt, nut, 1 / nominalOf(library));
    this.#drawScene();
    markPainted("solids");
  }
}

function pointOf({ path }, { point }) {
  return Math.min(point, path.phase.length - 1);
}

/** The nominal diameter in the unit that the library is stored in, as its meshes are. */
function nominalOf({ pair, unit, stored_unit: stored }) {
  return pair.nominal_diameter * unitFactor(unit, stored);
}

function sceneReadout(state, stage) {
  const names = ["above the nut", "first contact", "second contact", "third contact"];
  const last = lastStage(state);
  const at = Math.min(stage, last);
  const whole = Math.floor(at);
  if (at !== whole) return `from ${names[whole]} to ${names[whole + 1]}`;
  return at === last && !rests(state) ? `${names[whole]}; from here the bolt does not come to rest` : names[whole];
}
