// Success maps of the page: how the paths of a device end over orientations, computed a few at a time or read as stored.

import { NUMBERS, assemblyText, bodyOf, checkedAssembly, requestOf, requestOfDevice } from "./assembly.js";
import { ProblemError } from "./api.js";
import { tilts } from "./grid.js";

/** How many starting phases an orientation can have, evenly spaced from 0. */
export const PHASE_COUNTS = [1, 2, 3, 4, 6, 8, 12, 24];
export const OUTCOMES = {
  engaged: { name: "engages", letter: "✓" },
  cross_threaded: { name: "cross-threads", letter: "×" },
  jammed: { name: "jams", letter: "j" },
  no_snap: { name: "does not snap", letter: "–" },
  idle: { name: "turns idly", letter: "–" },
  slipped: { name: "slips off", letter: "s" },
  over_travel: { name: "passes the travel", letter: "t" },
  undecided: { name: "undecided", letter: "?" },
};
/** Seconds after which a path is not followed any more: below the service's own time limit. */
const TIME_S = 20;
/** Frictions at which a critical one is bracketed before it is bisected, and how far. */
const BRACKET = [0.05, 0.1, 0.2, 0.4, 0.8];
const TOLERANCE = 0.01;
/** How far a hand turns clockwise, and counter-clockwise at most (deg). */
const CLOCKWISE = 270;
const LARGEST_TURN = 450;
const UNAUTHORIZED = 401;
/** What a map's text has before the device: the number of a stored map, and how many phases. */
const HEAD = /^(?:stored=([0-9]{1,15})&)?phases=([0-9]{1,5})&/;
/** Orientations of a stored map that are read at once. */
const PAGE = 1000;

/** The text of a map's request: how many phases, and the device, strategy and friction as `assembly.js` writes them. No path of a map is confirmed by itself. */
export function mapText(phases, request) {
  return `phases=${phases}&${assemblyText({ ...request, roll: "0", pitch: "0", phase: "0", confirm: "no" })}`;
}

/** The text of a map that the service has stored, at one of its frictions; null where the page has no fields for its device. */
export function storedMapText({ id, device, strategy, grid }, mu) {
  const request = requestOfDevice(device);
  return request && `stored=${id}&${mapText(Math.round(360 / grid.phase_step), { ...request, strategy, mu: mu === 0 ? "" : String(mu) })}`;
}

/** A map's request: {stored, phases, request}; `stored` is the number of a stored map, null where it is computed here. */
export function mapRequestOf(text) {
  const given = new URLSearchParams(text);
  const stored = given.get("stored");
  return { stored: stored && Number(stored), phases: Number(given.get("phases")), request: requestOf(assemblyOf(text)) };
}

/** The text where it is one as the page writes it, else undefined. */
export function checkedMap(text) {
  const [, stored, phases] = text.match(HEAD) ?? [];
  const isKnown = stored === undefined ? PHASE_COUNTS.includes(Number(phases)) : Number(phases) > 0;
  return isKnown && checkedAssembly(assemblyOf(text)) !== undefined && mapRequestOf(text).request.confirm === "no" ? text : undefined;
}

/** The text of the path of a map that starts at an orientation and phase. */
export function pathText(text, { roll, pitch, phase }) {
  const { request } = mapRequestOf(text);
  return assemblyText({ ...request, roll: String(roll), pitch: String(pitch), phase: String(phase) });
}

export function keyOf({ roll, pitch }) {
  return `${roll} ${pitch}`;
}

/** The orientation of a text as `keyOf` has it, {roll, pitch}; null where it is none. */
export function placeOf(text) {
  const [roll, pitch] = text.split(" ").map(Number);
  return text === "" || pitch === undefined ? null : { roll, pitch };
}

/** The orientations of a grid, those nearest to level first. */
export function orientationsOf(grid) {
  const angles = tilts(grid);
  const all = angles.flatMap((roll) => angles.map((pitch) => ({ roll, pitch })));
  return all.sort((a, b) => Math.hypot(a.roll, a.pitch) - Math.hypot(b.roll, b.pitch) || a.roll - b.roll || a.pitch - b.pitch);
}

/** What the paths of an orientation say: how many engage, how many are undecided, and the one that is worst. */
export function cellOf(outcomes) {
  const engaged = outcomes.filter(({ outcome }) => outcome === "engaged");
  const undecided = outcomes.filter(({ outcome }) => outcome === "undecided");
  const failed = outcomes.filter((one) => !engaged.includes(one) && !undecided.includes(one));
  const hardest = [...engaged].sort((a, b) => (b.torque ?? 0) - (a.torque ?? 0));
  return { count: outcomes.length, engaged: engaged.length, undecided: undecided.length, worst: failed[0] ?? undecided[0] ?? hardest[0] };
}

/** The poses of an orientation of a map. */
function posesOf({ roll, pitch }, phases) {
  return Array.from({ length: phases }, (_, k) => ({ roll, pitch, phase: (360 * k) / phases }));
}

