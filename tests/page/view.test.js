import assert from "node:assert/strict";
import { test } from "node:test";

import { curlLine, pythonLines } from "../../service/explorer/page/js/snippets.js";
import { isStep } from "../../service/explorer/page/js/address_bar.js";
import { fragmentOf, readFragment } from "../../service/explorer/page/js/url_state.js";
import { DEFAULTS, View } from "../../service/explorer/page/js/view.js";

const CHOSEN = {
  ...DEFAULTS,
  library: 7,
  roll: -3,
  pitch: 0.5,
  phase: 357.380892,
  unit: "mm",
  theme: "dark",
  quantity: "pivot_offset",
  over: "all",
  from: -20.125,
  span: 0.001,
  stage: 1.25,
  tab: "network",
  nut: "glass",
  azimuth: 12.5,
  elevation: -30,
  distance: 0.75,
  tolerance: 0.3,
  beside_library: 2,
  beside_roll: 2.5,
  beside_pitch: -1.2,
  mu: 0.35,
  push: 10,
  fx: -0.1,
  fy: 0.2,
  mx: 0.3,
  my: -1.5,
  mz: 0.04,
  plane: "mx,my",
  poses: "2.5,-1.2,357;0,-4,10.25",
  observed: "class=stable_three_point&contact=1:crest:*:edge-edge,*:*:flank_pos:*&ordered=true",
  assembly: "roll=2.5&pitch=-1.2&phase=357&k_tilt=250&k_twist=rigid&centre=-2&strategy=cw&unit=mm",
  point: 120,
  success: "phases=4&roll=0&pitch=0&phase=0&mu=0.1&centre=-5&strategy=cw&unit=mm",
  success_at: "3 -2",
  success_critical: "-1 2",
  kept_success: "phases=1&roll=0&pitch=0&phase=0&unit=in",
  kept_success_critical: "0 4",
  thread: "1/4-16 ACME-2G with sharp corners at 0.25/0.75",
};

const viewOf = (fragment) => readFragment(fragment).view;

test("a fragment restores exactly the view that made it", () => {
  for (const view of [CHOSEN, { ...DEFAULTS, library: 1, unit: "in" }]) {
    assert.deepEqual({ ...DEFAULTS, ...viewOf(`#${fragmentOf(view)}`) }, view);
  }
});

test("every part of a view is in its fragment", () => {
  for (const key of Object.keys(DEFAULTS)) {
    const found = viewOf(fragmentOf({ ...DEFAULTS, [key]: CHOSEN[key] }));
    assert.equal(found[key], CHOSEN[key], key);
  }
});

test("what is not valid in a fragment is left out and reported, the rest stays", () => {
  const bad = {
    roll: "11", pitch: "", phase: "x", unit: "ft", theme: "red", span: "0", library: "-1", stage: "NaN", nut: "", tab: "numbers",
    distance: "1e999", quantity: "colour", tolerance: "-0.1", beside_roll: "12", poses: "1,2", observed: "class=x", from: "400",
    mu: "-0.1", push: "0", fx: "101", mz: "left", plane: "fx,fx", thread: "M".repeat(101),
    assembly: "roll=1", point: "-1", success: "phases=5%26roll=0%26pitch=0%26phase=0%26unit=mm", kept_success: "phases=1",
    success_at: "3 -11", success_critical: "1", kept_success_critical: "left 2",
  };
  for (const [key, text] of Object.entries(bad)) {
    const { view, remarks } = readFragment(`${key}=${text}&azimuth=3&x=1&constructor=1`);
    assert.deepEqual(view, { azimuth: 3 }, key);
    assert.equal(remarks.length, 1, key);
  }
  assert.deepEqual(readFragment("#roll=12").remarks, ["roll in the link is 12; valid: -10 to 10 deg"]);
});

