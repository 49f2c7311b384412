import assert from "node:assert/strict";
import { test } from "node:test";

import { afterSnap, jumpsOfSnap, middleOfEvent, noSnapText, snapText, toleranceText } from "../../service/explorer/page/js/falls.js";
import { lastStage, restHeight, whyNotAtRest, rests } from "../../service/explorer/page/js/resting.js";
import { turnPath } from "../../service/explorer/page/js/turn_path.js";

const SNAP = { from: 351.2, to: 359.04, fall: 0.01098, steepest: 0.0102, steepest_from: 355.9, jump: 0.0075, jump_at: 357.38089147 };

test("a snap is its whole fall, its span and the jump within it", () => {
  assert.equal(snapText(SNAP, "in"), "snap: falls 0.0110 in from 351.2 to 359 deg, of it 0.0075 at 357.38 deg");
  assert.equal(
    snapText({ ...SNAP, to: 364.5, jump: 0 }, "in"),
    "snap: falls 0.0110 in from 351.2 to 4.5 deg, of it 0.0102 within 3 deg from 355.9 deg",
  );
});

test("to the snap is just after its jump, or at the end of its steepest part", () => {
  assert.equal(afterSnap(SNAP), 357.380893);
  assert.equal(afterSnap({ ...SNAP, jump: 0, steepest_from: 358.5 }), 1.5);
});

test("where there is no snap the reason says how far the bolt falls at most", () => {
  assert.match(noSnapText({ snap: null, steepest: 0.0012 }, "in"), /no snap here.*5 % of the thread pitch.*0\.001200 in/);
  assert.match(noSnapText(null, "in"), /computed by meshes, or its history has not come/);
});

test("the jumps of a snap are those of its descent", () => {
  const descents = [{ from: 10, to: 20, jumps: [{ phase: 12 }] }, { from: 351.2, to: 359.04, jumps: [{ phase: 357.38 }] }];
  assert.deepEqual(jumpsOfSnap({ snap: SNAP, descents }), [{ phase: 357.38 }]);
  assert.deepEqual(jumpsOfSnap({ snap: null, descents }), []);
});

test("the main event is the snap, else the window", () => {
  const windows = [{ enter: 340, leave: 400 }];
  assert.equal(middleOfEvent({ snap: { from: 350, to: 366 }, windows }), 358);
  assert.equal(middleOfEvent({ snap: null, windows }), 10);
  assert.equal(middleOfEvent({ snap: null, windows: [] }), null);
});

test("a tolerance gives the range of the snap and of the fall", () => {
  const falls = { tolerance: 0.3, tilts: 9, steepest: [0.001, 0.002], fall: [0.0088, 0.0112], snap_from: [350.1, 352], snap_to: [358.2, 361.4], snaps: 7 };
  assert.equal(toleranceText(falls, "in"), "within ±0.3 deg: snaps at 7 of 9 tilts, falls 0.0088 to 0.0112 in, from 350.1–352 to 358.2–1.4 deg");
  assert.match(toleranceText({ ...falls, snaps: 0, fall: null, snap_from: null, snap_to: null }, "in"), /no snap at any of 9 tilts; the steepest 3 deg fall 0\.0010 to 0\.0020 in/);
});

const pose = (z) => ({ translation: [0, 0, z] });
const state = (stateClass, embedment, ...heights) => ({ class: stateClass, margins: { embedment }, poses: heights.map(pose) });

test("only a stable or quasi-stable state within its embedment's tolerance rests", () => {
  const stable = state("stable_three_point", 1e-9, 3, 2, 1);
  assert.ok(rests(stable) && rests(state("quasi_stable_two_point", 0, 3, 2, 1)) && rests(state("stable_three_point", null, 3, 2)));
  assert.deepEqual([restHeight(stable), lastStage(stable), whyNotAtRest(stable)], [1, 3, null]);
  for (const [restless, why] of [
    [state("unstable_two_point", -0.01, 3, 2, -40), "ends unstable: does not rest"],
    [state("unstable_two_point", null, 3, 2), "ends unstable: does not rest"],
    [state("stable_three_point", -1e-6, 3, 2, 1), "ends overlapping the nut: does not rest"],
  ]) {
    assert.deepEqual([rests(restless), restHeight(restless), lastStage(restless), whyNotAtRest(restless)], [false, null, 2, why]);
  }
  assert.equal(lastStage(state("unstable_two_point", null, 3)), 1);
});

test("off the grid the path to the window is by turning alone", () => {
  const interval = (start, end, key, within) => ({ start, end, in_window: within, margin: 1, formation: { key, class: null, text: key } });
  const history = { roll: 2.5, pitch: -1.2, intervals: [interval(5, 100, "a", false), interval(100, 350, "b", false), interval(350, 365, "c", true)] };
  const { steps, transitions, turning } = turnPath(history, 90);
  assert.deepEqual(steps.map(({ formation, phase }) => [formation, phase]), [["a", 90], ["b", 100], ["c", 350]]);
  assert.deepEqual([transitions, turning], [2, 260]);
  assert.deepEqual(turnPath(history, 2).steps.map(({ formation }) => formation), ["c"]);
  assert.equal(turnPath({ ...history, intervals: history.intervals.slice(0, 1) }, 90), null);
});
