// The data of the present view, fetched from the service; a callback reports each part as it arrives.

import { ProblemError } from "./api.js";
import { bodyOf } from "./assembly.js";
import { heightsOf } from "./curve.js";
import { Debounce } from "./debounce.js";
import { isOnGrid, nearestPhase } from "./grid.js";
import { LOAD_FIELDS, loadOf } from "./load.js";
import { observationQuery } from "./observation.js";
import { posesOfView } from "./poses.js";
import { needsSummaries } from "./quantities.js";
import { SuccessMap } from "./success_map.js";
import { Throttle } from "./throttle.js";
import { turnPath } from "./turn_path.js";

const MAP_FIELDS = "roll,pitch,class,drop,embedment,pivot_offset,margins,statics";
const MAP_PAGE = 1000;
/** Milliseconds between requests of the map while the phase moves. */
export const MAP_MS = 300;
/** What belongs to a formation is requested once the phase has not moved for so many milliseconds. */
const DEBOUNCE_MS = 150;
/** The gap of a diagram's boundary that is not seen, over its size. */
const DIAGRAM_TOLERANCE = 0.002;
const UNRESOLVED = 422;
const NOT_FOUND = 404;
/** The parts that belong to one library. */
const OF_LIBRARY = [
  "orientations", "windows", "map", "history", "depth", "state", "node", "path", "formations", "falls",
  "measured", "located", "statics", "jamming", "assembly", "comparison", "profiles",
];
const MOST_COMPARED = 20;
const INVALID = 400;
const UNAUTHORIZED = 401;

/** The parts of the model, each null until it has arrived. */
export class Model {
  library = null;
  /** All libraries, the latest first, and the number of the one that `latest` means. */
  libraries = null;
  beside = null;
  orientations = null;
  windows = null;
  map = null;
  history = null;
  /** Heights and intervals of the orientation: they arrive together, as where the picture begins follows from both. */
  depth = null;
  state = null;
  node = null;
  path = null;
  formations = null;
  falls = null;
  measured = null;
  located = null;
  /** What the view's load does to its pose, and the jamming diagram there: with `problem`, in words, where it is not known. */
  statics = null;
  jamming = null;
  /** The path of a held bolt that the view asks for, or its `problem` with the values that were refused; how far it is until then. */
  assembly = null;
  progress = null;
  /** The success map that the view asks for, and the one that is kept beside it. */
  success;
  keptSuccess;
  /** The stored success maps of the library's pair, the latest first; null until they have arrived. */
  storedMaps = null;
  /** Figures of libraries side by side, and the sections of the library's thread and of the view's: with `problem` where that has none. */
  comparison = null;
  profiles = null;

  #api;
  #busy;
  #onPart;
  #onError;
  /** By part the key that was requested last, and the key of the response that is stored. */
  #requested = new Map();
  #arrived = new Map();
  #mapThrottle = new Throttle(MAP_MS);
  #solveThrottle = new Throttle(0);
  #staticsThrottle = new Throttle(0);
  #jammingThrottle = new Throttle(0);
  /** Ends the path that is computed. */
  #assembling = new AbortController();
  /** How often a path was asked for by its button: the same request twice is two paths. */
  #assemblies = 0;
  #formationDebounce = new Debounce(DEBOUNCE_MS);

  /** `onPart` is called with the name of a part that has arrived, `onError` with an error and the part that is missing for it. */
  constructor(api, busy, onPart, onError) {
    this.#api = api;
    this.#busy = busy;
    this.#onPart = onPart;
    this.#onError = onError;
    this.success = new SuccessMap(api, () => onPart("success"));
    this.keptSuccess = new SuccessMap(api, () => onPart("success"));
  }

  /** Heights along the phase; null until they have arrived. */
  get heights() {
    return this.depth?.heights ?? null;
  }

  /** The intervals of the phase; null until they have arrived, and where the library has none. */
  get intervals() {
    return this.depth?.intervals ?? null;
  }

  /** Address of the library that is shown. */
  get root() {
    return `/v1/libraries/${this.library.id}`;
  }