/** Whether the outcomes of an orientation are there from every phase of the map. */
export function isWhole({ text }, outcomes) {
  return outcomes?.length === mapRequestOf(text).phases;
}

/**
 * The paths by `ccw_then_cw` that end before a snap that others of their orientation meet: {paths, turn}; `turn` (deg) is
 * the counter-clockwise turn that reaches all those snaps, of the turns that a hand can make.
 */
export function lateSnapsOf({ text, cells }) {
  const { request } = mapRequestOf(text);
  const turn = Number(request.ccw_turn || NUMBERS.ccw_turn.default);
  const turns = request.strategy === "cw" ? [] : [...cells.values()].flatMap((outcomes) => {
    const ended = (name) => outcomes.filter(({ outcome, end }) => outcome === name && end !== null);
    return ended("no_snap").flatMap(({ phase, end }) => {
      // After the whole turn the hand goes back through CLOCKWISE: a left-hand bolt's goes the other way round.
      const hand = Math.sign((end - phase) * (turn - CLOCKWISE)) || 1;
      const beyond = ended("engaged").map((one) => modulo(hand * (one.end - phase) + CLOCKWISE - turn, 360));
      return beyond.length > 0 ? [turn + Math.min(...beyond)] : [];
    });
  });
  const reached = turns.filter((one) => one <= LARGEST_TURN);
  return { paths: reached.length, turn: reached.length > 0 ? Math.max(...reached) : null };
}

/** What a map says of its whole orientations: {orientations, done, engaged, undecided, failure, torque, tilt, shift}. */
export function totalsOf(map) {
  const { grid, cells } = map;
  const done = orientationsOf(grid).filter((one) => isWhole(map, cells.get(keyOf(one))));
  const found = done.map((one) => ({ ...one, ...cellOf(cells.get(keyOf(one))) }));
  const whole = found.filter(({ engaged, count }) => engaged === count);
  const paths = [...cells.values()].flat().filter(({ outcome }) => outcome === "engaged");
  const most = (name) => Math.max(0, ...paths.map((one) => one[name] ?? 0));
  return {
    orientations: tilts(grid).length ** 2,
    done: done.length,
    engaged: whole.length,
    undecided: found.filter(({ engaged, undecided, count }) => engaged < count && engaged + undecided === count).length,
    failure: found.find(({ engaged, undecided, count }) => engaged + undecided < count) ?? null,
    torque: most("torque"),
    tilt: most("tilt"),
    shift: most("shift"),
  };
}

/** One map: requested, filled in while it is computed or read, ended where it is no longer wanted. */
export class SuccessMap {
  /**
   * Null where nothing is asked for: {text, unit, library, grid, cells, criticals, isRunning, problem, errors}. The critical
   * frictions, by orientation, are those that were asked for: {roll, pitch, last, first, outcome, isRunning}.
   */
  value = null;
  #api;
  #changed;
  #key = "";
  #running = new AbortController();
  #bracketing = new AbortController();

  constructor(api, changed) {
    this.#api = api;
    this.#changed = changed;
  }

  /**
   * Computes or reads the map of a text with the pair of a library, then the critical friction of an orientation that is
   * given as "roll pitch"; the map before is ended. An empty text: none.
   */
  follow(text, library, grid, unit, place = "") {
    const key = keyOfMap(text, library);
    if (key === this.#key) return;
    this.cancel();
    this.#key = key;
    const before = this.value;
    this.value = text === "" ? null : { text, unit, library, grid, cells: new Map(), criticals: new Map(), isRunning: true, problem: null, errors: [] };
    this.#changed();
    if (this.value !== null) this.#fill(this.value, before, placeOf(place), this.#running.signal);
  }

  /** Takes over what is there of another map. */
  adopt({ value }) {
    this.cancel();
    this.#key = keyOfMap(value.text, value.library);
    this.value = { ...value, cells: new Map(value.cells), criticals: new Map(value.criticals), isRunning: false, problem: null, errors: [] };
    this.#changed();
  }

  /** Whether something is being computed. */
  get isRunning() {
    return this.value !== null && (this.value.isRunning || [...this.value.criticals.values()].some((one) => one.isRunning));
  }

  /** Computes no further; what is there stays. */
  cancel() {
    this.#running.abort();
    this.#bracketing.abort();
    this.#running = new AbortController();
    if (this.value?.isRunning) {
      this.value.isRunning = false;
      this.#changed();
    }
  }

  /** Where it is refused before anything is there, the map before it stays, with the problem. */
  async #fill(map, before, place, signal) {
    try {
      await (mapRequestOf(map.text).stored === null ? this.#compute(map, signal) : this.#read(map, signal));
    } catch (error) {
      if (signal.aborted) return;
      this.#running.abort();
      if (!(error instanceof ProblemError) || error.status === UNAUTHORIZED) map.problem = error.message;
      else [map.problem, map.errors] = [error.message, error.errors];
    }
    if (this.value !== map || map.isRunning === false) return;
    map.isRunning = false;
    if (map.problem !== null && map.cells.size === 0 && before !== null) this.value = { ...before, problem: map.problem, errors: map.errors };
    this.#changed();
    if (map.problem === null && place !== null) await this.findCritical(place);
  }

  async #compute(map, signal) {
    const { phases } = mapRequestOf(map.text);
    const orientations = orientationsOf(map.grid);
    const take = async ({ place, poses }) => {
      const found = await this.#outcomes(map, poses, null, signal);
      map.cells.set(keyOf(place), [...(map.cells.get(keyOf(place)) ?? []), ...found]);
      if (!signal.aborted) this.#changed();
    };
    const lane = async (following) => {
      for (let next = following(); next !== undefined && !signal.aborted; next = following()) await take(next);
    };
    // First the paths from phase 0 alone: the whole map is seen long before the paths from all phases are there.
    for (const [from, to] of [[0, 1], [1, phases]]) {
      const left = from < to ? orientations.map((place) => ({ place, poses: posesOf(place, phases).slice(from, to) })) : [];
      // The first one alone: what is refused is refused once.
      if (map.cells.size === 0) await take(left.pop());
      // From level outwards and from the corners inwards: level paths take longest, those that do not snap least.
      await Promise.all([lane(() => left.shift()), lane(() => left.pop())]);
    }
  }

