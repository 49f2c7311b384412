import assert from "node:assert/strict";
import { test } from "node:test";

import { lineOfAction, loadOf, pieceText, verdictText } from "../../service/explorer/page/js/load.js";
import { mapValues } from "../../service/explorer/page/js/map_view.js";
import { DEFAULTS } from "../../service/explorer/page/js/view.js";

test("a load is a push and parts of it, moments over its lever of a radius", () => {
  assert.deepEqual(loadOf(DEFAULTS, 3), { force: [0, 0, -1], moment: [0, 0, 0] });
  const view = { ...DEFAULTS, push: 10, fx: 0.5, fy: -0.25, mx: 1, my: -0.5, mz: 0.25 };
  assert.deepEqual(loadOf(view, 2), { force: [5, -2.5, -10], moment: [20, -10, 5] });
});

test("the line of action goes where the moment says, and not along the force", () => {
  assert.deepEqual(lineOfAction({ force: [0, 0, -2], moment: [0, 6, 0] }), [3, 0, 0]);
  assert.deepEqual(lineOfAction({ force: [0, 0, -2], moment: [0, 0, 5] }), [0, 0, 0]);
  assert.equal(lineOfAction({ force: [0, 0, 0], moment: [0, 0, 5] }), null);
});

test("a verdict says what the bolt does, and where nothing is real", () => {
  const held = { verdict: "can_stay", supported: false, penetrating: false };
  assert.match(verdictText(held), /can stay/);
  assert.match(verdictText({ ...held, supported: true }), /without any friction/);
  assert.match(verdictText({ ...held, verdict: "moves", penetrating: true }), /moves.*overlap.*no forces are real/);
  assert.match(verdictText({ ...held, verdict: "undecided" }), /Undecided/);
  assert.match(verdictText({ ...held, verdict: "can_wedge" }), /can wedge/);
});

test("a piece of a diagram's outline names the contacts that slide, stick and lift", () => {
  const sliding = (contact, side) => ({ contact, mode: "slides", side });
  const sticking = (contact) => ({ contact, mode: "sticks", side: null });
  assert.equal(
    pieceText({ contacts: [sliding(1, "up"), sticking(3)] }, [1, 2, 3]),
    "contact 1 slides, friction up; contact 3 sticks; contact 2 lifts off",
  );
  assert.equal(pieceText({ contacts: [sliding(2, null)] }, [2]), "contact 2 presses");
  const many = [4, 5, 6, 7, 8];
  assert.equal(pieceText({ contacts: many.map((one) => sliding(one, "in")) }, many), "5 contacts slide");
  assert.equal(pieceText({ contacts: many.map(sticking) }, [...many, 9]), "5 contacts stick; contact 9 lifts off");
});

test("the map has the least friction of each state, and none where there are no statics", () => {
  const states = [
    { roll: 0, pitch: 0, statics: { mu_hold: 0.25, mu_wedge: 2, support_margin: -0.1 } },
    { roll: 0, pitch: 1, statics: { mu_hold: null, mu_wedge: null, support_margin: 0 } },
    { roll: 1, pitch: 0, statics: null },
  ];
  const values = mapValues({ map: { states } }, { ...DEFAULTS, quantity: "mu_hold" });
  assert.deepEqual([...values.values()].map(({ value }) => value), [0.25, null, null]);
  assert.equal(values.get("0 0").text, "roll 0, pitch 0 deg: μ that holds 0.250");
  const orientations = [{ roll: 0, pitch: 0, mu_wedge_least: 1.5 }];
  const overAll = mapValues({ orientations, windows: null }, { ...DEFAULTS, quantity: "mu_wedge", over: "all" });
  assert.equal(overAll.get("0 0").text, "roll 0, pitch 0 deg: least friction that wedges 1.500");
});
