// A formation amid those that turns and tilts lead to.

import { CLASS_COLOURS, UNDECIDED_COLOUR } from "./colours.js";
import { groupsOf } from "./neighbours.js";
import { picture, put, svg } from "./svg.js";
import { className, shortRegion } from "./terms.js";
import { percent } from "./units.js";
import { wrapped } from "./wrap.js";

const WIDTH = 860;
const CARD = { width: 238, height: 52, gap: 6 };
const MOST = 3;
const LINES = 3;
const LETTERS = 31;
const CENTRE_WIDTH = 270;
const TITLE = 18;
const ROW = TITLE + MOST * (CARD.height + CARD.gap) + 20;
const HEIGHT = 3 * ROW + 12;
const CENTRE_HEIGHT = 130;

/** The picture in a frame; `follow` is called with a formation's key and the move that leads there. */
export class NetworkView {
  #frame;
  #follow;

  constructor(frame, follow) {
    this.#frame = frame;
    this.#follow = follow;
  }

  /** Draws a formation's node; `next` has the keys of what comes next at this orientation, by move. */
  draw(node, next) {
    const root = picture(WIDTH, HEIGHT, "The formation amid those that turns and tilts lead to", { class: "network", role: "group" });
    const links = svg("g", { class: "links" });
    root.append(links, centre(node));
    const taken = { top: 0, bottom: 0, left: 0, right: 0 };
    for (const group of groupsOf(node, MOST, next)) {
      const [x, y] = corner(group.place, taken[group.place]++);
      links.append(...linksTo(group, x, y));
      root.append(...this.#group(group, x, y));
    }
    put(this.#frame, root);
  }

  /** Says that there is nothing to be drawn. */
  tell(text) {
    const line = document.createElement("p");
    line.className = "readout";
    line.textContent = text;
    put(this.#frame, line);
  }

  #group({ title, shown, more, rest, move }, x, y) {
    const parts = [svg("text", { x, y: y + 12, class: "group" }, title)];
    shown.forEach((one, k) => parts.push(this.#card(one, move, x, y + TITLE + k * (CARD.height + CARD.gap))));
    const below = y + TITLE + shown.length * (CARD.height + CARD.gap) + 11;
    if (shown.length === 0) parts.push(svg("text", { x, y: below, class: "title" }, "leads nowhere: the grid ends here"));
    if (more > 0) parts.push(svg("text", { x, y: below, class: "title" }, `and ${more} more, ${percent(rest)} together`));
    return parts;
  }

  #card({ formation, class: stateClass, change, share, here }, move, x, y) {
    const card = svg("g", { class: here ? "card here" : "card", role: "button", tabindex: 0, "data-key": formation, "data-move": move });
    const tip = svg("title", {}, `${className(stateClass)}: ${change}`);
    card.append(svg("rect", { x, y, width: CARD.width, height: CARD.height, rx: 4, class: "box" }, tip));
    card.append(svg("rect", { x, y, width: 6, height: CARD.height, rx: 2, fill: CLASS_COLOURS[stateClass] ?? UNDECIDED_COLOUR }));
    wrapped(changeText(change, stateClass), LETTERS, LINES).forEach((line, k) => {
      card.append(svg("text", { x: x + 12, y: y + 16 + 14 * k }, line));
    });
    const right = { x: x + CARD.width - 6, "text-anchor": "end", class: "share" };
    card.append(svg("text", { ...right, y: y + CARD.height / 2 + (here ? -3 : 4) }, percent(share)));
    if (here) card.append(svg("text", { ...right, y: y + CARD.height / 2 + 13 }, "next"));
    const follow = () => this.#follow(formation, move);
    card.addEventListener("click", follow);
    card.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      follow();
    });
    return card;
  }
}

/** What changes, short enough for a card: a change of class is told by the new one alone. */
export function changeText(change, stateClass) {
  const [first, ...rest] = change.split("; ");
  const name = className(stateClass);
  if (first.endsWith(` to ${name}`) && !first.startsWith("contact")) return [`to ${name}`, ...rest].join("; ");
  return change || "the same contacts";
}

function corner(place, k) {
  const right = WIDTH - CARD.width - 4;
  switch (place) {
    case "left": return [4, ROW + 4];
    case "right": return [right, ROW + 4];
    case "top": return [k === 0 ? 110 : WIDTH - CARD.width - 110, 4];
    default: return [k === 0 ? 110 : WIDTH - CARD.width - 110, 2 * ROW + 10];
  }
}

function linksTo({ shown, place }, x, y) {
  const middle = [WIDTH / 2, ROW + 4 + TITLE + (3 * CARD.height + 2 * CARD.gap) / 2];
  return shown.map(({ share }, k) => {
    const top = y + TITLE + k * (CARD.height + CARD.gap);
    const end = {
      left: [x + CARD.width, top + CARD.height / 2],
      right: [x, top + CARD.height / 2],
      top: [x < WIDTH / 2 - CARD.width ? x + CARD.width : x, top + CARD.height / 2],
      bottom: [x < WIDTH / 2 - CARD.width ? x + CARD.width : x, top + CARD.height / 2],
    }[place];
    const width = (0.6 + 5 * share).toFixed(2);
    return svg("line", { x1: middle[0], y1: middle[1], x2: end[0], y2: end[1], "stroke-width": width });
  });
}

function centre({ formation, share, orientations }) {
  const x = (WIDTH - CENTRE_WIDTH) / 2;
  const y = ROW + 4 + TITLE + (3 * CARD.height + 2 * CARD.gap - CENTRE_HEIGHT) / 2;
  const colour = CLASS_COLOURS[formation.class] ?? UNDECIDED_COLOUR;
  const group = svg("g", { class: "centre" });
  group.append(svg("rect", { x, y, width: CENTRE_WIDTH, height: CENTRE_HEIGHT, rx: 6, class: "box" }));
  group.append(svg("rect", { x, y, width: CENTRE_WIDTH, height: 7, rx: 3, fill: colour }));
  const lines = formation.contacts.map(
    ({ stage, bolt_region: bolt, nut_region: nut, features }) => `${stage}  ${shortRegion(bolt)} on ${shortRegion(nut)}, ${features}`,
  );
  group.append(svg("text", { x: x + 12, y: y + 25, class: "name" }, className(formation.class)));
  lines.slice(0, 4).forEach((line, k) => group.append(svg("text", { x: x + 12, y: y + 43 + 15 * k }, line)));
  if (lines.length > 4) group.append(svg("text", { x: x + 12, y: y + 103 }, `and ${lines.length - 4} more contacts`));
  const where = `${percent(share)} of all poses, at ${orientations} orientation${orientations === 1 ? "" : "s"}`;
  group.append(svg("text", { x: x + 12, y: y + CENTRE_HEIGHT - 8, class: "title" }, where));
  return group;
}
