// Throttled calls: one at a time, not too often, and always the latest.

/** Runs the async functions it is given, never two at once and none sooner than `ms` after the one before; of several that wait, the last. */
export class Throttle {
  #ms;
  #running = false;
  #waiting = null;
  #timer = null;
  #ended = -Infinity;

  constructor(ms) {
    this.#ms = ms;
  }

  /** The result of the call, or undefined where a later one replaced it. */
  run(call) {
    this.drop();
    return new Promise((done, failed) => {
      this.#waiting = { call, done, failed };
      this.#next();
    });
  }

  /** Drops the call that waits, if one does. */
  drop() {
    this.#waiting?.done(undefined);
    this.#waiting = null;
  }

  #next() {
    if (this.#running || this.#waiting === null || this.#timer !== null) return;
    const wait = this.#ended + this.#ms - performance.now();
    if (wait > 0) {
      this.#timer = setTimeout(() => {
        this.#timer = null;
        this.#next();
      }, wait);
      return;
    }
    const { call, done, failed } = this.#waiting;
    this.#waiting = null;
    this.#running = true;
    call()
      .then(done, failed)
      .finally(() => {
        this.#running = false;
        this.#ended = performance.now();
        this.#next();
      });
  }
}
