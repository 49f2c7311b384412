// The first request, sent while the other modules are still being fetched: the library of the link.

import { storedKey } from "./api_key.js";
import { preferredUnit } from "./preferences.js";

const requests = new Map();

/** The response promise of an address, to be taken once; undefined where it was not requested. */
export function takePrefetched(address) {
  const answer = requests.get(address);
  requests.delete(address);
  return answer;
}

/** The address of the library of a fragment; null where the fragment may need a closer look. */
export function libraryAddress(fragment, preferred) {
  const { library = "latest", unit = preferred } = Object.fromEntries(new URLSearchParams(fragment.replace(/^#/, "")));
  if (!/^([0-9]{1,15}|latest)$/.test(library) || ![null, "in", "mm"].includes(unit)) return null;
  return `/v1/libraries/${library === "latest" ? library : Number(library)}${unit === null ? "" : `?unit=${unit}`}`;
}

if (typeof location !== "undefined") {
  const address = libraryAddress(location.hash, preferredUnit());
  const key = storedKey();
  if (address !== null) {
    const answer = fetch(address, { headers: key === null ? {} : { Authorization: `Bearer ${key}` } });
    // The failure is handled where the response is taken.
    answer.catch(() => {});
    requests.set(address, answer);
  }
}
