import assert from "node:assert/strict";
import { test } from "node:test";

import { CLASS_COLOURS, REGION_COLOURS, STAGE_COLOURS, scaleColour } from "../../service/explorer/page/js/colours.js";

/** What is seen of linear RGB (Machado, Oliveira and Fernandes 2009, severity 1). */
const EYES = {
  normal: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  protanopia: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
  deuteranopia: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
  tritanopia: [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
};
/** Euclidean distances in CIELAB: below 10 colours are taken for one another, by 20 they are told apart at a glance. */
const AT_A_GLANCE = 20;
const TOLD_APART = 9;

function linear(colour) {
  return [1, 3, 5].map((k) => {
    const part = parseInt(colour.slice(k, k + 2), 16) / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
}

function applied(matrix, vector) {
  return matrix.map((row) => row.reduce((sum, value, k) => sum + value * vector[k], 0));
}

function lab(rgb) {
  const toXyz = [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.072175], [0.0193339, 0.119192, 0.9503041]];
  const white = [0.95047, 1, 1.08883];
  const [x, y, z] = applied(toXyz, rgb.map((part) => Math.min(Math.max(part, 0), 1)))
    .map((value, k) => value / white[k])
    .map((value) => (value > 216 / 24389 ? Math.cbrt(value) : (24389 / 27 * value + 16) / 116));
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

function difference(eye, one, other) {
  const [a, b] = [one, other].map((colour) => lab(applied(EYES[eye], linear(colour))));
  return Math.hypot(...a.map((value, k) => value - b[k]));
}

function nearest(eye, colours) {
  const pairs = colours.flatMap((one, k) => colours.slice(k + 1).map((other) => [one, other]));
  return Math.min(...pairs.map(([one, other]) => difference(eye, one, other)));
}

for (const eye of Object.keys(EYES)) {
  test(`classes and stages are easy to distinguish: ${eye}`, () => {
    assert.ok(nearest(eye, Object.values(CLASS_COLOURS)) >= AT_A_GLANCE, `classes: ${nearest(eye, Object.values(CLASS_COLOURS))}`);
    assert.ok(nearest(eye, STAGE_COLOURS) >= AT_A_GLANCE, `stages: ${nearest(eye, STAGE_COLOURS)}`);
  });

  test(`neighbouring regions of a thread are easy to distinguish: ${eye}`, () => {
    const order = Object.keys(REGION_COLOURS).filter((region) => region !== "base" && region !== "surface");
    order.forEach((region, k) => {
      const beside = order[(k + 1) % order.length];
      const far = difference(eye, REGION_COLOURS[region], REGION_COLOURS[beside]);
      assert.ok(far >= TOLD_APART, `${region} and ${beside}: ${far}`);
    });
    const [sides, other] = [["flank_pos", "flank_neg"], "surface"];
    assert.ok(difference(eye, ...sides.map((side) => REGION_COLOURS[side])) >= AT_A_GLANCE, "the two flanks");
    assert.ok(sides.every((side) => difference(eye, REGION_COLOURS[side], REGION_COLOURS[other]) >= TOLD_APART), "flanks and surface");
  });

  test(`the scale grows lighter all along: ${eye}`, () => {
    const lightness = Array.from({ length: 12 }, (_, k) => lab(applied(EYES[eye], linear(scaleColour(k / 11))))[0]);
    assert.ok(lightness.every((value, k) => k === 0 || value > lightness[k - 1]), `${lightness.map((value) => value.toFixed(1))}`);
  });
}
