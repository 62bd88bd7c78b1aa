// How the page applies a patch, case by case. tests/codec/patch_test.cpp checks the box's patches.
import assert from "node:assert/strict";
import { test } from "node:test";
import { patched } from "../../firmware/doors/site/files/patched.js";

const rows = (...numbers) => numbers.map((number) => ({ number, note: `n${number}` }));
const view = { now: 1, run: null, at: { x: 1, y: 2 }, marks: [7], rows: rows(1, 2, 3) };

const CASES = [
  ["a member", { now: 2 }, { ...view, now: 2 }],
  ["nothing", {}, view],
  ["null is a value", { at: null, run: { score: 1 } }, { ...view, at: null, run: { score: 1 } }],
  ["a member of a member", { at: { y: 3 } }, { ...view, at: { x: 1, y: 3 } }],
  ["a list that is told whole", { marks: [8, 9] }, { ...view, marks: [8, 9] }],
  ["one row's member", { rows: { rows: { 1: { note: "new" } } } }, { ...view, rows: [view.rows[0], { number: 2, note: "new" }, view.rows[2]] }],
  ["a new first row", { rows: { length: 4, kept: [[1, 0, 3]], rows: { 0: { number: 4, note: null } } } }, { ...view, rows: [{ number: 4, note: null }, ...view.rows] }],
  ["a new last row", { rows: { length: 4, rows: { 3: { number: 4 } } } }, { ...view, rows: [...view.rows, { number: 4 }] }],
  ["rows that went", { rows: { length: 1, kept: [[0, 2, 1]] } }, { ...view, rows: rows(3) }],
  ["rows in another order, one changed", { rows: { kept: [[0, 2, 1], [1, 0, 2]], rows: { 1: { note: "x" } } } }, { ...view, rows: [view.rows[2], { number: 1, note: "x" }, view.rows[1]] }],
  ["no rows", { rows: { length: 0 } }, { ...view, rows: [] }],
];

for (const [what, patch, next] of CASES) {
  test(`applies a patch with ${what}`, () => {
    const before = structuredClone(view);
    assert.deepEqual(patched(view, patch), next);
    assert.deepEqual(view, before, "patched() must not change the view before");
  });
}

test("keeps the objects of unchanged rows", () => {
  const next = patched(view, { rows: { rows: { 1: { note: "new" } } } });
  assert.equal(next.rows[0], view.rows[0]);
  assert.equal(next.at, view.at);
});
