import assert from "node:assert/strict";
import { test } from "node:test";

import { turnedTable } from "../../service/explorer/page/js/tables.js";
import { curvesOf, eventText, leadLine, legsOf, nearestPoint, outcomeText, playTimes, pointAtTime, pointText, pointsOfEvents } from "../../service/explorer/page/js/turned_path.js";
import { cellsOf } from "../../service/explorer/page/js/turned_path_chart.js";

const DEGREE = Math.PI / 180;
const UPRIGHT = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const NOTHING = { features_before: null, features: null, point: null, drop: null, way: null, energy: null };
const PHASES = [10, 30, 30.001, 50, 30, 10];

/** A path up and down again with a fall on the way, in mm. */
const ANSWER = {
  unit: "mm", mu: 0, outcome: "engaged", flags: [],
  margins: { lead: 0.0475, play: -0.5, tilt: 0.1, torque: 19.5, offset: 3, snap: null },
  events: [
    { ...NOTHING, kind: "gained", phase: 30, from_phase: 10, features: "edge-edge" },
    { ...NOTHING, kind: "fall", phase: 30.001, from_phase: 30, drop: 1, way: 2, energy: 5 },
    { ...NOTHING, kind: "lost", phase: 30, from_phase: 50, features_before: "edge-edge" },
  ],
  path: {
    phase: PHASES,
    held: PHASES.map(() => "contacts"),
    pose: PHASES.map((_, k) => ({ rotation: UPRIGHT, translation: [0, 0, 0 - k] })),
    deviation: PHASES.map((_, k) => ({ shift: [3 * k, 4 * k, 9], rotation: [0, k, 0] })),
    contacts: PHASES.map((_, k) => (k === 0 ? [] : [{ force: [0, 3, 4] }, { force: [0, 0, k] }])),
    torque: PHASES.map(() => 2),
    elastic_energy: [1, 1, 2, 2, 2, 2],
    potential: [1, 1, 0, 0, 0, 0],
  },
};

test("turns of one sense are told apart, however often the path goes over a phase", () => {
  assert.deepEqual(legsOf(ANSWER.path), [[0, 3], [3, 5]]);
  assert.deepEqual(legsOf({ phase: [0, -2, -4] }), [[0, 2]]);
  assert.deepEqual(legsOf({ phase: [7] }), [[0, 0]]);
});

test("each event has the point of its own turn", () => {
  assert.deepEqual(pointsOfEvents(ANSWER.path, ANSWER.events), [1, 2, 4]);
});

test("curves are in the unit that is shown, and the losses add up", () => {
  const curves = curvesOf(ANSWER, "mm");
  assert.deepEqual(curves.height, [0, -1, -2, -3, -4, -5]);
  assert.deepEqual(curves.shift, [0, 5, 10, 15, 20, 25]);
  assert.deepEqual(curves.device_tilt, [0, 1, 2, 3, 4, 5]);
  assert.deepEqual(curves.largest_force, [0, 5, 5, 5, 5, 5]);
  assert.deepEqual(curves.all_forces, [0, 6, 7, 8, 9, 10]);
  assert.deepEqual(curves.falls, [0, 0, 5, 5, 5, 5]);
  assert.deepEqual(curves.elastic, [0, 0, 1, 1, 1, 1]);
  assert.ok(Math.abs(curves.work[3] - 2 * 40 * DEGREE) < 1e-12);
  assert.ok(Math.abs(curves.work.at(-1)) < 1e-12);
  for (let k = 0; k < PHASES.length; k++) {
    const { work, push, elastic, falls, friction } = curves;
    assert.ok(Math.abs(work[k] + push[k] - elastic[k] - falls[k] - friction[k]) < 1e-12);
  }
  assert.ok(Math.abs(curvesOf(ANSWER, "in").shift[1] - 5 / 25.4) < 1e-12);
  const [head, ...rows] = turnedTable({ assembly: { path: ANSWER } }, { unit: "mm" });
  assert.equal(rows.length, PHASES.length);
  assert.deepEqual(rows[1].slice(0, 3), [30, -1, 2]);
  assert.equal(head.length, rows[0].length);
});

test("the line of the lead goes through the end, and up with the phase of a right-hand bolt", () => {
  const curves = { phase: [0, 90, 0], height: [0, 0, -1] };
  const legs = [[0, 1], [1, 2]];
  assert.deepEqual(leadLine(curves, legs, { thread_pitch: 4 }), [[90, 0], [0, -1]]);
  assert.deepEqual(leadLine(curves, legs, { thread_pitch: 4, starts: 2, hand: "left" }), [[90, -3], [0, -1]]);
});

test("a phase is looked for on the turn that is shown, then on the others", () => {
  const legs = legsOf(ANSWER.path);
  assert.equal(nearestPoint(ANSWER.path, legs, 12, 1), 0);
  assert.equal(nearestPoint(ANSWER.path, legs, 12, 4), 5);
  assert.equal(nearestPoint(ANSWER.path, legs, 400, 4), 3);
});

test("a path is played by its phase, and a fall is looked at", () => {
  const times = playTimes(ANSWER.path, ANSWER.events, pointsOfEvents(ANSWER.path, ANSWER.events));
  assert.equal(times.length, PHASES.length);
  assert.ok(times[2] - times[1] > 0.5);
  assert.deepEqual([-1, 0, times[3], times[3] + 1e-9, 1e9].map((seconds) => pointAtTime(times, seconds)), [0, 0, 3, 3, 5]);
});

test("events, points and ends are said in words", () => {
  assert.deepEqual(ANSWER.events.map((event) => eventText(event, "mm", 1)), [
    "contact gained, edge-edge", "fall: down 1.000, way 2.000 mm", "contact lost, edge-edge",
  ]);
  assert.equal(eventText({ ...NOTHING, kind: "moved", features_before: "edge-thread", features: "thread-thread" }, "in", 1), "contact moves, edge-thread to thread-thread");
  assert.equal(eventText({ ...NOTHING, kind: "frictionless_fall" }, "in", 1), "this fall was followed without friction");
  assert.equal(pointText(ANSWER.path, 3), "point 4 of 6, phase 50 deg, 2 contacts");
  assert.equal(outcomeText(ANSWER, "mm"), "The bolt engages. Margin of the height on the lead: 4.8 %.");
  assert.equal(outcomeText({ ...ANSWER, outcome: "cross_threaded" }, "mm"), "Cross-threaded: the bolt follows the lead, but not in phase. Margin of the play in phase: −0.50000 mm.");
  assert.equal(outcomeText({ ...ANSWER, outcome: "undecided", flags: ["many_contacts"], margins: null }, "mm"), "Undecided (more than eight contacts with friction).");
});

test("plots are beside each other where there is room, and the last one fills its row", () => {
  assert.deepEqual(cellsOf(5, 360, 700).map(({ x, y }) => [x, y]), [[0, 0], [0, 140], [0, 280], [0, 420], [0, 560]]);
  const cells = cellsOf(5, 900, 200);
  assert.deepEqual(cells.map(({ x, y }) => [x, y]), [[0, 0], [300, 0], [600, 0], [0, 100], [300, 100]]);
  assert.equal(cells.at(-1).width, 600);
});
