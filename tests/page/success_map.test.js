import assert from "node:assert/strict";
import { test } from "node:test";

import { ProblemError } from "../../service/explorer/page/js/api.js";
import { requestOf } from "../../service/explorer/page/js/assembly.js";
import { SuccessMap, cellOf, checkedMap, keyOf, lateSnapsOf, mapRequestOf, mapText, orientationsOf, pathText, storedMapText, totalsOf } from "../../service/explorer/page/js/success_map.js";
import { criticalsWords, mapWords } from "../../service/explorer/page/js/success_words.js";
import { successTable } from "../../service/explorer/page/js/tables.js";

const GRID = { tilt_max: 4, tilt_step: 4 };
const REQUEST = { ...requestOf(""), mu: "0.1", k_tilt: "250", strategy: "cw", unit: "mm" };
const TEXT = mapText(2, REQUEST);

/** A service at which the paths of a roll above 0 do not snap above a friction. */
class Service {
  asked = [];

  constructor(critical) {
    this.critical = critical;
  }

  outcomes(body, unit, signal) {
    this.asked.push({ body, unit, signal });
    if (signal.aborted) return Promise.reject(new Error("aborted"));
    const mu = body.mu ?? 0;
    return Promise.resolve(body.poses.map((pose) => ({
      ...pose, mu, outcome: pose.roll > 0 && mu > this.critical ? "no_snap" : "engaged", flags: [], bounded: false, torque: 1 + pose.pitch / 8, tilt: 3, shift: 0.01, end: -90,
    })));
  }
}

function computed(map) {
  return new Promise((done) => {
    const look = () => (map.value !== null && !map.value.isRunning ? done() : setTimeout(look, 1));
    look();
  });
}

test("a map's request goes into the link and comes back the same", () => {
  assert.equal(TEXT, "phases=2&roll=0&pitch=0&phase=0&mu=0.1&k_tilt=250&strategy=cw&unit=mm");
  assert.deepEqual(mapRequestOf(TEXT), { stored: null, phases: 2, request: { ...REQUEST, roll: "0", pitch: "0", phase: "0" } });
  assert.equal(checkedMap(TEXT), TEXT);
  assert.equal(mapText(2, { ...REQUEST, confirm: "yes" }), TEXT);
  for (const text of ["", "phases=5&roll=0&pitch=0&phase=0&unit=mm", "phases=2", TEXT.replace("cw", "sideways"), `${TEXT}&phases=1`, `${TEXT}&confirm=yes`]) assert.equal(checkedMap(text), undefined, text);
  assert.equal(pathText(TEXT, { roll: 3, pitch: -2, phase: 180 }), "roll=3&pitch=-2&phase=180&mu=0.1&k_tilt=250&strategy=cw&unit=mm");
});

const DEVICE = { unit: "mm", k_lateral: 20, k_axial: 0, k_tilt: 250, k_twist: "rigid", stiffness: null, centre: 0, push: 10, about: "nut", ccw_turn: 390 };
const STORED = { id: 7, device: DEVICE, strategy: "cw", mu: [0, 0.1], grid: { tilt_max: 1, tilt_step: 1, phase_step: 72 } };
const STORED_TEXT = storedMapText(STORED, 0.1);
const LIMITED = { ...STORED, device: { ...DEVICE, tilt_limit: 3, shift_limit: null, torque_limit: null } };

/** A service with a stored map in pages of an orientation. */
class Store {
  get(path) {
    if (path === "/v1/success-maps/7") return Promise.resolve(STORED);
    const after = Number(new URL(path, "http://store").searchParams.get("after") ?? -1);
    const cell = (phase, mu) => ({ phase, mu, outcome: "engaged", flags: [], bounded: false, torque: 1, tilt: 3, shift: 0.01, end: -90 });
    const cells = [0, 36, 72, 144, 216, 288].flatMap((phase) => [cell(phase, 0), cell(phase, 0.1)]);
    return Promise.resolve({ orientations: [{ roll: after, pitch: 0, cells }], next: after < 1 ? `${path.split("?")[0]}/orientations?after=${after + 1}` : null });
  }
}

