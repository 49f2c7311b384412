// The service's answers, each asked for once.

import { takeEarly } from "./early.js";

const KEPT = 200;

/** The service answered with a problem document. */
export class ProblemError extends Error {
  constructor(status, problem) {
    super(problem.detail ?? problem.title);
    this.status = status;
    this.type = problem.type ?? "";
  }
}

/** The service did not answer. */
export class LostError extends Error {}

/** Asks one service; what a library's number stands in never changes, so its responses are cached. */
export class Api {
  #answers = new Map();
  #key;

  /** `key` is shown with every request; null: none. */
  constructor(key) {
    this.#key = key;
  }

  get hasKey() {
    return this.#key !== null;
  }

  /** Shows another key from now on. */
  use(key) {
    this.#key = key;
  }

  /** The JSON at a path with these parameters; null and undefined ones are left out. */
  get(path, parameters = {}) {
    const address = addressOf(path, parameters);
    const known = this.#answers.get(address);
    if (known) return known;
    const answer = this.#ask(address);
    this.#answers.set(address, answer);
    if (this.#answers.size > KEPT) this.#answers.delete(this.#answers.keys().next().value);
    answer.catch(() => this.#answers.delete(address));
    return answer;
  }

  /** The JSON at a path as it is now. */
  getAnew(path) {
    return this.#ask(path);
  }

  /** The states of poses, on the grid or not, by the exact solver with the pair and the tolerances of a library. */
  async solve(poses, library, unit) {
    const body = JSON.stringify({ library, poses });
    const answer = await this.#ask(addressOf("/v1/solve", { unit }), {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body,
    });
    return answer.states;
  }

  /** The bytes at a path. */
  async bytes(path) {
    return (await this.#fetched(path)).arrayBuffer();
  }

  async #ask(address, options = {}) {
    return (await this.#fetched(address, options)).json();
  }

  async #fetched(address, options = {}) {
    const headers = { ...options.headers, ...(this.hasKey && { Authorization: `Bearer ${this.#key}` }) };
    let response;
    try {
      response = await ((options.method === undefined && takeEarly(address)) || fetch(address, { ...options, headers }));
    } catch (error) {
      throw new LostError(`no answer from the service: ${error.message}`);
    }
    if (!response.ok) throw new ProblemError(response.status, await response.json().catch(() => ({ title: response.statusText })));
    return response;
  }
}

/** Path and query; a plus sign is escaped, as moves have one. */
function addressOf(path, parameters) {
  const given = Object.entries(parameters).filter(([, value]) => value !== null && value !== undefined);
  const query = given.map(([name, value]) => `${name}=${encodeURIComponent(value)}`).join("&");
  return query ? `${path}?${query}` : path;
}
