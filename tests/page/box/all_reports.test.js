// More reports than an event has: the page's list and count have all of them, and load the others once.
import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "../box.js";
import { box, logIn, row, says } from "./visits.js";

const REPORTS = 260, AT_ONCE = 20, HELD = 2;

test("loads reports beyond the newest 200 once, and shows them as they are", async (t) => {
  const made = await box(t, { post: ["--reports", "1000", "--rate", "0"], settings: { reports: { review: "duplicates" }, command_post: { rates: { reports_hz: 1000, status_hz: 20 } } } });
  await made.becomes(await made.compose("Rope", -50), "answered");
  assert.equal(await made.compose("Rope", -51), HELD);
  await made.becomes(HELD, "held");
  for (let i = 0; i < REPORTS; i += AT_ONCE) await Promise.all(Array.from({ length: AT_ONCE }, (_, j) => made.compose("Rope", 10 * (i + j), 5)));
  await until(async () => (await made.run()).run.remaining_reports === 1000 - REPORTS - 1, "the reports to be recorded", 300_000);

  const asked = [];
  const page = await logIn(t, made, (page) => page.on("request", (request) => /\/adit\/reports(\/\d+)?$/.test(request.url()) && request.method() === "GET" && asked.push(new URL(request.url()).pathname)));
  const counted = (words) => page.waitForFunction((words) => document.querySelector("#reports .count").textContent === words, words);
  await counted(`${REPORTS + 1} sent, 1 held`);
  await page.evaluate(() => (location.hash = "report=1"));
  await row(page, 1).waitFor();
  assert.equal((await made.ask(`/adit/reports/${HELD}/withdraw`, {})).status, 200);
  await counted(`${REPORTS + 1} sent`);
  await page.evaluate((number) => (location.hash = `report=${number}`), HELD);
  await says(page, HELD, "withdrawn");
  assert.deepEqual(asked.filter((path) => path === "/adit/reports"), ["/adit/reports"]);
  assert.ok(asked.includes(`/adit/reports/${HELD}`));
});
