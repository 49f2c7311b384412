import assert from "node:assert/strict";
import { test } from "node:test";

import { textColourOn, scaleColour } from "../../service/explorer/page/js/colours.js";
import { depthCurves, heightAt, heightsOf, intervalAt, nextFormations, visibleParts } from "../../service/explorer/page/js/curve.js";
import { atPhase, phaseOf, sectors } from "../../service/explorer/page/js/disks.js";
import { notesOf } from "../../service/explorer/page/js/follows_view.js";
import { meshesOf } from "../../service/explorer/page/js/glb.js";
import { justAfter, isOnGrid, nearestPhase, nearestTilt, steppedPhase, steppedTilt, tilts } from "../../service/explorer/page/js/grid.js";
import { poseAt } from "../../service/explorer/page/js/motion.js";
import { followed, groupsOf } from "../../service/explorer/page/js/neighbours.js";
import { dragged, firstCamera, cameraAfterKey, cameraPosition, zoomed as nearer } from "../../service/explorer/page/js/orbit.js";
import { aroundEvent, middleOf, rangeOf, zoomed } from "../../service/explorer/page/js/zoom.js";

const near = (a, b, tolerance = 1e-12) => assert.ok(Math.abs(a - b) <= tolerance, `${a} is not ${b}`);

// Roll 1, pitch -2, phase 10 of 1/4-20 UNC, as the service answers: three stages (in).
const STATE = {
  poses: [
    {
      rotation: [[0.9842078347376879, -0.17422155711244894, -0.03133348174502098], [0.17354239588891238, 0.9845519963544601, -0.023246576169047115], [0.03489949670250097, 0.017441774902830158, 0.9992386149554826]],
      translation: [0, 0, 0.0011273504314240402],
    },
    {
      rotation: [[0.9837015134067832, -0.1742630874206265, -0.0443137550184492], [0.17458050900414965, 0.984637146149595, 0.003366941970578772], [0.04304623557357896, -0.011048383819017207, 0.9990119893264203]],
      translation: [9.276850983580494e-06, -1.9020373202443322e-05, -0.0025554769965039185],
    },
    {
      rotation: [[0.9825733339800912, -0.17397352529848675, -0.06544353173893198], [0.17466622764073306, 0.9846151453315257, 0.004972374235110018], [0.06357163103935137, -0.01631649714231459, 0.9978438854089359]],
      translation: [7.625219817537631e-05, -2.4109134183331895e-05, -0.003773984846447514],
    },
  ],
  contacts: [
    { stage: 1, point: [0.04892884619490892, -0.1144083831261144, 0] },
    { stage: 2, point: [0.06335717203244345, 0.07548894865978482, 0] },
  ],
};

test("the bolt passes through the poses of its stages, turning about its first contact", () => {
  for (const [k, pose] of STATE.poses.entries()) {
    for (const stage of k === 0 ? [1] : [k + 1, k + 1 - 1e-9]) {
      const found = poseAt(STATE, stage, 0.05);
      for (const i of [0, 1, 2]) {
        near(found.translation[i], pose.translation[i], 1e-10);
        for (const j of [0, 1, 2]) near(found.rotation[i][j], pose.rotation[i][j], 1e-9);
      }
    }
  }
  near(poseAt(STATE, 0, 0.05).translation[2], STATE.poses[0].translation[2] + 0.04);
});

test("between two stages the second turn leaves both contacts where they are", () => {
  const placed = ({ rotation, translation }, point) => rotation.map((row, i) => row.reduce((sum, value, j) => sum + value * point[j], translation[i]));
  const inBolt = ({ rotation, translation }, point) => [0, 1, 2].map((j) => rotation.reduce((sum, row, i) => sum + row[j] * (point[i] - translation[i]), 0));
  for (const { point } of STATE.contacts) {
    const fixed = inBolt(STATE.poses[1], point);
    placed(poseAt(STATE, 2.4, 0.05), fixed).forEach((value, i) => near(value, point[i], 1e-9));
  }
});

