// The load of a view: a push along -z, and beside it parts of the push along other axes.

/** What the load has beside its push: forces over the push, moments over the push times the nominal radius. */
export const PARTS = {
  fx: { name: "sideways, x", help: "force along x, over the push" },
  fy: { name: "sideways, y", help: "force along y, over the push" },
  mx: { name: "moment, x", help: "moment about the x axis through the bolt's origin, over push times nominal radius" },
  my: { name: "moment, y", help: "moment about the y axis through the bolt's origin, over push times nominal radius" },
  mz: { name: "torque", help: "moment about the nut's axis through the bolt's origin, over push times nominal radius; positive: counter-clockwise" },
};
/** The planes of loads that a diagram can show. */
export const PLANES = { "fx,my": "sideways x, moment y", "fy,mx": "sideways y, moment x", "fx,fy": "sideways x, sideways y", "mx,my": "moment x, moment y" };
/** Parts of the view that make the load. */
export const LOAD_FIELDS = ["mu", "push", ...Object.keys(PARTS)];

/** Force (N) and moment (N times the unit of the radius) on the bolt. */
export function loadOf(view, radius) {
  const { push, fx, fy, mx, my, mz } = view;
  return {
    force: [fx * push, fy * push, -push],
    moment: [mx, my, mz].map((part) => part * push * radius),
  };
}

/** A wrench's line of action: the point on it nearest to the point of its moment, from that point; null without a force. */
export function lineOfAction({ force: [fx, fy, fz], moment: [mx, my, mz] }) {
  const square = fx * fx + fy * fy + fz * fz;
  if (square === 0) return null;
  return [fy * mz - fz * my, fz * mx - fx * mz, fx * my - fy * mx].map((part) => part / square + 0);
}

const VERDICTS = {
  moves: "The bolt moves: no contact forces hold this load.",
  can_stay: "The bolt can stay: contact forces hold this load.",
  can_wedge: "The bolt can wedge: contacts can press against each other without any load.",
  undecided: "Undecided: the friction lies between the bounds of a least one.",
};

/** What the load does, in a sentence. */
export function verdictText({ verdict, supported, penetrating }) {
  const text = supported ? "The bolt stays without any friction." : VERDICTS[verdict];
  return penetrating ? `${text} The solids overlap in the last pose, so that no forces are real there.` : text;
}

/** Which contacts do what on a piece of a jamming diagram's boundary. */
export function pieceText({ contacts: loaded }, contacts) {
  const most = 4;
  const sliding = loaded.filter(({ mode }) => mode === "slides");
  const sticking = loaded.filter(({ mode }) => mode === "sticks").map(({ contact }) => contact);
  const numbers = new Set(loaded.map(({ contact }) => contact));
  const lifted = contacts.filter((contact) => !numbers.has(contact));
  const parts = sliding.length > most
    ? [`${sliding.length} contacts slide`]
    : sliding.map(({ contact, side }) => `contact ${contact} ${side ? `slides, friction ${side}` : "presses"}`);
  if (sticking.length > 0) parts.push(`${contactsText(sticking, most)} ${sticking.length === 1 ? "sticks" : "stick"}`);
  if (lifted.length > 0 && lifted.length <= most) parts.push(`${contactsText(lifted, most)} ${lifted.length === 1 ? "lifts" : "lift"} off`);
  return parts.join("; ");
}

function contactsText(numbers, most) {
  if (numbers.length > most) return `${numbers.length} contacts`;
  return `contact${numbers.length > 1 ? "s" : ""} ${numbers.join(", ")}`;
}
