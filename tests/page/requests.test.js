import assert from "node:assert/strict";
import { test } from "node:test";

import { Busy } from "../../service/explorer/page/js/busy.js";
import { libraryAddress } from "../../service/explorer/page/js/prefetch.js";
import { libraryText } from "../../service/explorer/page/js/controls.js";
import { summaryText } from "../../service/explorer/page/js/locate_view.js";
import { mapPhaseText, mapValues } from "../../service/explorer/page/js/map_view.js";
import { checkedObservation, observationOf, observationText, remaining } from "../../service/explorer/page/js/observation.js";
import { Throttle } from "../../service/explorer/page/js/throttle.js";
import { MAP_MS, Model } from "../../service/explorer/page/js/model.js";
import { MOST_POSES, posesOf, posesOfView, posesText } from "../../service/explorer/page/js/poses.js";
import { DEFAULTS } from "../../service/explorer/page/js/view.js";

test("poses are read from tables with any usual separator", () => {
  const expected = [{ roll: 2.5, pitch: -1.2, phase: 357 }, { roll: 0, pitch: -4, phase: 40 }];
  for (const table of [
    "2.5,-1.2,357\n0,-4,400\n",
    "roll,pitch,phase\r\n2.5, -1.2, 357\r\n0, -4, 40\r\n",
    "phase;roll_deg;note;pitch_deg\n357;2.5;a;−1.2\n40;0;b;-4",
    "# measured on Monday\n\n2.5\t-1.2\t357\n0\t-4\t40",
    'roll (deg) pitch (deg) phase (deg)\n"2.5" "-1.2" "357"\n0 -4 40',
  ]) {
    assert.deepEqual(posesOf(table), { poses: expected, faults: [] }, table);
  }
  assert.deepEqual(posesOfView({ poses: posesText(expected) }), expected);
});

test("a line that is no pose is named with what is valid, the others are taken", () => {
  const { poses, faults } = posesOf("1,2,3\n12,0,0\n1,x,3\n1,2");
  assert.deepEqual(poses, [{ roll: 1, pitch: 2, phase: 3 }]);
  assert.deepEqual(faults, [
    "line 2: roll is 12; valid: -10 to 10 deg",
    "line 3: pitch is x; valid: a number",
    "line 4: there is no phase; a line has roll, pitch and phase in deg",
  ]);
  const many = posesOf("0,0,0\n".repeat(MOST_POSES + 1));
  assert.equal(many.poses.length, MOST_POSES);
  assert.match(many.faults[0], /501 poses; the first 500/);
});

test("an observation goes into the link and comes back the same", () => {
  const observation = {
    class: "stable_three_point", flag: "tie", contacts: "3", ordered: true,
    contact: [{ stage: "1", bolt: "crest", nut: "", features: "edge-edge" }, { stage: "", bolt: "", nut: "flank_pos", features: "" }],
  };
  const text = observationText(observation);
  assert.equal(text, "class=stable_three_point&flag=tie&contacts=3&contact=1:crest:*:edge-edge,*:*:flank_pos:*&ordered=true");
  assert.deepEqual(observationOf(text), observation);
  assert.equal(checkedObservation(text), text);
  assert.equal(checkedObservation("class=stable_three_point&contact=1:surface:*:*"), undefined);
  assert.equal(observationText(observationOf("")), "");
});

test("what remains is listed by orientation, the most phase first, and its shares add up", () => {
  const stretch = (roll, pitch, start, end) => ({ roll, pitch, start, end });
  const found = remaining([stretch(0, 1, 10, 20), stretch(2, 0, 350, 390), stretch(0, 1, 100, 110)]);
  assert.deepEqual(found.map(({ roll, pitch, degrees, phase }) => [roll, pitch, degrees, phase]), [[2, 0, 40, 10], [0, 1, 20, 15]]);
  assert.equal(found.reduce((sum, { share }) => sum + share, 0), 1);
  assert.match(summaryText({ share: 0.05, undecided_share: 0.01, orientations: 2 }, found), /^5\.0 % of all poses remain, at 2 orientations, 1\.0 % of them undecided/);
  assert.equal(summaryText({ share: 0, undecided_share: 0, orientations: 0 }, []), "Nothing in this library is like that.");
});

test("of waiting calls the last is run, and never two at once", async () => {
  const throttle = new Throttle(0);
  const begun = [];
  let finish = null;
  const first = throttle.run(() => {
    begun.push(1);
    return new Promise((done) => (finish = done));
  });
  const others = [2, 3].map((number) => throttle.run(async () => begun.push(number)));
  assert.deepEqual(begun, [1]);
  finish("one");
  assert.equal(await first, "one");
  assert.equal(await others[0], undefined);
  await others[1];
  assert.deepEqual(begun, [1, 3]);
});

