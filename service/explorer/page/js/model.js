// What the service says of the present view; whoever draws it is told of each part as it comes.

import { ProblemError } from "./api.js";
import { heightsOf } from "./curve.js";
import { nearestPhase } from "./grid.js";
import { needsSummaries } from "./quantities.js";
import { Rest } from "./rest.js";

const MAP_FIELDS = "roll,pitch,class,drop,embedment,pivot_offset,margins";
const MAP_PAGE = 1000;
/** While the phase moves nothing is asked for; what belongs to a phase is asked for when it has come to rest. */
const REST_MS = 150;

/** The parts of the model, each null until it has come. */
export class Model {
  library = null;
  orientations = null;
  windows = null;
  map = null;
  history = null;
  heights = null;
  intervals = null;
  state = null;
  node = null;
  path = null;
  formations = null;

  #api;
  #told;
  #failed;
  #wanted = new Map();
  #mapRest = new Rest(REST_MS);
  #formationRest = new Rest(REST_MS);

  /** `told` is called with the name of a part that has come, `failed` with an error. */
  constructor(api, told, failed) {
    this.#api = api;
    this.#told = told;
    this.#failed = failed;
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

  /** Asks for everything of a view that is not here yet. */
  follow(view) {
    const { roll, pitch, phase } = view;
    const unit = view.unit;
    if (this.library.unit !== unit) {
      this.#want("library", unit, () => this.#api.get(this.root, { unit }));
    }
    if (needsSummaries(view)) this.#askForSummaries(unit);
    this.#want("state", `${unit} ${roll} ${pitch} ${phase}`, () => this.#state(view));
    this.#want("heights", `${unit} ${roll} ${pitch}`, () => this.#heights(view));
    this.#want("intervals", `${unit} ${roll} ${pitch}`, () =>
      this.#optional(this.#api.get(`${this.root}/histories/${roll}/${pitch}/intervals`, { unit })),
    );
    const onGrid = nearestPhase(this.library.grid, phase);
    const askForMap = () => this.#want("map", `${unit} ${onGrid}`, () => this.#map(onGrid, unit));
    if (this.map === null) askForMap();
    else this.#mapRest.after(askForMap);
  }

  #askForSummaries(unit) {
    this.#want("orientations", unit, async () => (await this.#api.get(`${this.root}/orientations`, { unit })).orientations);
    this.#want("windows", unit, () => this.#optional(this.#api.get(`${this.root}/windows`, { unit })));
  }

  /** Asks for the history of a view's orientation, whose states then need not be asked for one by one. */
  followHistory({ unit, roll, pitch }) {
    this.#want("history", `${unit} ${roll} ${pitch}`, () => this.#history({ unit, roll, pitch }));
  }

  /** Asks for a formation and its way to the window; both null where the pose has none. */
  followFormation(view, interval) {
    this.#formationRest.after(() => this.#askForFormation(view, interval));
  }

  #askForFormation({ unit, roll, pitch }, interval) {
    const key = interval?.formation.key ?? null;
    this.#want("node", `${unit} ${key}`, async () =>
      key === null ? null : this.#optional(this.#api.get(`${this.root}/network/formations/${key}`, { unit })),
    );
    this.#want("path", `${unit} ${roll} ${pitch} ${interval?.start}`, async () =>
      key === null
        ? null
        : this.#optional(this.#api.get(`${this.root}/network/paths`, { from: key, roll, pitch, phase: interval.inside, unit })),
    );
  }

  /** Asks for all formations of the network; null where the library has none. */
  followNetwork() {
    this.#want("formations", "all", async () => (await this.#optional(this.#api.get(`${this.root}/network/formations`)))?.formations ?? null);
  }

  /** Asks again for what has not come, after the service was lost. */
  retry(view) {
    this.#wanted.clear();
    this.follow(view);
  }

  async #want(part, key, ask) {
    if (this.#wanted.get(part) === key) return;
    this.#wanted.set(part, key);
    try {
      const answer = await ask();
      if (this.#wanted.get(part) !== key) return;
      this[part] = answer;
      this.#told(part);
    } catch (error) {
      if (this.#wanted.get(part) !== key) return;
      this.#wanted.delete(part);
      this.#failed(error);
    }
  }

  /** Null where there is no such thing: a library by meshes has no histories, a formation may have no way. */
  async #optional(answer) {
    try {
      return await answer;
    } catch (error) {
      if (error instanceof ProblemError && error.status === 404) return null;
      throw error;
    }
  }

  #history({ unit, roll, pitch }) {
    return this.#api.get(`${this.root}/histories/${roll}/${pitch}`, { unit });
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

  async #heights({ roll, pitch, unit }) {
    const answer = await this.#optional(this.#api.get(`${this.root}/histories/${roll}/${pitch}/heights`, { unit }));
    return answer?.heights ?? heightsOf(await this.#history({ unit, roll, pitch }));
  }

  /** From the history where that is here; the first state of an orientation does not wait for it. */
  async #state({ roll, pitch, phase, unit }) {
    const pose = { roll, pitch, phase };
    const onGrid = nearestPhase(this.library.grid, phase) === phase;
    if (this.#wanted.get("history") !== `${unit} ${roll} ${pitch}`) {
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
      if (!(error instanceof ProblemError && error.status === 404)) throw error;
      return { pose, unit, state: null, reason: error.message, stored: true };
    }
  }

  async #solvedState(pose, unit) {
    try {
      const [state] = await this.#api.solve([pose], this.library.designation, unit);
      return { pose, unit, state, reason: null, stored: false };
    } catch (error) {
      if (error instanceof ProblemError && error.status === 422) {
        return { pose, unit, state: null, reason: error.message, stored: false };
      }
      throw error;
    }
  }
}
