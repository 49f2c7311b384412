// The first question, asked while the other modules are still being fetched: which library the link is about.

import { keptKey } from "./kept_key.js";
import { rememberedUnit } from "./remembered.js";

const asked = new Map();

/** The answer that is on its way from an address, to be taken once; undefined where it was not asked. */
export function takeEarly(address) {
  const answer = asked.get(address);
  asked.delete(address);
  return answer;
}

/** The address of the library of a fragment; null where the fragment may need a closer look. */
export function libraryAddress(fragment, remembered) {
  const { library = "latest", unit = remembered } = Object.fromEntries(new URLSearchParams(fragment.replace(/^#/, "")));
  if (!/^([0-9]{1,15}|latest)$/.test(library) || ![null, "in", "mm"].includes(unit)) return null;
  return `/v1/libraries/${library === "latest" ? library : Number(library)}${unit === null ? "" : `?unit=${unit}`}`;
}

if (typeof location !== "undefined") {
  const address = libraryAddress(location.hash, rememberedUnit());
  const key = keptKey();
  if (address !== null) {
    const answer = fetch(address, { headers: key === null ? {} : { Authorization: `Bearer ${key}` } });
    // Whoever takes the answer is told of the failure.
    answer.catch(() => {});
    asked.set(address, answer);
  }
}
