// What the page shows: one value that everything follows.

/** What is shown where an address says nothing else. */
export const DEFAULTS = Object.freeze({
  library: null,
  roll: 0,
  pitch: -4,
  phase: 10,
  unit: null,
  theme: "auto",
  quantity: "class",
  over: "phase",
  from: 0,
  span: 360,
  stage: 3,
  tab: "state",
  nut: "cut",
  azimuth: -60,
  elevation: 25,
  distance: 2.1,
});

/** The present view, and who follows it. */
export class View {
  #value;
  #followers = [];

  constructor(value) {
    this.#value = Object.freeze({ ...DEFAULTS, ...value });
  }

  get value() {
    return this.#value;
  }

  /** Changes some of the view; followers hear of it where anything differs. */
  set(changes) {
    const next = Object.freeze({ ...this.#value, ...changes });
    const changed = Object.keys(next).filter((key) => next[key] !== this.#value[key]);
    if (changed.length === 0) return;
    this.#value = next;
    for (const follower of this.#followers) follower(next, new Set(changed));
  }

  follow(follower) {
    this.#followers.push(follower);
  }
}
