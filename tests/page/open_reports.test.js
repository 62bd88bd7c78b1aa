// What the page knows of the box's reports if more are open than an event has.
import assert from "node:assert/strict";
import { test } from "node:test";
import { allReports, learnChange } from "../../firmware/doors/site/files/all_reports.js";

const OPEN = 230, IN_EVENT = 200;

test("shows all, and what the operator decided of one that events do not have", async () => {
  const box = new Map(Array.from({ length: OPEN }, (_, i) => [OPEN - i, { number: OPEN - i, state: "held", received: 1, changed: 1 }]));
  globalThis.fetch = async (path) => Response.json(path === "/adit/reports" ? [...box.values()] : box.get(Number(path.split("/").at(-1))));
  const event = { reports: [...box.values()].slice(0, IN_EVENT) };
  for (const end = Date.now() + 10_000; Date.now() < end && allReports(event, false).length < OPEN; ) await new Promise((resolve) => setTimeout(resolve, 10));
  assert.deepEqual(allReports(event, false).map(({ number }) => number), [...box.keys()]);

  box.set(1, { ...box.get(1), state: "withdrawn", changed: 2 });
  await learnChange(1);
  assert.equal(allReports(event, false).at(-1).state, "withdrawn");
});
