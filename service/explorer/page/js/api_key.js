// The API key: stored for this tab's session alone, sent in a header and never in an address.

const STORAGE_KEY = "threadstate-key";

/** The key that was entered in this tab, or null. */
export function storedKey() {
  return sessionStorage.getItem(STORAGE_KEY);
}

/** Stores a key until the tab is closed. */
export function storeKey(key) {
  sessionStorage.setItem(STORAGE_KEY, key);
}

export function forgetKey() {
  sessionStorage.removeItem(STORAGE_KEY);
}
