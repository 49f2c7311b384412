// What is asked for while something moves: one at a time, not too often, and the latest in the end.

/** Runs the things it is given, never two at once and none sooner than `ms` after the one before; of several that wait, the last. */
export class Pace {
  #ms;
  #running = false;
  #waiting = null;
  #timer = null;
  #ended = -Infinity;

  constructor(ms) {
    this.#ms = ms;
  }

  /** What the thing gives, or undefined where a later one took its place. */
  run(thing) {
    this.#waiting?.done(undefined);
    return new Promise((done, failed) => {
      this.#waiting = { thing, done, failed };
      this.#next();
    });
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
    const { thing, done, failed } = this.#waiting;
    this.#waiting = null;
    this.#running = true;
    thing()
      .then(done, failed)
      .finally(() => {
        this.#running = false;
        this.#ended = performance.now();
        this.#next();
      });
  }
}
