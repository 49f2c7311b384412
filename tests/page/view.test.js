import assert from "node:assert/strict";
import { test } from "node:test";

import { curlLine, pythonLines } from "../../service/explorer/page/js/snippets.js";
import { fragmentOf, viewOf } from "../../service/explorer/page/js/url_state.js";
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
};

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

test("what is not valid in a fragment is left out", () => {
  const bad = "roll=11&pitch=&phase=360&unit=ft&theme=red&span=0&library=-1&stage=NaN&nut=&tab=numbers&x=1&constructor=1&distance=1e999";
  assert.deepEqual(viewOf(bad), {});
});

test("followers hear of what differs, and of nothing else", () => {
  const view = new View({ phase: 10 });
  const heard = [];
  view.follow((now, changed) => heard.push([now.phase, [...changed]]));
  view.set({ phase: 10 });
  view.set({ phase: 11, roll: 0 });
  assert.deepEqual(heard, [[11, ["phase"]]]);
});

const LIBRARY = { id: 3, designation: "1/4-20 UNC", stored_unit: "in" };
const POSE = { roll: 4, pitch: -3, phase: 185 };

test("a stored state is fetched by its address, in the unit shown", () => {
  assert.equal(curlLine("http://h", LIBRARY, { pose: POSE, unit: "in", stored: true }), 'curl "http://h/v1/libraries/3/states/4/-3/185"');
  assert.match(pythonLines("http://h", LIBRARY, { pose: POSE, unit: "mm", stored: true }), /states\/4\/-3\/185\?unit=mm"/);
});

test("where a key is needed the lines show it, from a variable and not itself", () => {
  for (const stored of [true, false]) {
    const state = { pose: POSE, unit: "in", stored };
    assert.match(curlLine("http://h", LIBRARY, state, true), / -H "Authorization: Bearer \$KEY"/);
    assert.match(pythonLines("http://h", LIBRARY, state, true), /"Authorization": f"Bearer {os.environ\['KEY'\]}"/);
    assert.doesNotMatch(curlLine("http://h", LIBRARY, state, false) + pythonLines("http://h", LIBRARY, state, false), /Authorization/);
  }
});

test("a solved state is fetched by its pose", () => {
  const line = curlLine("http://h", LIBRARY, { pose: POSE, unit: "mm", stored: false });
  const body = JSON.parse(line.match(/-d '(.*)'/)[1]);
  assert.deepEqual(body, { poses: [POSE], designation: "1/4-20 UNC" });
});