  /** Reads a stored map; another one than the text says has been stored under its number elsewhere. */
  async #read(map, signal) {
    const { stored, phases, request } = mapRequestOf(map.text);
    const address = `/v1/success-maps/${stored}`;
    const found = await this.#api.get(address);
    const mu = Number(request.mu);
    if (!found.mu.includes(mu) || storedMapText(found, mu) !== map.text) throw new Error(`the stored map ${stored} is another one than that of the link`);
    map.grid = found.grid;
    for (let page = `${address}/orientations?limit=${PAGE}&unit=${map.unit}`; page !== null && !signal.aborted; ) {
      const { orientations, next } = await this.#api.get(page);
      for (const { roll, pitch, cells } of orientations) map.cells.set(keyOf({ roll, pitch }), ofGrid(cells, mu, phases).map((cell) => ({ roll, pitch, ...cell })));
      if (!signal.aborted) this.#changed();
      page = next;
    }
  }

  /** Narrows down the friction up to which all starting phases of an orientation engage. */
  async findCritical(place) {
    this.#bracketing.abort();
    const bracketing = (this.#bracketing = new AbortController());
    const map = this.value;
    const poses = posesOf(place, mapRequestOf(map.text).phases);
    const found = { ...place, last: null, first: null, outcome: null, isRunning: true };
    map.criticals.set(keyOf(place), found);
    this.#changed();
    const engagesAt = async (mu) => {
      const { engaged, count, worst } = cellOf(await this.#outcomes(map, poses, mu, bracketing.signal));
      if (engaged === count) found.last = mu;
      else [found.first, found.outcome] = [mu, worst.outcome];
      this.#changed();
      return engaged === count;
    };
    try {
      if (await engagesAt(0)) {
        for (const mu of BRACKET) if (!(await engagesAt(mu))) break;
        while (found.first !== null && found.first - found.last > TOLERANCE + 1e-9) {
          await engagesAt(Number((0.5 * (found.last + found.first)).toFixed(4)));
        }
      }
    } catch (error) {
      if (!bracketing.signal.aborted) found.problem = error.message;
    }
    found.isRunning = false;
    this.#changed();
  }

  /** How the paths from poses end; one that alone takes longer than its time, or the service's time limit, is undecided. */
  async #outcomes({ text, library, unit }, poses, mu, signal) {
    const body = { ...bodyOf(assemblyOf(text), library), ...(mu !== null && { mu }), time_limit: TIME_S };
    delete body.pose;
    const asked = async (some) => {
      try {
        return await this.#api.outcomes({ ...body, poses: some }, unit, signal);
      } catch (error) {
        if (!isOutOfTime(error)) throw error;
        return some.map((pose) => unanswered(pose, body));
      }
    };
    const found = await asked(poses);
    if (poses.length === 1) return found;
    const again = [];
    for (const [k, one] of found.entries()) again.push(...(one.bounded ? await asked([poses[k]]) : [one]));
    return again;
  }
}

function modulo(value, by) {
  return ((value % by) + by) % by;
}

/** Of the paths of an orientation those at a friction from the phases of the grid; a map has more beside boundaries. */
function ofGrid(cells, mu, phases) {
  const steps = (phase) => (phase * phases) / 360;
  return cells.filter((cell) => cell.mu === mu && Math.abs(steps(cell.phase) - Math.round(steps(cell.phase))) < 1e-9);
}

function isOutOfTime(error) {
  return error instanceof ProblemError && error.type.endsWith("out-of-time");
}

/** The outcome of a path that the service has no time for. */
function unanswered(pose, { mu = 0 }) {
  const nothing = { torque: null, tilt: null, shift: null, end: null };
  return { ...pose, mu, outcome: "undecided", flags: [], bounded: true, ...nothing };
}

function keyOfMap(text, library) {
  return text === "" ? "" : `${library} ${text}`;
}

function assemblyOf(text) {
  return text.replace(HEAD, "");
}
