// What open pages are told by a box with a thousand reports: little, and all of it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { until } from "../box.js";
import { FILES } from "../stage.js";
import { withReports } from "./reports.js";
import { box, logIn, row, says } from "./visits.js";

const REPORTS = 1000;
const patched = readFileSync(join(FILES, "patched.js"), "utf8").replace(/^export /gm, "");

/** Keeps, in the page, what came (`heard`: type and bytes of each event) and the view that it makes (`told`). */
const listen = (page) => page.addInitScript(`{
  ${patched}
  globalThis.heard = [];
  delete globalThis.SharedWorker; // which would hear it in the page's place
  const Heard = globalThis.EventSource;
  globalThis.EventSource = class extends Heard {
    constructor(...words) {
      super(...words);
      for (const type of ["message", "patch"]) {
        this.addEventListener(type, ({ data }) => {
          globalThis.heard.push([type, data.length]);
          globalThis.told = type === "patch" ? patched(globalThis.told, JSON.parse(data)) : JSON.parse(data);
        });
      }
    }
  };
}`);

/** A robot's pose, as its client posts it. */
const move = (made, name, x) =>
  made.ask("/state/update", { header: { stamp: Date.now() / 1000, frame_id: "darpa" }, poses: [{ name, position: { x, y: 2, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } }] });

/** Without what goes on while nothing happens. */
const lasting = ({ now, run, run_clock, sent_mbit, endpoints, verdict, activities, standings, robots, ...view }) => ({
  ...view, endpoints: endpoints.map(({ answer_ms, ...row }) => row),
  activities: activities.map(({ age, behind, ...row }) => row), standings: standings.map(({ age, ...row }) => row), robots: robots.map(({ age, ...row }) => row),
});

/** Once both have all that the box has. */
const upToDate = (pages, made) => Promise.all(pages.map((page) => until(async () => {
  const told = lasting(await page.evaluate(() => globalThis.told)), now = lasting(await made.run());
  const text = (view) => JSON.stringify(view, (_, value) => (typeof value === "number" ? Math.round(value * 1000) / 1000 : value));
  return text(told) === text(now);
}, "a page to have what the box has")));

test("tells two pages, of a thousand reports and a robot, what changes in few bytes, and all of it", async (t) => {
  const made = await withReports(t, REPORTS);
  await move(made, "ugv1", 1);
  await until(async () => (await made.run()).robots.length === 1, "the robot's pose to arrive");
  const pages = [await logIn(t, made, listen), await logIn(t, made, listen)], [, other] = pages;
  for (const page of pages) await row(page, REPORTS).waitFor();
  await upToDate(pages, made);
  const [[type, whole]] = await other.evaluate(() => globalThis.heard);
  assert.equal(type, "message");
  assert.ok(whole > 40_000, `${whole} bytes`);

  const from = await other.evaluate(() => globalThis.heard.length);
  await move(made, "ugv1", 7.123456);
  await other.waitForFunction(() => globalThis.told.robots[0].position.x === 7.123);
  const number = await made.compose("Drill", -50);
  await made.becomes(number, "answered");
  await says(other, number, "Drill");
  await upToDate(pages, made);
  const events = (await other.evaluate(() => globalThis.heard)).slice(from);
  assert.ok(events.every(([each]) => each === "patch"), "nothing is told whole again");
  assert.ok(Math.max(...events.map(([, bytes]) => bytes)) < 2500, `${events.map(([, bytes]) => bytes)}`);

  // What came by patches alone is what a page is told that comes only now.
  assert.equal((await made.ask(`/adit/reports/${number}/resubmit`, {})).said.report, number + 1);
  await made.becomes(number + 1, "answered");
  for (const page of pages) await says(page, number + 1, "Drill");
  const third = await logIn(t, made, listen);
  await upToDate([...pages, third], made);
  for (const page of [...pages, third]) assert.deepEqual(page.complaints, []);
});

test("begins whole after the line was lost, whatever came meanwhile", async (t) => {
  const made = await box(t);
  await made.becomes(await made.compose("Rope", 1), "answered");
  const page = await logIn(t, made, listen);
  await made.killAditd();
  await page.waitForSelector("body[data-link=lost]");
  await made.startAditd();
  await made.becomes(await made.compose("Drill", 50), "answered");
  await page.waitForSelector("body[data-link=live]");
  await says(page, 2, "Drill");
  await upToDate([page], made);
  const types = (await page.evaluate(() => globalThis.heard)).map(([type]) => type);
  assert.ok(types.filter((type) => type === "message").length >= 2, types.join());
});