const contact = (stage, bolt, nut) => ({ stage, bolt_region: bolt, nut_region: nut });
const interval = (start, end, key, ...contacts) => ({ start, end, formation: { key, contacts } });
const CELLS = [
  interval(5, 100, "a", contact(1, "crest", "surface")),
  interval(100, 180, "a", contact(1, "crest", "surface"), contact(2, "flank_pos", "crest"), contact(2, "flank_neg", "crest")),
  interval(180, 365, "b", contact(1, "root", "surface")),
];
const INTERVALS = { history: { intervals: CELLS, boundaries: [], windows: [] } };

test("a phase is in the interval that holds it, also beyond a whole turn", () => {
  assert.equal(intervalAt(INTERVALS, 2).formation.key, "b");
  assert.equal(intervalAt(INTERVALS, 5).start, 5);
  assert.equal(intervalAt(INTERVALS, 364 - 360).inside, 272.5);
  assert.equal(intervalAt(null, 5), null);
});

test("the next formation is another one, whichever way the bolt turns", () => {
  assert.deepEqual(nextFormations(INTERVALS, 50), { ccw: "b", cw: "b" });
  assert.deepEqual(nextFormations(INTERVALS, 200), { ccw: "a", cw: "a" });
  assert.deepEqual(nextFormations({ history: { intervals: CELLS.slice(0, 1) } }, 50), { ccw: null, cw: null });
});

test("a stretch of phase is visible as often as the range repeats it", () => {
  assert.deepEqual(visibleParts(350, 370, 0, 360), [[0, 10], [350, 360]]);
  assert.deepEqual(visibleParts(350, 370, -20, 40), [[-10, 10]]);
  assert.deepEqual(visibleParts(10, 20, 30, 5), []);
});

test("depth breaks where it jumps and where a phase is undecided, and nowhere else", () => {
  const heights = {
    phases: [0, 40, 40.0000005, 90, 90.0000005, 180, 200, 220, 360],
    first_heights: [1, 2, 2.00001, 2, 1, 1, null, 1, 1],
    rest_heights: [0, 0, 0, 0, null, null, 0, 0, 0],
  };
  const { first, rest } = depthCurves(heights, 0.05);
  assert.deepEqual(first.map((run) => run.map(({ phase }) => phase)), [[0, 40, 40.0000005, 90], [90.0000005, 180], [220, 360]]);
  assert.deepEqual(rest.map((run) => run.map(({ phase }) => phase)), [[0, 40, 40.0000005, 90], [200, 220, 360]]);
  assert.equal(heightAt(first, 20), 1.5);
  assert.equal(heightAt(first, 200), null);
  assert.deepEqual(depthCurves({ ...heights, rest_heights: undefined }, 0.05).rest, []);
});

test("a history without heights of its own gives those of its states", () => {
  const at = (phase, embedment, ...heights) => ({
    phase,
    class: "stable_three_point",
    margins: { embedment },
    poses: heights.map((z) => ({ translation: [0, 0, z] })),
  });
  const history = { roll: 1, pitch: 2, states: [at(0, 1e-9, 3, 1), at(180, -1e-3, 4, 2)], undecided: [{ phase: 90 }] };
  assert.deepEqual(heightsOf(history), {
    roll: 1,
    pitch: 2,
    phases: [0, 90, 180, 360],
    first_heights: [3, null, 4, 3],
    rest_heights: [1, null, null, 1],
  });
});

test("sectors join where nothing changes and share a ring where a stage has several contacts", () => {
  assert.deepEqual(sectors(CELLS, 1, "nut_region"), [{ start: 5, end: 365, subring: 0, subrings: 1, region: "surface" }]);
  assert.deepEqual(sectors(CELLS, 2, "bolt_region").map(({ subring, subrings, region }) => [subring, subrings, region]), [[0, 2, "flank_pos"], [1, 2, "flank_neg"]]);
  assert.deepEqual(sectors(CELLS, 3, "bolt_region"), []);
});

test("a point of a disk has the phase at which it was drawn", () => {
  for (const phase of [0, 45, 123, 270, 359]) {
    const [x, y] = atPhase([100, 100], 1000, phase);
    near(phaseOf([100, 100], { x, y }), phase, 0.01);
  }
});

