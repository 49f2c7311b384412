// Something that is played frame by frame until it ends or is stopped.

/** Plays one thing at a time; `onChange` is called with the name of what plays, or null. */
export class Player {
  #frame = null;
  #playing = null;
  #onChange;

  constructor(onChange) {
    this.#onChange = onChange;
  }

  get playing() {
    return this.#playing;
  }

  /** Starts what `step` makes of the seconds since the start, until it returns false; stops what played before. */
  play(name, step) {
    this.stop();
    this.#playing = name;
    this.#onChange(name);
    const begun = performance.now();
    const next = (now) => {
      if (step(Math.max(now - begun, 0) / 1000)) this.#frame = requestAnimationFrame(next);
      else this.stop();
    };
    this.#frame = requestAnimationFrame(next);
  }

  stop() {
    if (this.#playing === null) return;
    cancelAnimationFrame(this.#frame);
    this.#playing = null;
    this.#onChange(null);
  }
}

/** Whether the reader prefers less motion. */
export function prefersReducedMotion() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}