test("a stored map goes into the link with its device, one with a whole matrix does not", () => {
  assert.equal(STORED_TEXT, "stored=7&phases=5&unit=mm&k_tilt=250&ccw_turn=390&strategy=cw&mu=0.1&roll=0&pitch=0&phase=0");
  assert.equal(storedMapText(LIMITED, 0.1), STORED_TEXT.replace("390", "390&tilt_limit=3"));
  assert.equal(checkedMap(STORED_TEXT), STORED_TEXT);
  assert.equal(mapRequestOf(STORED_TEXT).stored, 7);
  assert.equal(pathText(STORED_TEXT, { roll: 1, pitch: 0, phase: 72 }), "roll=1&pitch=0&phase=72&mu=0.1&k_tilt=250&ccw_turn=390&strategy=cw&unit=mm");
  assert.equal(storedMapText({ ...STORED, device: { ...DEVICE, stiffness: [[1]] } }, 0), null);
});

test("a stored map is read page by page, at its friction and the phases of its grid", async () => {
  const map = new SuccessMap(new Store(), () => {});
  map.follow(STORED_TEXT, 1, GRID, "in");
  await computed(map);
  assert.equal(map.value.problem, null);
  assert.deepEqual(map.value.grid, STORED.grid);
  assert.deepEqual([...map.value.cells.keys()], ["-1 0", "0 0", "1 0"]);
  assert.deepEqual(map.value.cells.get("0 0").map(({ roll, phase, mu }) => [roll, phase, mu]), [0, 72, 144, 216, 288].map((phase) => [0, phase, 0.1]));
});

test("a number under which another map is stored is a problem, not that map", async () => {
  for (const text of [STORED_TEXT.replace("k_tilt=250", "k_tilt=300"), STORED_TEXT.replace("mu=0.1", "mu=0.2")]) {
    const map = new SuccessMap(new Store(), () => {});
    map.follow(text, 1, GRID, "in");
    await computed(map);
    assert.match(map.value.problem, /stored map 7 is another one/);
    assert.equal(map.value.cells.size, 0);
  }
});

test("orientations near level come first, each once", () => {
  const found = orientationsOf(GRID);
  assert.equal(found.length, 9);
  assert.deepEqual(found[0], { roll: 0, pitch: 0 });
  assert.deepEqual(new Set(found.slice(5).map(({ roll, pitch }) => Math.abs(roll) + Math.abs(pitch))), new Set([8]));
});

test("a corner comes first, alone, then two at a time from level outwards and from the corners inwards, from phase 0 first", async () => {
  const service = new Service(1);
  const map = new SuccessMap(service, () => {});
  map.follow(TEXT, 7, GRID, "in");
  assert.equal(service.asked.length, 1);
  await computed(map);
  const poses = service.asked.map(({ body }) => body.poses[0]);
  assert.deepEqual(poses.slice(0, 3), [{ roll: 4, pitch: 4, phase: 0 }, { roll: 0, pitch: 0, phase: 0 }, { roll: 4, pitch: -4, phase: 0 }]);
  assert.deepEqual(poses.map(({ phase }) => phase), [...Array(9).fill(0), ...Array(9).fill(180)]);
});

test("the worst path of a cell is one that certainly fails, else an undecided one, else the hardest", () => {
  const path = (outcome, torque, phase) => ({ outcome, torque, phase });
  const all = [path("engaged", 1, 0), path("engaged", 2, 90), path("undecided", null, 180), path("no_snap", 0.1, 270)];
  assert.equal(cellOf(all).worst.phase, 270);
  assert.equal(cellOf(all.slice(0, 3)).worst.phase, 180);
  assert.equal(cellOf(all.slice(0, 2)).worst.phase, 90);
  assert.deepEqual([cellOf(all).count, cellOf(all).engaged, cellOf(all).undecided], [4, 2, 1]);
});