test("a number is written in decimals", () => {
  for (const text of ["0x4", "0b1", " 4", "1_0", "Infinity", "4 deg", ".", "1e"]) {
    assert.deepEqual(readFragment(`#phase=${encodeURIComponent(text)}`).view, {}, text);
    assert.equal(readFragment(`#poses=${encodeURIComponent(`${text.replaceAll(" ", "_")},0,0`)}`).view.poses, undefined, text);
  }
  for (const [text, phase] of [["4", 4], ["4.", 4], [".5", 0.5], ["%2B1e-7", 1e-7], ["12.5E1", 125]]) {
    assert.deepEqual(readFragment(`#phase=${text}`).view, { phase });
  }
});

test("any angle is restored exactly; a phase is wrapped into one turn and reported", () => {
  assert.deepEqual(readFragment("#roll=2.5&pitch=-1.2&phase=357.38"), { view: { roll: 2.5, pitch: -1.2, phase: 357.38 }, remarks: [] });
  assert.deepEqual(readFragment("#phase=400"), { view: { phase: 40 }, remarks: ["phase 400 deg is 40 deg within the turn"] });
  assert.deepEqual(readFragment("#phase=-5"), { view: { phase: 355 }, remarks: ["phase -5 deg is 355 deg within the turn"] });
});

test("a jump is an entry of the history, a gradual change is not", () => {
  const step = (...names) => isStep(new Set(names), null);
  assert.ok(step("roll") && step("pitch") && step("tab") && step("library"));
  assert.ok(!step("phase") && !step("azimuth", "elevation") && !step("from", "span") && !step("unit"));
  assert.ok(isStep(new Set(["phase"]), "entry"));
  assert.ok(!isStep(new Set(["roll"]), "restored"));
});

test("listeners are called with what differs, and with nothing else", () => {
  const view = new View({ phase: 10 });
  const heard = [];
  view.follow((now, changed) => heard.push([now.phase, [...changed]]));
  view.set({ phase: 10 });
  view.set({ phase: 11, roll: 0 });
  assert.deepEqual(heard, [[11, ["phase"]]]);
});

const LIBRARY = { id: 3, designation: "M6x1", stored_unit: "in" };
const POSE = { roll: 4, pitch: -3, phase: 185 };

test("a stored state is fetched by its address, in the unit shown", () => {
  const stored = { pose: POSE, unit: "in", stored: true };
  assert.equal(curlLine("http://h", LIBRARY, stored), 'curl "http://h/v1/libraries/3/states/4/-3/185"');
  assert.match(curlLine("http://h", LIBRARY, { ...stored, unit: "mm" }), /states\/4\/-3\/185\?unit=mm"/);
  assert.match(pythonLines("http://h", LIBRARY, stored), /state = client\.state\(4, -3, 185, library=3, unit="in"\)/);
});

test("where a key is needed the lines show it, from a variable and not itself", () => {
  for (const stored of [true, false]) {
    const state = { pose: POSE, unit: "in", stored };
    assert.match(curlLine("http://h", LIBRARY, state, true), / -H "Authorization: Bearer \$KEY"/);
    assert.match(pythonLines("http://h", LIBRARY, state, true), /Client\("http:\/\/h", key=os\.environ\["KEY"\]\)/);
    assert.doesNotMatch(curlLine("http://h", LIBRARY, state, false) + pythonLines("http://h", LIBRARY, state, false), /Authorization|KEY/);
  }
});

test("a solved state is fetched by its pose, with the pair and the tolerances of the library", () => {
  const solved = { pose: POSE, unit: "mm", stored: false };
  const body = JSON.parse(curlLine("http://h", LIBRARY, solved).match(/-d '(.*)'/)[1]);
  assert.deepEqual(body, { library: 3, poses: [POSE] });
  assert.match(pythonLines("http://h", LIBRARY, solved), /client\.solve\(\[\(4, -3, 185\)\], library=3, unit="mm"\)\.states\[0\]/);
});
