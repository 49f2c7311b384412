// What is only done once nothing has changed for a while.

/** Does the latest of the things it is given when no other has come for `ms`. */
export class Rest {
  #ms;
  #timer = null;

  constructor(ms) {
    this.#ms = ms;
  }

  after(thing) {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(thing, this.#ms);
  }
}