test("phases of the grid are stepped through in turn, from beside the grid too", () => {
  const grid = { tilt_max: 0.3, tilt_step: 0.1, phase_step: 1 };
  assert.deepEqual(tilts(grid), [-0.3, -0.2, -0.1, 0, 0.1, 0.2, 0.3]);
  assert.equal(nearestPhase(grid, 359.7), 0);
  assert.equal(steppedPhase(grid, 359, 1), 0);
  assert.equal(steppedPhase(grid, 0, -1), 359);
  assert.equal(steppedPhase(grid, 12.4, 1), 13);
  assert.equal(steppedPhase(grid, 12.4, -1), 12);
  assert.equal(steppedTilt(grid, 0.25, 1), 0.3);
  assert.equal(steppedTilt(grid, 0.3, 1), 0.4);
  assert.equal(steppedTilt(grid, -10, -1), -10);
  assert.ok(isOnGrid(grid, { roll: 0.3, pitch: -0.1 }) && !isOnGrid(grid, { roll: 0.25, pitch: 0 }) && !isOnGrid(grid, { roll: 0.4, pitch: 0 }));
  assert.ok(justAfter(357.38089147) > 357.38089147 && justAfter(357.38089147) < 357.380894);
});

test("a zoom keeps the phase under the pointer and never shows more than a turn", () => {
  const range = zoomed({ from: 0, span: 360 }, 0.5, 90);
  assert.deepEqual(range, { from: 45, span: 180 });
  assert.deepEqual(zoomed(range, 4, 90), { from: null, span: 360 });
  assert.equal(middleOf({ from: -20, span: 40, phase: 350 }), -10);
  assert.equal(middleOf({ from: 100, span: 40, phase: 350 }), 120);
  const window = { enter: 357, leave: 397 };
  assert.deepEqual(aroundEvent({ snap: null, windows: [window] }), { from: -9, span: 52 });
  assert.deepEqual(aroundEvent({ snap: { from: 337, to: 360 }, windows: [window] }), { from: -32, span: 78 });
  assert.equal(aroundEvent({ snap: null, windows: [] }), null);
});

test("a whole turn begins where its main event is in the middle, and any other range where it is said", () => {
  const turn = { from: null, span: 360 };
  assert.deepEqual(rangeOf(turn, { snap: { from: 351, to: 359 }, windows: [] }), { from: -180, span: 360 });
  assert.deepEqual(rangeOf(turn, { snap: null, windows: [{ enter: 80, leave: 120 }] }), { from: -90, span: 360 });
  assert.deepEqual(rangeOf(turn, { snap: null, windows: [] }), { from: 0, span: 360 });
  assert.deepEqual(rangeOf(turn, null), { from: 0, span: 360 });
  assert.deepEqual(rangeOf({ from: 12, span: 3 }, null), { from: 12, span: 3 });
});

test("the camera stays above and below the poles, and its keys lead back", () => {
  const camera = dragged(firstCamera(), 0, 10000);
  assert.equal(camera.elevation, 89);
  assert.deepEqual(cameraAfterKey(cameraAfterKey(firstCamera(), "ArrowLeft"), "ArrowRight"), firstCamera());
  assert.deepEqual(cameraAfterKey(camera, "0"), firstCamera());
  assert.equal(cameraAfterKey(camera, "a"), null);
  assert.ok(nearer(camera, 1).distance < camera.distance);
  near(Math.hypot(...cameraPosition(camera)), camera.distance);
});