  /** Reads the library of a view: its number, or the latest. Errors are the caller's. */
  async open(view) {
    const id = view.library ?? "latest";
    this.library = await this.#api.get(`/v1/libraries/${id}`, { unit: view.unit });
  }

  /** Requests everything of a view that is not loaded yet. */
  follow(view) {
    const { unit, library } = view;
    if (this.library.id !== library || this.library.unit !== unit) {
      this.#request("library", `${library} ${unit}`, () => this.#api.get(`/v1/libraries/${library}`, { unit }));
    }
    if (this.library.id !== library) return;
    const where = `${library} ${unit} ${view.roll} ${view.pitch}`;
    if (needsSummaries(view)) this.#requestSummaries(unit);
    this.#request("state", `${where} ${view.phase}`, () => this.#state(view), (answer, requested) => answer !== null && requested.startsWith(`${where} `));
    this.#request("depth", where, () => this.#depth(view, this.library));
    this.#followMap(view);
    this.#followTolerance(view);
    this.#followBeside(view);
    this.#request("measured", `${library} ${unit} ${view.poses}`, () => this.#measured(view));
    this.#request("located", `${library} ${view.observed}`, () => this.#located(view));
  }

  #followMap({ phase, unit, library }) {
    const onGrid = nearestPhase(this.library.grid, phase);
    this.#requestLatest(this.#mapThrottle, "map", `${library} ${unit} ${onGrid}`, () => this.#map(onGrid, unit));
  }

  #requestSummaries(unit) {
    const key = `${this.library.id} ${unit}`;
    this.#request("orientations", key, async () => (await this.#api.get(`${this.root}/orientations`, { unit })).orientations);
    this.#request("windows", key, () => this.#optional(this.#api.get(`${this.root}/windows`, { unit })));
  }

  /** Requests the history of a view's orientation, whose states then need not be requested one by one; off the grid there is none. */
  followHistory({ unit, library, roll, pitch }) {
    if (this.library.id !== library || !isOnGrid(this.library.grid, { roll, pitch })) return;
    this.#request("history", `${library} ${unit} ${roll} ${pitch}`, () => this.#history({ unit, roll, pitch }));
  }

  /** Requests all libraries, and which of them is the latest. */
  followLibraries() {
    this.#request("libraries", "all", async () => {
      const [{ libraries }, latest] = await Promise.all([
        this.#api.getFresh("/v1/libraries"),
        this.#optional(this.#api.getFresh("/v1/libraries/latest")),
      ]);
      return { all: libraries, latest: latest?.id ?? null };
    });
  }

  /** Requests a formation and its path to the window; both null where the pose has none. */
  followFormation(view, interval) {
    this.#formationDebounce.run(() => this.#requestFormation(view, interval));
  }

  #requestFormation({ unit, library, roll, pitch, phase }, interval) {
    if (this.library.id !== library) return;
    const key = interval?.formation.key ?? null;
    const onGrid = isOnGrid(this.library.grid, { roll, pitch });
    this.#request("node", `${library} ${unit} ${key}`, async () =>
      key === null ? null : this.#optional(this.#api.get(`${this.root}/network/formations/${key}`, { unit })),
    );
    this.#request("path", `${library} ${unit} ${roll} ${pitch} ${interval?.start} ${onGrid ? "" : phase}`, async () => {
      if (key === null) return null;
      if (!onGrid) return { path: turnPath(this.intervals.history, phase) };
      return this.#optional(this.#api.get(`${this.root}/network/paths`, { from: key, roll, pitch, phase: interval.inside, unit }));
    });
  }

  /** Requests what the view's load does to its pose, and the jamming diagram; of loads that come faster than answers the last. */
  followLoad(view) {
    const { library, unit, roll, pitch, phase, plane } = view;
    if (this.library.id !== library || this.library.unit !== unit) return;
    const key = `${library} ${unit} ${roll} ${pitch} ${phase} ${LOAD_FIELDS.map((name) => view[name])}`;
    const pose = { roll, pitch, phase };
    const { force, moment } = loadOf(view, this.library.pair.nominal_diameter / 2);
    this.#requestLatest(this.#staticsThrottle, "statics", key, () => this.#orProblem(async () => {
      const statics = await this.#api.statics(pose, { force, moment, mu: view.mu }, library, unit);
      return { statics };
    }));
    const parameters = { library, unit, mu: view.mu, force: force.join(), moment: moment.join(), axes: plane, tolerance: DIAGRAM_TOLERANCE };
    this.#requestLatest(this.#jammingThrottle, "jamming", `${key} ${plane}`, () => this.#orProblem(async () => ({ diagram: await this.#api.jamming(pose, parameters) })));
  }

  /** Requests the path of a held bolt that the view asks for; one that was requested before and is not asked for is ended. */
  followAssembly({ library, unit, assembly }) {
    if (this.library.id !== library) return;
    const key = `${library} ${assembly} ${this.#assemblies}`;
    if (this.#requested.get("assembly") === key) return;
    const before = this.assembly?.library === library ? this.assembly : null;
    this.#endAssembly();
    this.#request("assembly", key, () => (assembly === "" ? null : this.#assembled(assembly, library, unit, before)));
  }

  /** Computes the success maps that the view asks for. */
  followSuccess({ library, unit, success, success_critical: place, kept_success: kept, kept_success_critical: keptPlace }) {
    if (this.library.id !== library) return;
    this.#request("storedMaps", `${library}`, async () => (await this.#api.get("/v1/success-maps", { library })).success_maps);
    this.success.follow(success, library, this.library.grid, unit, place);
    this.keptSuccess.follow(kept, library, this.library.grid, unit, keptPlace);
  }

  /** Has the path computed again when it is requested next, also the same one. */
  repeatAssembly() {
    this.#assemblies += 1;
  }

  #endAssembly() {
    this.#assembling.abort();
    this.assembly = null;
    this.progress = null;
  }

  /** The path of a request's text; of one that is refused the problem, beside the path `before`. */
  async #assembled(text, library, unit, before) {
    const running = new AbortController();
    this.#assembling = running;
    const progressed = (progress) => {
      if (running.signal.aborted) return;
      this.progress = progress;
      this.#onPart("progress");
    };
    try {
      const path = await this.#api.assemble(bodyOf(text, library), unit, { signal: running.signal, progressed });
      return { path, text, library };
    } catch (error) {
      if (!(error instanceof ProblemError) || error.status === UNAUTHORIZED) throw error;
      return { ...before, problem: error.message, errors: error.errors };
    }
  }

  /** A part of the answer, or {problem} where there is none for this pose. */
  async #orProblem(answer) {
    try {
      return await answer();
    } catch (error) {
      if (!(error instanceof ProblemError) || error.status !== UNRESOLVED) throw error;
      return { problem: error.message };
    }
  }

  /** Requests all formations of the network; null where the library has none. */
  followNetwork() {
    this.#request("formations", `${this.library.id}`, async () => (await this.#optional(this.#api.get(`${this.root}/network/formations`)))?.formations ?? null);
  }

  /** Requests the figures of the libraries that have histories, the present one first, and the sections of threads. */
  followThreads({ library, unit, thread }) {
    if (this.library.id !== library || this.libraries === null) return;
    const others = this.libraries.all.filter(({ id, method }) => method === "exact" && id !== library).map(({ id }) => id);
    const compared = [...(this.library.method === "exact" ? [library] : []), ...others].slice(0, MOST_COMPARED);
    this.#request("comparison", `${compared}`, () => (compared.length === 0 ? null : this.#api.get("/v1/compare", { libraries: compared.join() })));
    this.#request("profiles", `${library} ${unit} ${thread}`, async () => {
      const ofLibrary = { name: this.library.designation, svg: await this.#api.text("/v1/threads/profiles.svg", { library, unit }) };
      if (thread === "") return { pictures: [ofLibrary], problem: null };
      try {
        const ofThread = { name: thread, svg: await this.#api.text("/v1/threads/profiles.svg", { designation: thread, unit }) };
        return { pictures: [ofLibrary, ofThread], problem: null };
      } catch (error) {
        if (!(error instanceof ProblemError) || error.status !== INVALID) throw error;
        return { pictures: [ofLibrary], problem: error.message };
      }
    });
  }

  #followTolerance({ unit, library, roll, pitch, tolerance }) {
    this.#request("falls", `${library} ${unit} ${roll} ${pitch} ${tolerance}`, async () => {
      if (tolerance === null) return null;
      try {
        const response = this.#api.get(`/v1/histories/${roll}/${pitch}/falls`, { library, tolerance, unit });
        return (await this.#busy.during(`computing the falls within ±${tolerance} deg`, response)).range;
      } catch (error) {
        if (!(error instanceof ProblemError) || error.status >= 500) throw error;
        return { roll, pitch, tolerance, problem: error.message };
      }
    });
  }

  #followBeside({ unit, beside_library: id, beside_roll: roll, beside_pitch: pitch }) {
    const chosen = [id, roll, pitch].every((value) => value !== null);
    this.#request("beside", chosen ? `${id} ${unit} ${roll} ${pitch}` : "none", async () => {
      if (!chosen) return null;
      const library = await this.#optional(this.#api.get(`/v1/libraries/${id}`, { unit }));
      if (library === null) return { library: null, id, roll, pitch };
      const view = { unit, library: id, roll, pitch };
      const { heights, intervals } = await this.#depth(view, library);
      return { library, id, roll, pitch, heights, history: intervals?.history ?? null };
    });
  }

  /** Requests again what is missing, after the service was unreachable. */
  retry(view) {
    this.#requested.clear();
    this.follow(view);
  }

  /** Requests a part as the throttle allows, of several the last; one that waits is dropped where its predecessor is wanted again. */
  #requestLatest(throttle, part, key, fetchPart) {
    if (this.#requested.get(part) === key) throttle.drop();
    else throttle.run(() => this.#request(part, key, fetchPart));
  }

  /** A response that arrives after another key was requested is dropped, unless that one has not arrived and this one `isUsable` (response, key requested) until then. */
  async #request(part, key, fetchPart, isUsable = () => false) {
    if (this.#requested.get(part) === key) return;
    this.#requested.set(part, key);
    try {
      const answer = await fetchPart();
      const requested = this.#requested.get(part);
      const late = requested !== key;
      if (late && (requested === undefined || this.#arrived.get(part) === requested || !isUsable(answer, requested))) return;
      this.#arrived.set(part, key);
      if (part === "library" && answer.id !== this.library.id) this.#clear();
      this[part] = answer;
      this.#onPart(part);
    } catch (error) {
      if (this.#requested.get(part) !== key) return;
      this.#requested.delete(part);
      this.#onError(error, part);
    }
  }

  /** Clears what belongs to the library that was shown. */
  #clear() {
    this.#endAssembly();
    for (const part of OF_LIBRARY) {
      this[part] = null;
      this.#requested.delete(part);
      this.#arrived.delete(part);
    }
  }

  /** Null where the service says 404: a library by meshes has no histories, a formation may have no path. */
  async #optional(answer) {
    try {
      return await answer;
    } catch (error) {
      if (error instanceof ProblemError && error.status === NOT_FOUND) return null;
      throw error;
    }
  }

  #history({ unit, roll, pitch }, { id } = this.library) {
    return this.#api.get(`/v1/libraries/${id}/histories/${roll}/${pitch}`, { unit });
  }

  async #map(phase, unit) {
    const states = [];
    let address = null;
    do {
      const parameters = address === null ? { phase, fields: MAP_FIELDS, limit: MAP_PAGE, unit } : {};
      const page = await this.#api.get(address ?? `${this.root}/states`, parameters);
      states.push(...page.states);
      address = page.next;
    } while (address !== null);
    return { phase, states };
  }

  async #depth(view, library) {
    const [heights, intervals] = await Promise.all([this.#heights(view, library), this.#intervals(view, library)]);
    return { heights, intervals };
  }

  /** Stored where the orientation is on the grid, else computed now. */
  async #heights({ roll, pitch, unit }, library) {
    if (!isOnGrid(library.grid, { roll, pitch })) return (await this.#computed("heights", { roll, pitch, unit }, library)).heights;
    const answer = await this.#optional(this.#api.get(`/v1/libraries/${library.id}/histories/${roll}/${pitch}/heights`, { unit }));
    return answer?.heights ?? heightsOf(await this.#history({ unit, roll, pitch }, library));
  }

  #intervals({ roll, pitch, unit }, library) {
    if (!isOnGrid(library.grid, { roll, pitch })) return this.#computed("intervals", { roll, pitch, unit }, library);
    return this.#optional(this.#api.get(`/v1/libraries/${library.id}/histories/${roll}/${pitch}/intervals`, { unit }));
  }

  #computed(what, { roll, pitch, unit }, { id }) {
    const response = this.#api.get(`/v1/histories/${roll}/${pitch}/${what}`, { library: id, unit });
    return this.#busy.during(`computing the history of roll ${roll}, pitch ${pitch} deg`, response);
  }

  /** From the history where that is loaded; the first state of an orientation does not wait for it. */
  async #state({ library, roll, pitch, phase, unit }) {
    const pose = { roll, pitch, phase };
    if (!isOnGrid(this.library.grid, pose)) return this.#solvedState(pose, unit);
    const onGrid = nearestPhase(this.library.grid, phase) === phase;
    if (this.#requested.get("history") !== `${library} ${unit} ${roll} ${pitch}`) {
      return onGrid ? this.#storedState(pose, unit) : this.#solvedState(pose, unit);
    }
    const history = await this.#history({ unit, roll, pitch });
    const stored = history.states.find((state) => state.phase === phase);
    if (stored) return { pose, unit, state: stored, reason: null, stored: true };
    const undecided = history.undecided.find((one) => one.phase === phase);
    if (undecided) return { pose, unit, state: null, reason: undecided.reason, stored: true };
    return this.#solvedState(pose, unit);
  }

  async #storedState(pose, unit) {
    try {
      const { roll, pitch, phase } = pose;
      const state = await this.#api.get(`${this.root}/states/${roll}/${pitch}/${phase}`, { unit });
      return { pose, unit, state, reason: null, stored: true };
    } catch (error) {
      if (!(error instanceof ProblemError && error.status === NOT_FOUND)) throw error;
      return { pose, unit, state: null, reason: error.message, stored: true };
    }
  }

  /**
   * Solved with the pair and the tolerances of the library; of poses that come faster than one is solved the last, and null for those
   * before it.
   */
  async #solvedState(pose, unit) {
    const answers = await this.#solveThrottle.run(() => this.#solved([pose], unit));
    if (answers === undefined) return null;
    const [[state, reason]] = answers;
    return { pose, unit, state, reason, stored: false };
  }

  /** States of poses, [state, null] each, or [null, reason] where undecided. */
  async #solved(poses, unit) {
    const { id } = this.library;
    try {
      return (await this.#api.solve(poses, id, unit)).map((state) => [state, null]);
    } catch (error) {
      if (!(error instanceof ProblemError && error.status === UNRESOLVED)) throw error;
      if (poses.length === 1) return [[null, error.message]];
      const found = [];
      for (const pose of poses) found.push(...(await this.#solved([pose], unit)));
      return found;
    }
  }

  async #measured(view) {
    const poses = posesOfView(view);
    if (poses.length === 0) return [];
    const states = await this.#busy.during(`solving ${poses.length} measured poses`, this.#solved(poses, view.unit));
    return poses.map((pose, k) => ({ pose, state: states[k][0], reason: states[k][1] }));
  }

  async #located({ observed }) {
    if (observed === "") return null;
    const answer = await this.#optional(this.#api.get(`${this.root}/network/locate`, observationQuery(observed)));
    return answer?.location ?? { missing: true };
  }
}
