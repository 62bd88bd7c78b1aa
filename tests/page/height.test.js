// The height that the page chooses for a place on the map, case by case, and its explanation.
import assert from "node:assert/strict";
import { test } from "node:test";
import { heightNote, heightsAt } from "../../firmware/doors/site/files/height.js";

const track = (name, ...poses) => ({ name, poses: poses.map(([at, x, y, z]) => [at, x, y, z, 0]) });
const HERE = { x: 10, y: 20 };

const CASES = [
  ["no track", [], []],
  ["a robot without poses", [track("r1")], []],
  ["a track within 5 m", [track("r1", [7, 13, 24, 1.5])], [{ z: 1.5, robot: "r1", apart: 5, at: 7 }]],
  ["a track farther than 5 m", [track("r1", [7, 13, 24.1, 1.5])], []],
  ["a place that was passed, not the last one", [track("r1", [7, 10, 20, 1], [8, 90, 20, 9])], [{ z: 1, robot: "r1", apart: 0, at: 7 }]],
  ["the nearest of two robots", [track("r1", [7, 10, 24, 1]), track("r2", [3, 10, 22, 1.5])], [{ z: 1.5, robot: "r2", apart: 2, at: 3 }]],
  ["the newest of poses at one place", [track("r1", [7, 10, 20, 1], [9, 10, 20, 1.2], [8, 10, 20, 1.1])], [{ z: 1.2, robot: "r1", apart: 0, at: 9 }]],
  ["heights that differ by 2 m", [track("r1", [7, 10, 20, 1]), track("r2", [7, 10, 21, 3])], [{ z: 1, robot: "r1", apart: 0, at: 7 }]],
  ["two levels that cross", [track("r1", [7, 10, 24, 1], [8, 10, 25, 1]), track("r2", [3, 10, 21, -4])],
    [{ z: -4, robot: "r2", apart: 1, at: 3 }, { z: 1, robot: "r1", apart: 4, at: 7 }]],
  ["a shaft that a robot flew up", [track("r1", ...[0, 1, 2, 3, 4, 5].map((z) => [z, 10, 20, z]))],
    [{ z: 5, robot: "r1", apart: 0, at: 5 }, { z: 2, robot: "r1", apart: 0, at: 2 }]],
  ["a position beyond all numbers", [track("r1", [7, 1e308, -1e308, 0])], []],
];

for (const [what, tracks, heights] of CASES) test(`finds the heights of ${what}`, () => assert.deepEqual(heightsAt(HERE, tracks), heights));

test("says how a height was found, and which one to check", () => {
  const height = { z: 1.2, robot: "r6", apart: 2, at: 60 };
  assert.deepEqual(heightNote(height, 100), { key: "height", level: "good", text: "z 1.2 m from r6’s track, 2.0 m away, 40 s ago." });
  assert.deepEqual(heightNote({ ...height, apart: 2.1 }, 100), { key: "height", level: "wait", text: "z 1.2 m from r6’s track, 2.1 m away, 40 s ago: check it." });
  assert.deepEqual(heightNote(null, 100), { key: "height", level: "quiet", text: "z typed." });
});
