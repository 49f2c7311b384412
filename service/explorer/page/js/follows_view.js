// A formation amid those that turns and tilts lead to.

import { CLASS_COLOURS, UNDECIDED_COLOUR } from "./colours.js";
import { groupsOf } from "./neighbours.js";
import { picture, replaceContent, svg } from "./svg.js";
import { className, shortRegion } from "./terms.js";
import { percent } from "./units.js";
import { wrapped } from "./wrap.js";

const WIDTH = 396;
const CARD = { width: 194, height: 50, gap: 5 };
const MOST = 3;
const LINES = 3;
const LETTERS = 22;
const TITLE = 17;
const REST = 15;
const CENTRE_HEIGHT = 122;
const SHARE_HEIGHT = 3;

/** The picture in a frame; `follow` is called with a formation's key and the move that leads there. */
export class FollowsView {
  #frame;
  #follow;

  constructor(frame, follow) {
    this.#frame = frame;
    this.#follow = follow;
  }

  /** Draws a formation's node; `next` has the keys of what comes next at this orientation, by move. */
  draw(node, next) {
    const rows = pairs(groupsOf(node, MOST, next));
    const heights = rows.map((row) => TITLE + Math.max(...row.map((group) => group.shown.length * (CARD.height + CARD.gap) + REST * notesOf(group).length)));
    const height = CENTRE_HEIGHT + heights.reduce((sum, one) => sum + one, 0) + 8 * rows.length;
    const root = picture(WIDTH, height, "The formation and those that turns and tilts lead to", { class: "follows", role: "group" });
    root.append(centre(node));
    let y = CENTRE_HEIGHT + 8;
    rows.forEach((row, k) => {
      row.forEach((group, column) => root.append(...this.#group(group, 2 + column * (WIDTH / 2), y)));
      y += heights[k] + 8;
    });
    replaceContent(this.#frame, root);
  }

  /** Shows a text in place of the picture. */
  showEmpty(text) {
    const line = document.createElement("p");
    line.className = "readout";
    line.textContent = text;
    replaceContent(this.#frame, line);
  }

  #group(group, x, y) {
    const { title, shown, move } = group;
    const parts = [svg("text", { x, y: y + 12, class: "group" }, title)];
    shown.forEach((one, k) => parts.push(this.#card(one, move, x, y + TITLE + k * (CARD.height + CARD.gap))));
    const below = y + TITLE + shown.length * (CARD.height + CARD.gap) + 11;
    return [...parts, ...notesOf(group).map((note, k) => svg("text", { x, y: below + REST * k, class: "title" }, note))];
  }

  #card({ formation, class: stateClass, change, share, here }, move, x, y) {
    const card = svg("g", { class: here ? "card here" : "card", role: "button", tabindex: 0, "data-key": formation, "data-move": move });
    const tip = svg("title", {}, `${className(stateClass)}: ${change}`);
    card.append(svg("rect", { x, y, width: CARD.width, height: CARD.height, rx: 4, class: "box" }, tip));
    card.append(svg("rect", { x, y, width: 6, height: CARD.height, rx: 2, fill: CLASS_COLOURS[stateClass] ?? UNDECIDED_COLOUR }));
    wrapped(changeText(change, stateClass), LETTERS, LINES).forEach((line, k) => {
      card.append(svg("text", { x: x + 12, y: y + 14 + 13.5 * k }, line));
    });
    const right = { x: x + CARD.width - 6, "text-anchor": "end", class: "share" };
    card.append(svg("text", { ...right, y: y + CARD.height / 2 + (here ? -3 : 4) }, percent(share)));
    const bar = { x: x + 8, y: y + CARD.height - SHARE_HEIGHT - 2, height: SHARE_HEIGHT, width: (share * (CARD.width - 12)).toFixed(1) };
    card.append(svg("rect", { ...bar, class: "bar" }));
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

/** What changes, short enough for a card: of a change of class the new one alone is named. */
export function changeText(change, stateClass) {
  const [first, ...rest] = change.split("; ");
  const name = className(stateClass);
  if (first.endsWith(` to ${name}`) && !first.startsWith("contact")) return [`to ${name}`, ...rest].join("; ");
  return change || "the same contacts";
}

/** The text below a group's cards, so that all its shares add up. */
export function notesOf({ move, shown, more, rest, unchanged }) {
  const turns = move === "ccw" || move === "cw";
  return [
    ...(more > 0 ? [`and ${more} more, ${percent(rest)} together`] : []),
    ...(shown.length === 0 ? [turns ? "no other formation" : "no other formation, or the grid ends"] : []),
    ...(shown.length > 0 && unchanged > 0 ? [`${percent(unchanged)}: the same, or the grid ends`] : []),
  ];
}

/** The groups two by two: opposite senses stand beside each other. */
function pairs(groups) {
  return groups.flatMap((group, k) => (k % 2 === 0 ? [[group, groups[k + 1]]] : []));
}

function centre({ formation, share, orientations }) {
  const [x, y] = [2, 2];
  const colour = CLASS_COLOURS[formation.class] ?? UNDECIDED_COLOUR;
  const group = svg("g", { class: "centre" });
  group.append(svg("rect", { x, y, width: WIDTH - 4, height: CENTRE_HEIGHT - 4, rx: 6, class: "box" }));
  group.append(svg("rect", { x, y, width: WIDTH - 4, height: 7, rx: 3, fill: colour }));
  const lines = formation.contacts.map(
    ({ stage, bolt_region: bolt, nut_region: nut, features }) => `${stage}  ${shortRegion(bolt)} on ${shortRegion(nut)}, ${features}`,
  );
  group.append(svg("text", { x: x + 12, y: y + 25, class: "name" }, className(formation.class)));
  lines.slice(0, 3).forEach((line, k) => group.append(svg("text", { x: x + 12, y: y + 42 + 14 * k }, line)));
  if (lines.length > 3) group.append(svg("text", { x: x + 12, y: y + 84 }, `and ${lines.length - 3} more`));
  const where = `${percent(share)} of all poses, at ${orientations} orientation${orientations === 1 ? "" : "s"}`;
  group.append(svg("text", { x: x + 12, y: y + CENTRE_HEIGHT - 13, class: "title" }, where));
  return group;
}
