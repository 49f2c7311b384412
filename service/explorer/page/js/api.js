// Requests to the service; each response is cached.

import { eventsOf, textOf } from "./events.js";
import { takePrefetched } from "./prefetch.js";

const CACHE_SIZE = 200;

/** The service answered with a problem document. */
export class ProblemError extends Error {
  constructor(status, problem) {
    super(problem.detail ?? problem.title);
    this.status = status;
    this.type = problem.type ?? "";
    /** The values that were refused: {location, value, valid}. */
    this.errors = problem.errors ?? [];
  }
}

/** The service did not answer. */
export class UnreachableError extends Error {}

/** Sends requests to one service. What a library's number refers to never changes, so its responses are cached. */
export class Api {
  #cache = new Map();
  #key;

  /** `key` is sent with every request; null: none. */
  constructor(key) {
    this.#key = key;
  }

  get hasKey() {
    return this.#key !== null;
  }

  /** Sends another key from now on. */
  use(key) {
    this.#key = key;
  }

  /** The JSON at a path with these parameters; null and undefined ones are left out. */
  get(path, parameters = {}) {
    const address = addressOf(path, parameters);
    const cached = this.#cache.get(address);
    if (cached) return cached;
    const answer = this.#fetchJson(address);
    this.#cache.set(address, answer);
    if (this.#cache.size > CACHE_SIZE) this.#cache.delete(this.#cache.keys().next().value);
    answer.catch(() => this.#cache.delete(address));
    return answer;
  }

  /** The JSON at a path, not from the cache. */
  getFresh(path) {
    return this.#fetchJson(path);
  }

  /** The states of poses, on the grid or not, by the exact solver with the pair and the tolerances of a library. */
  async solve(poses, library, unit) {
    const body = JSON.stringify({ library, poses });
    const answer = await this.#fetchJson(addressOf("/v1/solve", { unit }), {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body,
    });
    return answer.states;
  }

  /** What a load does to a pose, with the wrenches of its contacts, with the pair and the tolerances of a library. */
  async statics(pose, load, library, unit) {
    const body = JSON.stringify({ library, poses: [pose], loads: [load], include: ["wrenches"] });
    const answer = await this.#fetchJson(addressOf("/v1/statics", { unit }), {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body,
    });
    return answer.statics[0];
  }

  /** The jamming diagram of a pose, with the pair and the tolerances of a library; not cached, as loads are many. */
  jamming({ roll, pitch, phase }, parameters) {
    return this.#fetchJson(addressOf(`/v1/states/${roll}/${pitch}/${phase}/jamming`, parameters));
  }

  /** The path of a held bolt; `progressed` is called with how far it is, and nothing is computed any further once `signal` is aborted. */
  async assemble(body, unit, { signal, progressed }) {
    const response = await this.#fetch(addressOf("/v1/assemblies", { unit }), {
      method: "POST",
      headers: { "Content-Type": "application/json", Accept: "text/event-stream" },
      body: JSON.stringify(body),
      signal,
    });
    try {
      for await (const { event, data } of eventsOf(textOf(response.body))) {
        const content = JSON.parse(data);
        if (event === "answer") return content;
        if (event === "problem") throw new ProblemError(content.status, content);
        progressed(content);
      }
    } catch (error) {
      if (error instanceof ProblemError) throw error;
      throw new UnreachableError(`the answer of the service broke off: ${error.message}`);
    }
    throw new UnreachableError("the answer of the service broke off");
  }

  /** How the paths of held bolts end that start at several poses; nothing is computed any further once `signal` is aborted. */
  async outcomes(body, unit, signal) {
    const answer = await this.#fetchJson(addressOf("/v1/outcomes", { unit }), {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
      signal,
    });
    return answer.outcomes;
  }

  /** The text at a path with these parameters. */
  async text(path, parameters) {
    return (await this.#fetch(addressOf(path, parameters))).text();
  }

  /** The bytes at a path. */
  async bytes(path) {
    return (await this.#fetch(path)).arrayBuffer();
  }

  async #fetchJson(address, options = {}) {
    return (await this.#fetch(address, options)).json();
  }

  async #fetch(address, options = {}) {
    const headers = { ...options.headers, ...(this.hasKey && { Authorization: `Bearer ${this.#key}` }) };
    let response;
    try {
      response = await ((options.method === undefined && takePrefetched(address)) || fetch(address, { ...options, headers }));
    } catch (error) {
      throw new UnreachableError(`no answer from the service: ${error.message}`);
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
