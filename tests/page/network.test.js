import assert from "node:assert/strict";
import { test } from "node:test";

import { bandsOf, formationsAlong } from "../../service/explorer/page/js/overview.js";
import { TABS, tabAfter } from "../../service/explorer/page/js/tabs.js";

const formation = (key, stateClass, least) => ({ key, class: stateClass, to_window: { least } });

test("formations stand in bands by their turning to the window, the farthest first, those within it last", () => {
  const bands = bandsOf(
    [
      formation("a", "stable_three_point", 3),
      formation("b", "unstable_two_point", 14.9),
      formation("c", "stable_three_point", 359),
      formation("d", null, null),
      formation("e", "stable_three_point", 9),
      formation("f", "stable_three_point", 360),
    ],
    9,
  );
  assert.deepEqual(
    bands.map(({ title, lines }) => [title, lines.map((line) => line.map(({ key }) => key))]),
    [["345–360", [["f", "c"]]], ["0–15", [["b", "e", "a"]]], ["within", [["d"]]]],
  );
});

test("a band with more formations than a line holds goes on in the next", () => {
  const many = Array.from({ length: 23 }, (_, k) => formation(`k${k}`, "stable_three_point", k / 2));
  const [{ lines }] = bandsOf(many, 10);
  assert.deepEqual(lines.map((line) => line.length), [10, 10, 3]);
  assert.equal(new Set(lines.flat().map(({ key }) => key)).size, 23);
});

test("a formation that a path stays in is listed once", () => {
  const path = { steps: ["a", "a", "b", "c", "c", "a"].map((key) => ({ formation: key })) };
  assert.deepEqual(formationsAlong(path), ["a", "b", "c", "a"]);
  assert.deepEqual(formationsAlong(null), []);
});

test("arrows go round the tabs", () => {
  assert.equal(tabAfter("ArrowRight", TABS.at(-1)), TABS[0]);
  assert.equal(tabAfter("ArrowLeft", TABS[0]), TABS.at(-1));
  assert.equal(tabAfter("Home", TABS[2]), TABS[0]);
  assert.equal(tabAfter("End", TABS[0]), TABS.at(-1));
  assert.equal(tabAfter("x", TABS[0]), null);
});
