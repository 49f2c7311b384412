// Regions in contact around the phase, as sectors of rings.

/** How many stages have a disk. */
export const STAGES = [1, 2, 3];

/**
 * The sectors of one stage and one part ("bolt_region" or "nut_region") over the turn: {start, end, subring, subrings, region}
 * in degrees, where several contacts of the stage divide the ring into subrings, the first outermost.
 */
export function sectors(intervals, stage, part) {
  const found = [];
  const open = [];
  for (const { start, end, formation } of intervals) {
    const contacts = formation.contacts.filter((contact) => contact.stage === stage);
    const subrings = contacts.length;
    contacts.forEach((contact, subring) => {
      const region = contact[part];
      const before = open[subring];
      if (before && before.end === start && before.region === region && before.subrings === subrings) before.end = end;
      else found.push((open[subring] = { start, end, subring, subrings, region }));
    });
    open.length = subrings;
  }
  return found;
}

/** The radii [inner, outer] of a subring of a ring. */
export function subringRadii(inner, outer, subring, subrings) {
  const width = (outer - inner) / subrings;
  return [outer - (subring + 1) * width, outer - subring * width];
}

/** The point of a picture at a phase and a radius about a centre; the phase grows counter-clockwise from the right. */
export function atPhase(centre, radius, phase) {
  const angle = (phase * Math.PI) / 180;
  return [round(centre[0] + radius * Math.cos(angle)), round(centre[1] - radius * Math.sin(angle))];
}

/** The path of a sector of a ring from one phase to another. */
export function sectorPath(centre, inner, outer, start, end) {
  if (end - start >= 360) {
    const middle = start + 180;
    return sectorPath(centre, inner, outer, start, middle) + sectorPath(centre, inner, outer, middle, start + 359.999);
  }
  const large = end - start > 180 ? 1 : 0;
  const [a, b, c, d] = [
    atPhase(centre, outer, start),
    atPhase(centre, outer, end),
    atPhase(centre, inner, end),
    atPhase(centre, inner, start),
  ].map(([x, y]) => `${x} ${y}`);
  return `M${a}A${outer} ${outer} 0 ${large} 0 ${b}L${c}A${inner} ${inner} 0 ${large} 1 ${d}Z`;
}

/** The phase at which a point of a picture lies about a centre. */
export function phaseOf(centre, point) {
  const degrees = (Math.atan2(centre[1] - point.y, point.x - centre[0]) * 180) / Math.PI;
  return degrees < 0 ? degrees + 360 : degrees;
}

function round(value) {
  return Math.round(value * 100) / 100;
}
