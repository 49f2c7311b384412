import assert from "node:assert/strict";
import { test } from "node:test";

import { UnreachableError, ProblemError } from "../../service/explorer/page/js/api.js";
import { progressOf, errorStateOf } from "../../service/explorer/page/js/messages.js";

const problem = (status, name) => new ProblemError(status, { title: "t", detail: "d", type: `urn:threadstate:problem:${name}` });
const BUILDING = [{ designation: "1/4-20 UNC", done: 3, orientations: 81, waiting: false }];

test("each error state has its page", () => {
  const kinds = [
    [new UnreachableError("gone"), [], false, "lost"],
    [problem(401, "key-refused"), [], false, "key"],
    [problem(401, "key-refused"), [], true, "key"],
    [problem(503, "not-migrated"), [], false, "empty"],
    [problem(404, "not-found"), [], false, "empty"],
    [problem(404, "not-found"), BUILDING, false, "building"],
    [problem(404, "not-found"), BUILDING, true, "unknown"],
    [problem(500, "internal"), [], false, "fault"],
    [new TypeError("oops"), [], false, "fault"],
  ];
  for (const [error, building, named, kind] of kinds) assert.equal(errorStateOf(error, building, named).kind, kind);
});

test("a job that no worker has begun waits; one that is running is shown by its library", () => {
  const begun = { designation: "1/4-20 UNC", method: "exact", orientations: 81, done: 3, created_at: "" };
  const jobs = [
    { designation: "M6", state: "queued", chunks: 9, committed: 0 },
    { designation: "1/4-20 UNC", state: "running", chunks: 81, committed: 3 },
    { designation: "M8", state: "failed", chunks: 9, committed: 0 },
  ];
  assert.deepEqual(progressOf([begun], jobs), [...BUILDING, { designation: "M6", done: 0, orientations: 9, waiting: true }]);
});
