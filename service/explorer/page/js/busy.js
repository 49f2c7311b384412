// Shows what is being computed where that takes longer than a moment.

const MOMENT_MS = 350;

/** Calls `show` with the texts of what goes on for longer than a moment, latest last; with none when all is done. */
export class Busy {
  #show;
  #shown = new Map();

  constructor(show) {
    this.#show = show;
  }

  /** Waits for a promise, and shows the text meanwhile. */
  async during(text, promise) {
    const own = Symbol(text);
    const timer = setTimeout(() => {
      this.#shown.set(own, text);
      this.#update();
    }, MOMENT_MS);
    try {
      return await promise;
    } finally {
      clearTimeout(timer);
      if (this.#shown.delete(own)) this.#update();
    }
  }

  #update() {
    this.#show([...new Set(this.#shown.values())]);
  }
}
