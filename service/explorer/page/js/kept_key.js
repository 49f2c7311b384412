// The key for reading: kept in this tab's session alone, shown in a header and never in an address.

const PLACE = "threadstate-key";

/** The key that was given in this tab, or null. */
export function keptKey() {
  return sessionStorage.getItem(PLACE);
}

/** Keeps a key until the tab is closed. */
export function keepKey(key) {
  sessionStorage.setItem(PLACE, key);
}

export function forgetKey() {
  sessionStorage.removeItem(PLACE);
}
