// Preferences stored in this browser between visits: the unit of lengths.

const STORAGE_KEY = "threadstate-unit";
const UNITS = ["in", "mm"];

/** The unit that was chosen last, or null. */
export function preferredUnit() {
  try {
    const unit = localStorage.getItem(STORAGE_KEY);
    return UNITS.includes(unit) ? unit : null;
  } catch {
    return null;
  }
}

/** Stores the unit, where the browser allows it. */
export function storePreferredUnit(unit) {
  try {
    localStorage.setItem(STORAGE_KEY, unit);
  } catch {
    // Without storage the library's own unit is shown next time.
  }
}
