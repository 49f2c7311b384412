// What is only done once nothing has changed for a while.

/** Does the latest of the things it is given when no other has come for `ms` and for a frame, however long that takes. */
export class Rest {
  #ms;
  #timer = null;
  #frame = null;

  constructor(ms) {
    this.#ms = ms;
  }

  after(thing) {
    clearTimeout(this.#timer);
    cancelAnimationFrame(this.#frame);
    this.#timer = setTimeout(() => {
      this.#frame = requestAnimationFrame(() => (this.#timer = setTimeout(thing)));
    }, this.#ms);
  }
}