test("a call that waits can be dropped", async () => {
  const throttle = new Throttle(0);
  const begun = [];
  const first = throttle.run(async () => begun.push(1));
  const second = throttle.run(async () => begun.push(2));
  throttle.drop();
  assert.equal(await second, undefined);
  await first;
  await throttle.run(async () => begun.push(3));
  assert.deepEqual(begun, [1, 3]);
});

test("a phase that is gone back to within a moment keeps its map", async () => {
  const asked = [];
  const library = { id: 1, unit: "mm", grid: { tilt_max: 4, tilt_step: 4, phase_step: 5 } };
  const answers = { "/v1/libraries/1": library, "/v1/libraries/1/states": { states: [], next: null } };
  const api = {
    get: async (address, { phase }) => {
      if (address.endsWith("/states")) asked.push(phase);
      return answers[address] ?? { heights: [] };
    },
  };
  const arrived = [];
  const model = new Model(api, new Busy(() => {}), (part) => arrived.push(part), (error) => assert.fail(error));
  const view = { ...DEFAULTS, library: 1, unit: "mm" };
  await model.open(view);
  model.follow({ ...view, phase: 10 });
  while (!arrived.includes("map")) await new Promise((done) => setTimeout(done, 5));
  model.follow({ ...view, phase: 0 });
  model.follow({ ...view, phase: 10 });
  await new Promise((done) => setTimeout(done, 2 * MAP_MS));
  assert.deepEqual(asked, [10]);
});

test("a failure does not block later calls", async () => {
  const throttle = new Throttle(0);
  await assert.rejects(throttle.run(() => Promise.reject(new Error("no"))), /no/);
  assert.equal(await throttle.run(async () => "yes"), "yes");
});

test("what takes a moment is not shown, what takes longer is until it ends", async () => {
  const shown = [];
  const busy = new Busy((texts) => shown.push(texts));
  assert.equal(await busy.during("short", Promise.resolve(1)), 1);
  assert.deepEqual(shown, []);
  let finish = null;
  const long = busy.during("long", new Promise((done) => (finish = done)));
  while (shown.length === 0) await new Promise((done) => setTimeout(done, 20));
  finish();
  await long;
  assert.deepEqual(shown, [["long"], []]);
});

test("a library is named by its number, thread, grid and method", () => {
  const library = { id: 2, designation: "M6x1", grid: { tilt_max: 4, tilt_step: 2, phase_step: 5 }, method: "exact" };
  assert.equal(libraryText(library, true), "2 (latest): M6x1, ±4 by 2°, phase by 5°, exact");
  assert.equal(libraryText({ ...library, id: 1, method: "mesh" }, false), "1: M6x1, ±4 by 2°, phase by 5°, mesh");
});

test("the library of a link is prefetched at the address that the model requests", () => {
  assert.equal(libraryAddress("", null), "/v1/libraries/latest");
  assert.equal(libraryAddress("", "mm"), "/v1/libraries/latest?unit=mm");
  assert.equal(libraryAddress("#library=07&roll=1&unit=in", "mm"), "/v1/libraries/7?unit=in");
  assert.equal(libraryAddress("#library=x", null), null);
  assert.equal(libraryAddress("#unit=ft", null), null);
});

test("the map says which phase it shows and where one is", () => {
  const model = { map: { phase: 357, states: [] } };
  assert.equal(mapPhaseText(model, { quantity: "class", over: "phase", phase: 357.38 }), "Squares: at phase 357 of the grid; you are at 357.38.");
  assert.equal(mapPhaseText(model, { quantity: "class", over: "phase", phase: 357 }), "Squares: at phase 357 of the grid.");
  assert.equal(mapPhaseText(model, { quantity: "class", over: "all", phase: 357 }), "");
});

test("falls are those of the orientation: that at the snap, none without one, and the steepest", () => {
  const model = {
    orientations: [{ roll: 0, pitch: -4 }, { roll: 1, pitch: 0 }],
    windows: { orientations: [{ roll: 0, pitch: -4, steepest: 0.0102, snap: { fall: 0.011 }, windows: [{ width: 40 }, { width: 2 }] }] },
  };
  const values = (quantity) => [...mapValues(model, { quantity, over: "phase", unit: "in" }).values()].map(({ value }) => value);
  assert.deepEqual(values("snap"), [0.011, null]);
  assert.deepEqual(values("steepest"), [0.0102, null]);
  assert.deepEqual(values("window_width"), [42, null]);
});
