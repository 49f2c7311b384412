// What is remembered on this machine between visits: the unit of lengths.

const PLACE = "threadstate-unit";
const UNITS = ["in", "mm"];

/** The unit that was chosen last, or null. */
export function rememberedUnit() {
  try {
    const unit = localStorage.getItem(PLACE);
    return UNITS.includes(unit) ? unit : null;
  } catch {
    return null;
  }
}

/** Remembers a unit, where the browser lets pages remember. */
export function rememberUnit(unit) {
  try {
    localStorage.setItem(PLACE, unit);
  } catch {
    // A browser that keeps nothing shows the library's own unit next time.
  }
}
