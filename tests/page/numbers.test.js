import assert from "node:assert/strict";
import { test } from "node:test";

import { changeText } from "../../service/explorer/page/js/follows_view.js";
import { stepLabels } from "../../service/explorer/page/js/path_view.js";
import { nearestThreshold, stableShare } from "../../service/explorer/page/js/quantities.js";
import { stateLine } from "../../service/explorer/page/js/terms.js";
import { csvOf } from "../../service/explorer/page/js/csv.js";
import { linesOf } from "../../service/explorer/page/js/save.js";
import { angle, angleNumber, fixed, wrapAngle, length, percent, shortLength } from "../../service/explorer/page/js/units.js";
import { wrapped } from "../../service/explorer/page/js/wrap.js";

test("lengths have the decimals of their unit, and are never rounded to nothing", () => {
  assert.equal(length(0.0012345678, "in"), "0.001235 in");
  assert.equal(length(-0.0012345678, "mm"), "−0.00123 mm");
  assert.equal(length(2.4e-9, "in"), "2.4e−9 in");
  assert.equal(length(0, "in"), "0.000000 in");
  assert.equal(length(null, "in"), "none");
});

test("round-off among lengths is zero", () => {
  assert.equal(length(8.7e-19, "in"), "0.000000 in");
  assert.equal(length(-8.7e-19, "mm"), "0.00000 mm");
  assert.deepEqual([shortLength(0.01099, "in"), shortLength(0.2791, "mm"), shortLength(3e-6, "in")], ["0.0110", "0.279", "3.0e−6"]);
});

test("angles lose trailing zeros and nothing else", () => {
  assert.equal(angle(357.380892), "357.380892 deg");
  assert.equal(angleNumber(-4), "−4");
  assert.equal(angleNumber(100, 0), "100");
  assert.equal(angle(null), "none");
});

test("what rounds to zero has no sign", () => {
  assert.equal(fixed(-1e-9, 3), "0.000");
  assert.equal(fixed(-0.001, 3), "−0.001");
});

test("phases are wrapped into one turn", () => {
  assert.equal(wrapAngle(395.25), 35.25);
  assert.equal(wrapAngle(-2), 358);
  assert.ok(Object.is(wrapAngle(-360), 0));
});

test("shares keep what is small visible", () => {
  assert.deepEqual([1, 0.2249, 0.0123, 0.0001, 0].map(percent), ["100 %", "22 %", "1.2 %", "< 0.1 %", "0.0 %"]);
});

test("cells of a table read back the same", () => {
  assert.equal(csvOf([["a", 'b "c"', null], [0.1 + 0.2, "x,y", "z\n"]]), 'a,"b ""c""",\r\n0.30000000000000004,"x,y","z\n"\r\n');
});

test("text is wrapped at words and cut with an ellipsis", () => {
  assert.deepEqual(wrapped("contact 2.1 nut flank to surface", 20, 2), ["contact 2.1 nut", "flank to surface"]);
  assert.deepEqual(wrapped("contact 2.1 nut flank to surface again", 16, 2), ["contact 2.1 nut", "flank to surfac…"]);
});

test("a state is one line of text, and a change of class names the new one", () => {
  assert.equal(stateLine({ class: "unstable_two_point", flags: ["no_third", "tie"] }), "unstable two-point, no third contact, tie");
  const change = "unstable two-point to stable three-point; contact 1.1 nut crest to flank";
  assert.equal(changeText(change, "stable_three_point"), "to stable three-point; contact 1.1 nut crest to flank");
  assert.equal(changeText("contact 1.1 lost", "stable_three_point"), "contact 1.1 lost");
  assert.equal(changeText("", "stable_three_point"), "the same contacts");
});

test("steps of a path have as few decimals as distinguish them", () => {
  const step = (phase, within = false) => ({ phase, in_window: within });
  const steps = [step(10), step(355.6), step(355.67201), step(355.67262), step(357.1), step(360.5, true)];
  assert.deepEqual(stepLabels(steps), ["here", "355.6", "355.672", "355.673", "357.1", "window"]);
});

test("a class is as certain as the nearest of its numbers", () => {
  assert.equal(nearestThreshold({ drop: 0.3, embedment: -0.1, pivot_offset: null }), 0.1);
  assert.equal(nearestThreshold({ drop: null, embedment: null, pivot_offset: null }), null);
  assert.equal(stableShare({ stable_three_point: 3, quasi_stable_two_point: 1, unstable_two_point: 0 }), 0.75);
  assert.equal(stableShare({ stable_three_point: 0, quasi_stable_two_point: 0, unstable_two_point: 0 }), null);
});

test("a caption is put into lines of so many letters, longer words alone", () => {
  assert.deepEqual(linesOf("", 10), []);
  assert.deepEqual(linesOf("push (N) 15, k lateral 30; ccw", 12), ["push (N) 15,", "k lateral", "30; ccw"]);
  assert.deepEqual(linesOf("a compensation b", 6), ["a", "compensation", "b"]);
});
