// The regions in contact: a disk for each of the three contacts, with a ring for the nut and one for the bolt.

import { REGION_COLOURS } from "./colours.js";
import { STAGES, atPhase, subringRadii, phaseOf, sectorPath, sectors } from "./disks.js";
import { picture, pointIn, replaceContent, svg } from "./svg.js";
import { REGIONS, shortRegion } from "./terms.js";

const WIDTH = 396;
const APART = { x: 198, y: 264 };
const MIDDLE = 112;
const HEIGHT = 2 * APART.y - 10;
/** The fourth place, beside the third disk, has the legend. */
const LEGEND = { x: APART.x + 26, y: APART.y + 44, apart: 20 };
const RINGS = { nut_region: [49, 70], bolt_region: [25, 46] };
const EDGE = 73;
const NAMES = ["first contact", "second contact", "third contact"];

/** The picture in a frame; `choose` is called with a phase that was pointed at. */
export class DisksView {
  #frame;
  #choose;
  #cursors = [];
  #texts = [];

  constructor(frame, choose) {
    this.#frame = frame;
    this.#choose = choose;
  }

  /** Draws everything but the cursors. */
  draw(intervals) {
    const root = picture(WIDTH, HEIGHT, "Regions in contact around the phase", { class: "disks" });
    this.#cursors = [];
    this.#texts = [];
    STAGES.forEach((stage, k) => {
      const centre = [(k % 2 + 0.5) * APART.x, MIDDLE + Math.floor(k / 2) * APART.y];
      root.append(this.#disk(intervals?.history.intervals ?? [], stage, centre));
    });
    root.append(...legend());
    replaceContent(this.#frame, root);
  }

  /** Moves the cursors to a phase, and says under each disk what touches there. */
  moveCursor(interval, phase) {
    this.#cursors.forEach(({ line, centre }) => {
      const [[x1, y1], [x2, y2]] = [atPhase(centre, RINGS.bolt_region[0] - 6, phase), atPhase(centre, EDGE + 2, phase)];
      for (const [name, value] of Object.entries({ x1, y1, x2, y2 })) line.setAttribute(name, value);
    });
    this.#texts.forEach(({ group, centre: [x, y], stage }) => {
      const contacts = interval?.formation.contacts.filter((contact) => contact.stage === stage) ?? [];
      const lines = contacts.map((one) => `${shortRegion(one.bolt_region)} on ${shortRegion(one.nut_region)}`);
      const shown = lines.length > 0 ? lines : ["none"];
      replaceContent(group, ...shown.map((line, k) => svg("text", { x, y: y + EDGE + 32 + 14 * k, "text-anchor": "middle" }, line)));
    });
  }

  #disk(intervals, stage, centre) {
    const [x, y] = centre;
    const group = svg("g", { class: "disk" }, svg("text", { x, y: y - EDGE - 24, "text-anchor": "middle", class: "name" }, NAMES[stage - 1]));
    for (const [part, [inner, outer]] of Object.entries(RINGS)) {
      group.append(svg("path", { d: sectorPath(centre, inner, outer, 0, 360), class: "empty" }));
      for (const { start, end, subring, subrings, region } of sectors(intervals, stage, part)) {
        const [low, high] = subringRadii(inner, outer, subring, subrings);
        const path = svg("path", { d: sectorPath(centre, low, high, start, end), fill: REGION_COLOURS[region] });
        path.append(svg("title", {}, `${part === "nut_region" ? "nut" : "bolt"}: ${REGIONS[region]}`));
        group.append(path);
      }
    }
    for (const phase of [0, 90, 180, 270]) group.append(phaseLabel(centre, phase));
    const line = svg("line", { class: "cursor" });
    const texts = svg("g", { class: "at-cursor" });
    group.append(line, texts);
    this.#cursors.push({ line, centre });
    this.#texts.push({ group: texts, centre, stage });
    this.#listen(group, centre);
    return group;
  }

  #listen(group, centre) {
    const choose = (event) => this.#choose(phaseOf(centre, pointIn(group.ownerSVGElement, event)));
    group.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      group.setPointerCapture(event.pointerId);
      choose(event);
    });
    group.addEventListener("pointermove", (event) => {
      if (group.hasPointerCapture(event.pointerId)) choose(event);
    });
  }
}

function phaseLabel(centre, phase) {
  const [x, y] = atPhase(centre, EDGE + 3, phase);
  const anchor = { 0: "start", 180: "end" }[phase] ?? "middle";
  const down = { 90: 0, 270: 8 }[phase] ?? 4;
  return svg("text", { x, y: y + down, "text-anchor": anchor, class: "title" }, `${phase}`);
}

function legend() {
  const shown = Object.keys(REGIONS).filter((region) => region !== "base");
  const rings = ["outer ring: the nut's", "inner ring: the bolt's"].map((text, k) =>
    svg("text", { x: LEGEND.x, y: LEGEND.y - 26 + 14 * k, class: "title" }, text),
  );
  const entries = shown.flatMap((region, k) => {
    const { x, apart } = LEGEND;
    const y = LEGEND.y + k * apart;
    return [
      svg("rect", { x, y, width: 14, height: 14, fill: REGION_COLOURS[region], class: "swatch" }),
      svg("text", { x: x + 20, y: y + 11.5 }, REGIONS[region]),
    ];
  });
  return [...rings, ...entries];
}
