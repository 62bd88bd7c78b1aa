// What the page makes of the box's word on each kind of data.
import assert from "node:assert/strict";
import { test } from "node:test";
import { stateOf } from "../../firmware/site/files/robot_state.js";

const row = { kind: "grid", robot: "r1", age: 3, level: "good", arrival: "good", accepted: 1, forwarded: 1 };

test("it is as old as the box said, and the time since; what never came stays so", () => {
  for (const lost of [false, true]) {
    assert.equal(stateOf(row, 60, lost).age, 63);
    assert.equal(stateOf({ ...row, age: null }, 60, lost).age, null);
  }
});
