import assert from "node:assert/strict";
import { test } from "node:test";

import { angleTicks, decimalsOf, ticks } from "../../service/explorer/page/js/ticks.js";

test("ticks are round, within the range and not too many", () => {
  assert.deepEqual(ticks(-0.0052, 0.0081, 6), [-0.005, -0.0025, 0, 0.0025, 0.005, 0.0075]);
  for (const [low, high] of [[0, 1], [-3e-9, 7e-9], [999, 1001], [-0.1, 5000]]) {
    for (const most of [3, 6, 11]) {
      const found = ticks(low, high, most);
      assert.ok(found.length >= 1 && found.length <= most + 1, `${low} ${high} ${most}: ${found}`);
      assert.ok(found[0] >= low - 1e-9 * (high - low) && found.at(-1) <= high + 1e-9 * (high - low));
    }
  }
});

test("a whole turn is parted into twelve, a part of a degree into decimals", () => {
  assert.deepEqual(angleTicks(0, 360, 12), [0, 30, 60, 90, 120, 150, 180, 210, 240, 270, 300, 330, 360]);
  assert.deepEqual(angleTicks(357, 357.1, 5).map((tick) => tick.toFixed(3)), ["357.000", "357.020", "357.040", "357.060", "357.080", "357.100"]);
});

test("ticks are written with as many decimals as they differ by", () => {
  assert.equal(decimalsOf([0, 0.0025]), 4);
  assert.equal(decimalsOf([30, 60]), 0);
  assert.equal(decimalsOf([1]), 0);
});