test("a map is computed with every phase of every orientation, and says where it fails", async () => {
  const service = new Service(0.05);
  let changes = 0;
  const map = new SuccessMap(service, () => (changes += 1));
  map.follow(TEXT, 7, GRID, "in");
  await computed(map);
  assert.equal(service.asked.length, 18);
  assert.ok(changes >= 18);
  const [{ body, unit }] = service.asked;
  assert.deepEqual(body.poses, [{ roll: 4, pitch: 4, phase: 0 }]);
  assert.deepEqual(service.asked[9].body.poses, [{ roll: 0, pitch: 0, phase: 180 }]);
  assert.deepEqual(map.value.cells.get("0 0").map(({ phase }) => phase), [0, 180]);
  assert.deepEqual([body.library, body.mu, body.strategy, body.device, unit], [7, 0.1, "cw", { unit: "mm", k_tilt: 250, about: "nut" }, "in"]);
  assert.equal(body.pose, undefined);
  const totals = totalsOf(map.value);
  assert.deepEqual([totals.done, totals.engaged, totals.undecided, totals.orientations], [9, 6, 0, 9]);
  assert.deepEqual([totals.failure.roll, totals.failure.pitch], [4, 0]);
  assert.equal(
    mapWords(map.value, "in"),
    "Of 9 orientations 6 engage from each of 2 phases at μ = 0.1. The least tilt that fails: roll 4 deg, pitch 0 deg, which does not snap. " +
      "Paths that engage ask for up to 1.500 N in of torque, 3.00 deg of tilt and 0.0100 in of shift.",
  );
  map.follow(TEXT, 7, GRID, "mm");
  assert.equal(service.asked.length, 18, "another unit is no other map");
});

for (const [hand, engagedEnd, failedEnd] of [["right", 95, 90], ["left", 265, -90]]) {
  test(`a ${hand}-hand path that ends before a snap of another phase is counted, with the turn that reaches it`, () => {
    const path = (phase, outcome, end) => ({ roll: 0, pitch: 0, phase, mu: 0.1, outcome, flags: [], bounded: false, torque: 1, tilt: 1, shift: 0.01, end });
    const map = (text, cells) => ({ text, unit: "in", grid: GRID, cells: new Map(cells) });
    const text = TEXT.replace("&strategy=cw", "");
    const late = [path(0, "no_snap", failedEnd), path(180, "engaged", engagedEnd)];
    const never = [path(0, "no_snap", failedEnd), path(180, "no_snap", failedEnd + 180)];
    assert.deepEqual(lateSnapsOf(map(text, [["0 0", late], ["0 4", never]])), { paths: 1, turn: 365 });
    assert.deepEqual(lateSnapsOf(map(text, [["0 4", never]])), { paths: 0, turn: null });
    assert.deepEqual(lateSnapsOf(map(TEXT, [["0 0", late]])), { paths: 0, turn: null });
    assert.ok(mapWords(map(text, [["0 0", late]]), "in").endsWith(" 1 path ends before a snap that others of its orientation meet: a ccw turn of 365 deg reaches it."));
  });
}

test("of a map that is not whole only whole orientations count", async () => {
  const map = new SuccessMap(new Service(0.05), () => {});
  map.follow(TEXT, 7, GRID, "in");
  await computed(map);
  for (const [key, outcomes] of map.value.cells) map.value.cells.set(key, outcomes.slice(0, 1));
  assert.deepEqual([totalsOf(map.value).done, totalsOf(map.value).engaged, totalsOf(map.value).failure], [0, 0, null]);
  assert.equal(mapWords(map.value, "in"), "From phase 0 alone 9 orientations are computed so far (of 9): small squares.");
});

test("a map that is cancelled or replaced is not computed any further", async () => {
  const service = new Service(1);
  const map = new SuccessMap(service, () => {});
  map.follow(TEXT, 7, GRID, "in");
  map.cancel();
  assert.equal(map.value.isRunning, false);
  await new Promise((done) => setTimeout(done, 5));
  assert.ok(service.asked.length < 9);
  map.follow("", 7, GRID, "in");
  assert.equal(map.value, null);
});

test("what is refused is said", async () => {
  const refused = new ProblemError(400, { detail: "Invalid value", errors: [{ location: "body mu", value: "2", valid: "0 to 1" }] });
  const map = new SuccessMap({ outcomes: () => Promise.reject(refused) }, () => {});
  map.follow(TEXT, 7, GRID, "in");
  await computed(map);
  assert.equal(map.value.problem, "Invalid value");
  assert.deepEqual(map.value.errors, refused.errors);
});

