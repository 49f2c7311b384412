// The state of the page: one value that everything is drawn from.

/** The defaults, used where an address says nothing else. */
export const DEFAULTS = Object.freeze({
  library: null,
  roll: 0,
  pitch: -4,
  phase: 10,
  tolerance: null,
  unit: null,
  theme: "auto",
  quantity: "class",
  over: "phase",
  /** Where the range of phases begins; null: where the main event is in the middle. */
  from: null,
  span: 360,
  stage: 3,
  tab: "state",
  nut: "cut",
  azimuth: -60,
  elevation: 25,
  distance: 2.1,
  beside_library: null,
  beside_roll: null,
  beside_pitch: null,
  /** Measured poses, as `poses.js` writes them. */
  poses: "",
  /** What was observed of a state, as `observation.js` writes it. */
  observed: "",
  /** The load, as `load.js` reads it, with the friction of all contacts, and the plane of loads of the diagram. */
  mu: 0.2,
  push: 1,
  fx: 0,
  fy: 0,
  mx: 0,
  my: 0,
  mz: 0,
  plane: "fx,my",
  /** The path of a held bolt that is asked for, as `assembly.js` writes it, and which of its points is shown. */
  assembly: "",
  point: 0,
  /** The success map that is asked for, as `success_map.js` writes it, and the one that is kept beside it. */
  success: "",
  kept_success: "",
  /** The orientation that is chosen in it, as "roll pitch", and of each map the one whose critical friction was asked for last. */
  success_at: "",
  success_critical: "",
  kept_success_critical: "",
  /** Designation of a thread whose section is shown beside the library's. */
  thread: "",
});

/** Most characters of a designation. */
export const THREAD_LENGTH = 100;

const PART_LIMITS = [-100, 100];
/** The least and the largest value of the load's numbers. */
export const LOAD_LIMITS = { mu: [0, 10], push: [1e-3, 1e6], fx: PART_LIMITS, fy: PART_LIMITS, mx: PART_LIMITS, my: PART_LIMITS, mz: PART_LIMITS };

/** The present view, and its listeners. */
export class View {
  #value;
  #followers = [];

  constructor(value) {
    this.#value = Object.freeze({ ...DEFAULTS, ...value });
  }

  get value() {
    return this.#value;
  }

  /**
   * Changes some of the view; listeners are called where anything differs: the view, the names of what changed, and `how`
   * it came about ("entry": a step of its own in the browser's history; "restored": the browser went back or forward; "corrected": what was requested does not exist).
   */
  set(changes, how = null) {
    const next = Object.freeze({ ...this.#value, ...changes });
    const changed = Object.keys(next).filter((key) => next[key] !== this.#value[key]);
    if (changed.length === 0) return;
    this.#value = next;
    for (const follower of this.#followers) follower(next, new Set(changed), how);
  }

  follow(follower) {
    this.#followers.push(follower);
  }
}
