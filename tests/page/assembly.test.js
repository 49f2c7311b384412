import assert from "node:assert/strict";
import { test } from "node:test";

import { assemblyText, bodyOf, checkedAssembly, convertedText, defaultText, deviceOf, isSameRequest, labelOf, progressText, refusedFields, requestOf } from "../../service/explorer/page/js/assembly.js";
import { eventsOf } from "../../service/explorer/page/js/events.js";

const POSE = { roll: "1", pitch: "-2", phase: "10", unit: "mm" };

test("a request goes into the link without its defaults and comes back the same", () => {
  const request = { ...requestOf(""), ...POSE, k_tilt: "250", k_twist: "rigid", strategy: "cw" };
  const text = assemblyText(request);
  assert.equal(text, "roll=1&pitch=-2&phase=10&k_tilt=250&k_twist=rigid&strategy=cw&unit=mm");
  assert.deepEqual(requestOf(text), request);
  assert.equal(checkedAssembly(text), text);
});

test("a link has a pose, a unit, and numbers and choices that the page knows", () => {
  const text = assemblyText({ ...requestOf(""), ...POSE });
  assert.equal(text, "roll=1&pitch=-2&phase=10&unit=mm");
  for (const more of ["&mu=0.1", "&k_twist=rigid", "&about=bolt", "&ccw_turn=390", "&centre=-2e0"]) assert.equal(checkedAssembly(text + more), text + more);
  for (const more of ["&mu=x", "&k_tilt=rigid", "&about=me", "&unit=ft", "&roll=2", "&spring=1", "&push="]) assert.equal(checkedAssembly(text + more), undefined, more);
  assert.equal(checkedAssembly("roll=1&pitch=-2&phase=10"), undefined);
});

test("what is left empty is left out of the request, what is no number is sent as it is", () => {
  const text = assemblyText({ ...requestOf(""), ...POSE, roll: "", mu: "0.1", push: "4 N", k_twist: "rigid", about: "bolt" });
  assert.deepEqual(bodyOf(text, 3), {
    library: 3,
    pose: { roll: "", pitch: -2, phase: 10 },
    device: { unit: "mm", push: "4 N", k_twist: "rigid", about: "bolt" },
    strategy: "ccw_then_cw",
    mu: 0.1,
  });
});

test("a path is confirmed where that is chosen", () => {
  const text = assemblyText({ ...requestOf(""), ...POSE, confirm: "yes" });
  assert.equal(checkedAssembly(text), text);
  assert.equal(bodyOf(text, 3).confirm, true);
  assert.ok(!("confirm" in bodyOf(assemblyText({ ...requestOf(""), ...POSE }), 3)));
});

test("lengths are converted, and back again to the same text", () => {
  assert.equal(defaultText("k_lateral", "in"), "508");
  assert.equal(defaultText("k_tilt", "in"), "19.685");
  assert.equal(defaultText("k_twist", "in"), "rigid");
  assert.equal(defaultText("roll", "in"), null);
  for (const [name, text] of [["k_tilt", "250"], ["centre", "-2.5"], ["k_axial", "7"], ["mu", "0.3"], ["centre", "two"], ["k_twist", "rigid"]]) {
    assert.equal(convertedText(name, convertedText(name, text, "mm", "in"), "in", "mm"), text);
  }
  assert.equal(labelOf("k_tilt", "in"), "k tilt (N in/rad)");
  assert.equal(labelOf("push", "in"), "push (N)");
  assert.deepEqual(deviceOf("centre=-25.4&unit=mm", "in"), { push: 10, centre: -1 });
});

test("a refused value is reported at its field, anything else in a line of its own", () => {
  const errors = [
    { location: "body device k_tilt", value: "-1", valid: "a stiffness >= 0" },
    { location: "body pose roll", value: "", valid: "a valid number" },
    { location: "body device k_twist float", value: "soft", valid: "a valid number" },
    { location: "body device k_twist literal['rigid']", value: "soft", valid: "'rigid'" },
  ];
  assert.deepEqual(refusedFields("all", errors), {
    k_tilt: "-1 is not valid: a stiffness >= 0",
    roll: "empty is not valid: a valid number",
    k_twist: "soft is not valid: a valid number; 'rigid'",
  });
  assert.deepEqual(refusedFields("the kernels are being compiled", []), { "": "the kernels are being compiled" });
});

test("requests are the same in whatever unit their lengths are", () => {
  const one = { ...requestOf(""), k_tilt: "254", centre: "2.54", unit: "mm" };
  const names = ["k_tilt", "centre", "k_twist", "strategy"];
  assert.ok(isSameRequest(one, { ...one, k_tilt: "10", centre: "0.1", unit: "in" }, names));
  assert.ok(isSameRequest({ ...one, centre: "0", k_twist: "rigid" }, { ...one, centre: "" }, names));
  for (const other of [{ centre: "2.55" }, { k_tilt: "" }, { k_twist: "5" }, { strategy: "cw" }]) assert.ok(!isSameRequest(one, { ...one, ...other }, names));
  assert.ok(isSameRequest(one, { ...one, push: "5" }, names));
});

test("progress is said in words", () => {
  assert.equal(progressText(null), "the bolt settles …");
  assert.equal(progressText({ leg: 0, points: 0, phase: null }), "the bolt settles …");
  assert.equal(progressText({ leg: 2, points: 40, phase: -3.25 }), "turn 2: 40 points so far, phase −3.3 deg …");
});

test("events are read wherever the chunks of a stream end", async () => {
  const text = ': nothing new\n\nevent: progress\ndata: {"leg":1}\n\nevent: answer\ndata: {"outcome":"idle: x"}\n\n';
  for (const size of [1, 7, text.length]) {
    const chunks = Array.from({ length: Math.ceil(text.length / size) }, (_, k) => text.slice(k * size, (k + 1) * size));
    const found = [];
    for await (const one of eventsOf(chunks)) found.push(one);
    assert.deepEqual(found, [{ event: "progress", data: '{"leg":1}' }, { event: "answer", data: '{"outcome":"idle: x"}' }]);
  }
});
