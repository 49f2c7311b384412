// A held bolt that is turned: what is asked of it, how far its path is, how it ends, and its events.

import { CHOICES, NUMBERS, assemblyText, convertedText, defaultText, isSameRequest, labelOf, progressText, refusedFields, requestOf } from "./assembly.js";
import { byId, html } from "./html.js";
import { MARGINS, eventText, forceSize, marginText, outcomeText, pointsOfEvents } from "./turned_path.js";
import { angleNumber, fixed, unitFactor } from "./units.js";

const POSE = ["roll", "pitch", "phase"];
const ALL = [...Object.keys(NUMBERS), ...Object.keys(CHOICES)];
const LONGEST = 40;
/** Keys that lead from one event of the list to another: by so many, or to an end. */
const STEPS = { ArrowDown: 1, ArrowUp: -1, Home: -Infinity, End: Infinity };

/** The panel; `compute` is called with a request, `cancel` ends it, `goTo` is called with a point of the path. */
export class DeviceView {
  #unit = null;
  #shown = null;
  /** The request of the path that is shown; null: none is. */
  #asked = null;
  #goTo;
  #points = [];
  /** Whether the answer was asked for here, and is brought into view when it is there. */
  #isAwaited = false;

  constructor({ compute, cancel, goTo }) {
    this.#goTo = goTo;
    byId("device-fields").replaceChildren(
      ...POSE.map(numberField),
      ...Object.keys(NUMBERS).filter((name) => !POSE.includes(name)).map(numberField),
      ...Object.keys(CHOICES).map(choiceField),
    );
    byId("device-form").addEventListener("submit", (event) => {
      event.preventDefault();
      this.#isAwaited = true;
      compute(assemblyText(this.#read()));
    });
    byId("device-cancel").addEventListener("click", cancel);
    byId("device-reset").addEventListener("click", () => {
      for (const name of Object.keys(NUMBERS).filter((one) => !POSE.includes(one))) field(name).value = "";
      for (const [name, { values }] of Object.entries(CHOICES)) [field(name).value] = Object.keys(values);
      this.#showStale();
    });
    byId("turned-events").addEventListener("keydown", (event) => this.#step(event));
    byId("device-form").addEventListener("input", () => this.#showStale());
  }

  /** Shows the request of a view, where that is another one, and brings lengths into its unit. */
  show({ assembly, unit }) {
    if (assembly !== this.#shown && assembly !== "") this.#fill(requestOf(assembly));
    this.#shown = assembly;
    this.#showUnit(unit);
  }

  /** What the fields say, texts by name. */
  get request() {
    return this.#read();
  }

  /** Takes over the device and the strategy of a request. */
  fillDevice(request) {
    const { unit } = this.request;
    for (const name of ALL) {
      if (![...POSE, "mu", "confirm"].includes(name)) field(name).value = Object.hasOwn(NUMBERS, name) ? convertedText(name, request[name], request.unit, unit) : request[name];
    }
    this.#showStale();
  }

  /** Takes over the pose of a view. */
  takePose(view) {
    for (const name of POSE) field(name).value = String(view[name]);
  }

  /** Shows what is known: {path} or {problem}, or how far the path is that is computed; all null: nothing is asked for. */
  showAnswer({ assembly, progress }, { assembly: asked, unit }) {
    const isRunning = asked !== "" && assembly === null;
    byId("device-progress").hidden = !isRunning;
    byId("device-progress-text").textContent = isRunning ? progressText(progress) : "";
    byId("device-cancel").disabled = !isRunning;
    this.#showFaults(assembly?.problem ? refusedFields(assembly.problem, assembly.errors) : {});
    const path = assembly?.path ?? null;
    byId("turned-outcome").hidden = path === null;
    byId("turned-outcome").textContent = path === null ? "" : outcomeText(path, unit);
    byId("turned-outcome").dataset.outcome = path?.outcome ?? "";
    if (path === null) byId("turned-contacts").replaceChildren();
    byId("turned-numbers").replaceChildren(...(path?.margins ? [margins(path, unit)] : []));
    this.#listEvents(path, unit);
    this.#asked = path === null ? null : assembly.text;
    this.#showStale();
    if (isRunning || !this.#isAwaited) return;
    this.#isAwaited = false;
    if (path !== null && !assembly.problem) byId("turned-outcome").scrollIntoView({ block: "nearest" });
  }

  /** Marks the last event that has happened at a point, and lists the contacts there. */
  mark(at, { contacts, motions }) {
    byId("turned-contacts").replaceChildren(contactTable(contacts[at], motions[at]));
    const buttons = [...byId("turned-events").querySelectorAll("button")];
    const last = this.#points.findLastIndex((point) => point <= at);
    buttons.forEach((button, k) => button.setAttribute("aria-current", k === last));
  }

  /** Says where the path that is shown is of other values than the fields have. */
  #showStale() {
    byId("device-stale").hidden = this.#asked === null || isSameRequest(requestOf(this.#asked), this.request, ALL);
  }

  #listEvents(path, unit) {
    const events = path?.events ?? [];
    this.#points = path === null ? [] : pointsOfEvents(path.path, events);
    byId("turned-events-title").hidden = events.length === 0;
    const factor = path === null ? 1 : unitFactor(path.unit, unit);
    byId("turned-events").replaceChildren(...events.map((event, k) => {
      const button = html("button", { type: "button", tabindex: k === 0 ? 0 : -1, "data-kind": event.kind }, [
        html("span", {}, angleNumber(event.phase, 2)),
        html("span", {}, eventText(event, unit, factor)),
      ]);
      button.addEventListener("click", () => {
        this.#focusable(button);
        this.#goTo(this.#points[k]);
      });
      return html("li", {}, button);
    }));
  }

  #step(event) {
    const step = STEPS[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const buttons = [...byId("turned-events").querySelectorAll("button")];
    const next = buttons[Math.min(Math.max(buttons.indexOf(event.target) + step, 0), buttons.length - 1)];
    this.#focusable(next);
    next.focus();
  }

  #focusable(button) {
    for (const one of byId("turned-events").querySelectorAll("button")) one.tabIndex = one === button ? 0 : -1;
  }

  #read() {
    return { ...Object.fromEntries(ALL.map((name) => [name, field(name).value])), unit: this.#unit };
  }

  #fill(request) {
    this.#unit = request.unit;
    for (const name of ALL) field(name).value = request[name];
  }

  #showUnit(unit) {
    for (const name of Object.keys(NUMBERS)) {
      if (this.#unit !== null) field(name).value = convertedText(name, field(name).value, this.#unit, unit);
      byId(`device-${name}-label`).textContent = labelOf(name, unit);
      field(name).placeholder = defaultText(name, unit) ?? "";
    }
    this.#unit = unit;
  }

  #showFaults(faults) {
    byId("device-problem").replaceChildren(...(faults[""] ? [html("li", {}, faults[""])] : []));
    for (const name of ALL) {
      const fault = byId(`device-${name}-fault`);
      fault.textContent = faults[name] ?? "";
      field(name).setAttribute("aria-invalid", Boolean(faults[name]));
    }
  }
}

function numberField(name) {
  const input = { type: "text", id: `device-${name}`, inputmode: "decimal", autocomplete: "off", spellcheck: "false", maxlength: LONGEST };
  return row(name, NUMBERS[name].help, html("input", { ...input, "aria-errormessage": `device-${name}-fault` }));
}

function choiceField(name) {
  const { label, values, help } = CHOICES[name];
  const options = Object.entries(values).map(([value, text]) => html("option", { value }, text));
  return row(name, help, html("select", { id: `device-${name}`, "aria-errormessage": `device-${name}-fault` }, options), label);
}

function row(name, help, control, label = "") {
  return html("div", { class: "field", "data-field": name }, [
    html("label", { for: `device-${name}`, id: `device-${name}-label`, "data-help": help }, label),
    control,
    html("p", { class: "fault", id: `device-${name}-fault`, "aria-live": "polite" }),
  ]);
}

function field(name) {
  return byId(`device-${name}`);
}

/** The contacts of a point with their forces and, with friction, what they did in the step before it. */
function contactTable(contacts, motions) {
  const head = ["contact", "force (N)", ...(motions.length > 0 ? ["in this step"] : [])];
  const rows = contacts.map((contact, k) => [contact.features, fixed(forceSize(contact), 2), ...(motions.length > 0 ? [motions[k]] : [])]);
  return html("table", {}, [
    html("caption", {}, "forces on the bolt at this point"),
    html("thead", {}, html("tr", {}, head.map((text) => html("th", { scope: "col" }, text)))),
    html("tbody", {}, rows.map((cells) => html("tr", {}, cells.map((text) => html("td", {}, text))))),
  ]);
}

function margins(path, unit) {
  const known = Object.keys(MARGINS).filter((name) => path.margins[name] !== null);
  const term = (name) => html("button", { type: "button", class: "term", "data-help": MARGINS[name].help }, MARGINS[name].name);
  return html("table", {}, [
    html("caption", {}, "margins"),
    html("tbody", {}, known.map((name) => html("tr", {}, [html("th", { scope: "row" }, term(name)), html("td", {}, marginText(name, path, unit))]))),
  ]);
}