test("what comes next here stands first; the rest by its share", () => {
  const one = (formation, move, share) => ({ formation, move, share });
  const node = { following: [one("a", "ccw", 0.1), one("b", "ccw", 0.5), one("c", "ccw", 0.4), one("d", "cw", 1)] };
  const groups = groupsOf(node, 2, { ccw: "a", cw: null });
  const ccw = groups.find(({ move }) => move === "ccw");
  assert.deepEqual(ccw.shown.map(({ formation, here }) => [formation, here]), [["a", true], ["b", false]]);
  assert.deepEqual([ccw.more, ccw.rest, ccw.unchanged], [1, 0.4, 0]);
  assert.deepEqual(notesOf(ccw), ["and 1 more, 40 % together"]);
  const [tilted] = groupsOf({ following: [one("a", "roll+", 0.3)] }, 2, {}).filter(({ move }) => move === "roll+");
  assert.deepEqual(notesOf(tilted), ["70 %: the same, or the grid ends"]);
});

test("a formation is followed to where it occurs nearest", () => {
  const grid = { tilt_step: 1 };
  const occurrences = [
    { roll: 1, pitch: 0, start: 350, end: 370 },
    { roll: 0, pitch: 0, start: 100, end: 110 },
    { roll: 0, pitch: 0, start: 20, end: 30 },
  ];
  const pose = { roll: 0, pitch: 0, phase: 50 };
  assert.deepEqual(followed({ occurrences }, pose, "ccw", grid), { roll: 0, pitch: 0, phase: 105 });
  assert.deepEqual(followed({ occurrences }, pose, "cw", grid), { roll: 0, pitch: 0, phase: 25 });
  assert.deepEqual(followed({ occurrences }, { ...pose, phase: 2 }, "roll+", grid), { roll: 1, pitch: 0, phase: 2 });
});

test("colours go from dark to light, with ink that is read on each", () => {
  assert.equal(scaleColour(0), "#00204c");
  assert.equal(scaleColour(1), "#fddc3b");
  assert.equal(textColourOn(scaleColour(0)), "#ffffff");
  assert.equal(textColourOn(scaleColour(1)), "#000000");
});

test("meshes are read from binary glTF, and nothing else is", () => {
  const json = JSON.stringify({
    accessors: [{ componentType: 5123, bufferView: 0, count: 3 }, { componentType: 5126, bufferView: 1, count: 3 }],
    bufferViews: [{ byteOffset: 0, byteLength: 6 }, { byteOffset: 8, byteLength: 36 }],
    meshes: [{ name: "cut", primitives: [{ attributes: { POSITION: 1 }, indices: 0 }] }],
  });
  const padded = json.padEnd(Math.ceil(json.length / 4) * 4);
  const buffer = new ArrayBuffer(12 + 8 + padded.length + 8 + 44);
  const view = new DataView(buffer);
  [0x46546c67, 2, buffer.byteLength, padded.length, 0x4e4f534a].forEach((word, k) => view.setUint32(4 * k, word, true));
  new Uint8Array(buffer, 20).set(new TextEncoder().encode(padded));
  const binary = 20 + padded.length + 8;
  [0, 1, 2].forEach((index, k) => view.setUint16(binary + 2 * k, index, true));
  [0, 0, 0, 1, 0, 0, 0, 2, 0].forEach((value, k) => view.setFloat32(binary + 8 + 4 * k, value, true));
  const [{ name, positions, indices }] = meshesOf(buffer);
  assert.equal(name, "cut");
  assert.deepEqual([...positions], [0, 0, 0, 1, 0, 0, 0, 2, 0]);
  assert.deepEqual([...indices], [0, 1, 2]);
  assert.throws(() => meshesOf(new ArrayBuffer(32)), /not a GLB file/);
});

test("angles of a grid are exact, however many decimals its steps have", () => {
  // Powers of two: their multiples are exact in floating point as well.
  const grid = { tilt_max: 9.5, tilt_step: 9.5 / 512, phase_step: 360 / 32768 };
  assert.deepEqual(tilts(grid), Array.from({ length: 1025 }, (_, k) => ((k - 512) * 9.5) / 512));
  assert.equal(nearestPhase(grid, 123.0145), 11197 * grid.phase_step);
  assert.equal(steppedPhase(grid, 11197 * grid.phase_step, 1), 11198 * grid.phase_step);
  assert.equal(steppedTilt(grid, 9.5 / 512, -3), (-2 * 9.5) / 512);
  assert.equal(nearestTilt(grid, 0.019), 9.5 / 512);
});
