// Debounced calls: made once nothing has changed for a while.

/** Calls the latest of the functions it is given when no other has come for `ms` and for a frame, however long that takes. */
export class Debounce {
  #ms;
  #timer = null;
  #frame = null;

  constructor(ms) {
    this.#ms = ms;
  }

  run(call) {
    clearTimeout(this.#timer);
    cancelAnimationFrame(this.#frame);
    this.#timer = setTimeout(() => {
      this.#frame = requestAnimationFrame(() => (this.#timer = setTimeout(call)));
    }, this.#ms);
  }
}