test("the critical friction of an orientation is bracketed to 0.01", async () => {
  for (const [critical, place, words] of [
    [0.17, { roll: 4, pitch: 0 }, /engages up to μ = 0\.1[67]\d*, does not snap at μ = 0\.1[78]/],
    [-1, { roll: 4, pitch: 0 }, /does not snap even without friction/],
    [0, { roll: 0, pitch: 0 }, /engages up to μ = 0\.8, the largest that is tried/],
  ]) {
    const map = new SuccessMap(new Service(critical), () => {});
    map.follow(TEXT, 7, GRID, "in");
    await map.findCritical(place);
    const found = map.value.criticals.get(keyOf(place));
    assert.match(criticalsWords(map.value), words);
    if (critical > 0) assert.ok(found.last <= critical && critical < found.first && found.first - found.last < 0.0101);
  }
});

test("with a map the critical friction is computed that was asked for", async () => {
  const map = new SuccessMap(new Service(0.17), () => {});
  map.follow(TEXT, 7, GRID, "in", "4 0");
  while (map.isRunning) await new Promise((done) => setTimeout(done, 1));
  assert.deepEqual([...map.value.criticals.keys()], ["4 0"]);
  assert.ok(map.value.criticals.get("4 0").last <= 0.17);
  map.follow(TEXT.replace("k_tilt=250", "k_tilt=300"), 7, GRID, "in");
  while (map.isRunning) await new Promise((done) => setTimeout(done, 1));
  assert.equal(map.value.criticals.size, 0);
});

test("a critical friction that is cancelled says what is known", async () => {
  const map = new SuccessMap(new Service(0.3), () => {});
  map.follow(TEXT, 7, GRID, "in");
  await computed(map);
  const found = map.findCritical({ roll: 4, pitch: 0 });
  assert.equal(map.isRunning, true);
  map.cancel();
  await found;
  assert.equal(map.isRunning, false);
  assert.equal(criticalsWords(map.value), "roll 4 deg, pitch 0 deg: engages up to μ = 0, the largest that is tried.");
});

test("a map that is kept is the same with its critical frictions, and is not computed again", async () => {
  const service = new Service(0.17);
  const map = new SuccessMap(service, () => {});
  map.follow(TEXT, 7, GRID, "in");
  await computed(map);
  await map.findCritical({ roll: 4, pitch: 0 });
  const asked = service.asked.length;
  const kept = new SuccessMap(service, () => {});
  kept.adopt(map);
  kept.follow(TEXT, 7, GRID, "in");
  map.follow(TEXT.replace("k_tilt=250", "k_tilt=300"), 7, GRID, "in");
  map.cancel();
  assert.equal(service.asked.length, asked + 1);
  assert.equal(mapWords(kept.value, "in").slice(0, 32), "Of 9 orientations 9 engage from ");
  assert.match(criticalsWords(kept.value), /^roll 4 deg, pitch 0 deg: engages up to/);
});

test("a refused map leaves the one before it, with the problem", async () => {
  const service = new Service(1);
  const map = new SuccessMap(service, () => {});
  map.follow(TEXT, 7, GRID, "in");
  await computed(map);
  service.outcomes = () => Promise.reject(new ProblemError(400, { detail: "Invalid value", errors: [{ location: "body mu", value: "2", valid: "0 to 1" }] }));
  map.follow(TEXT.replace("mu=0.1", "mu=2"), 7, GRID, "in");
  await computed(map);
  assert.deepEqual([map.value.text, map.value.cells.size, map.value.problem], [TEXT, 9, "Invalid value"]);
});

test("a table of a map is in the order of its orientations, with the device", async () => {
  const map = new SuccessMap(new Service(1), () => {});
  map.follow(TEXT, 7, GRID, "mm");
  await computed(map);
  const [head, first, second] = successTable({ success: map });
  assert.deepEqual([head.indexOf("roll"), head.indexOf("strategy") + 1], [0, head.indexOf("push")]);
  const value = (row, name) => row[head.indexOf(name)];
  assert.deepEqual(["roll", "pitch", "phase"].map((name) => value(first, name)), [-4, -4, 0]);
  assert.deepEqual(["roll", "pitch", "phase"].map((name) => value(second, name)), [-4, -4, 180]);
  assert.deepEqual(["push", "k_lateral", "k_tilt", "k_twist", "centre", "ccw_turn", "torque_limit", "about", "device_unit"].map((name) => value(first, name)), ["10", "20", "250", "rigid", "0", "360", "any", "nut", "mm"]);
});
