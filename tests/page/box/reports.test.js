import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "../box.js";
import { patient } from "../patience.js";
import { box, canBeDeaf, action, logIn, look, row, says, openMore } from "./visits.js";

/** The second report is queued for that many seconds. */
const slow = (seconds) => ({ settings: { command_post: { rates: { reports_hz: 1 / seconds } } } });
const recorded = async (made, x) => (await made.record()).reports.filter((report) => report.x === x).length;

/** A report that is queued because another was just sent. */
async function waiting(made, x = 50, type = "Drill") {
  await made.becomes(await made.compose("Rope", -900 - x), "answered");
  const number = await made.compose(type, x);
  await made.becomes(number, "queued");
  return number;
}

test("holds a queued report and sends it after the operator's second decision", async (t) => {
  const made = await box(t, slow(300));
  const number = await waiting(made);
  const page = await look(t, made);
  await row(page, number).locator(".open").click();
  await action(page, "Hold", number).click();
  await says(page, number, "held");
  await says(page, number, "Held until you send it.");
  assert.equal(await made.state(number), "held");
  await page.waitForFunction((words) => document.getElementById("attention").innerText.includes(words), `eport ${number} is held`);
  assert.equal((await made.ask(`/adit/reports/${number}/hold`, {})).status, 409);
  await action(page, "Send", number).click();
  await says(page, number, "The report will be sent.");
  assert.equal(await made.state(number), "queued");
  await action(page, "Withdraw", number).click();
  await says(page, number, "withdrawn");
  assert.equal(await recorded(made, 50), 0);
  assert.deepEqual(page.complaints, []);
});

test("sends once if two operators press send at once", async (t) => {
  const made = await box(t, slow(patient(10)));  // enough time to hold it
  const number = await waiting(made);
  await made.ask(`/adit/reports/${number}/hold`, {});
  const pages = [await logIn(t, made, canBeDeaf), await logIn(t, made, canBeDeaf)];
  for (const page of pages) await action(page, "Send", number).waitFor();
  for (const page of pages) await page.evaluate(() => (globalThis.deaf = true));  // so that the slower operator still sees the button
  await Promise.all(pages.map((page) => action(page, "Send", number).click()));
  for (const page of pages) {
    await says(page, number, "The report will be sent.");
    await page.evaluate(() => (globalThis.deaf = false));
  }
  await made.becomes(number, "answered");
  await made.becomes(await made.compose("Rope", 900), "answered");  // a second sending would have come first
  assert.equal(await recorded(made, 50), 1);
});

test("shows near duplicates side by side, on the map and in words", async (t) => {
  const made = await box(t, { settings: { reports: { review: "duplicates" } } });
  await made.becomes(await made.compose("Gas", 40, 10, 1), "answered");
  const second = await made.compose("Gas", 42, 10, 1);
  await made.becomes(second, "held");
  const page = await look(t, made);
  const show = page.getByRole("button", { name: `Show both on the map: reports ${second} and 1` });
  await show.click();
  const pair = page.getByRole("group", { name: "Two reports side by side" });
  assert.match(await pair.innerText(), /2\.0 m apart: one artifact, or two\?/);
  assert.match((await pair.innerText()).replace(/\s+/g, " "), /#1 Gas .*(scored|points).* 40\.0, 10\.0, 1\.0 m .* #2 Gas held 42\.0, 10\.0, 1\.0 m/);
  await action(page, "Withdraw", second).click();
  await page.waitForFunction(() => document.querySelector("#map .pair").innerText.includes("withdrawn"));
  await pair.getByRole("button", { name: "Close" }).press("Escape");
  assert.ok(await pair.isHidden());
});

/** Posts a Drill with the page's form. */
async function composed(page, x) {
  await page.getByRole("button", { name: "New report" }).click();
  await page.locator("#compose .types").getByRole("button", { name: "Drill" }).click();
  for (const [axis, value] of Object.entries({ x: String(x), y: "0", z: "0" })) await page.fill(`#compose input[name=${axis}]`, value);
  await page.getByRole("button", { name: "Check" }).click();
  await page.locator("#compose .send").click();
}

test("withdraws a report from the page before it is sent, or sends it now", async (t) => {
  const made = await box(t, { settings: { reports: { undo_s: 60 } } });
  const page = await look(t, made);
  await composed(page, 50);
  await says(page, 1, "held, to be sent");
  await says(page, 1, "sent in ");
  assert.ok(await page.locator("#attention").getByText("held").isHidden(), "no alarm");
  await action(page, "Undo", 1).click();
  await says(page, 1, "withdrawn");
  await composed(page, 60);
  await action(page, "Send now", 2).click();
  await made.becomes(2, "answered");
  await says(page, 2, "points");
  assert.doesNotMatch(await row(page, 2).innerText(), /will be sent|Accepted/);
  assert.equal(await recorded(made, 50), 0);
  assert.equal(await recorded(made, 60), 1);
  assert.equal((await made.ask("/adit/reports/2/withdraw", {})).status, 409);
  assert.deepEqual(page.complaints, []);
});

test("corrects a held report and sends the correction as a new one", async (t) => {
  const made = await box(t, { settings: { reports: { review: "all" } } });
  await made.becomes(await made.compose("Drill", 50, 1, 2), "held");
  const page = await look(t, made);
  await action(page, "Correct", 1).click();
  assert.equal(await page.locator("#compose .name").textContent(), "Correct report 1");
  assert.equal(await page.inputValue("#compose input[name=x]"), "50");
  await page.fill("#compose input[name=x]", "55");
  await page.getByRole("button", { name: "Check" }).click();
  await page.locator("#compose .send").click();
  await made.becomes(2, "answered");
  await says(page, 1, "corrected as #2");
  await says(page, 2, "Corrects report 1.");
  const { said: { history } } = await made.ask("/adit/reports/2");
  assert.match(history[0].note, /^corrects report 1, "Drill" at 50, 1, 2$/);
  assert.deepEqual((await made.record()).reports.map(({ x, y, z }) => [x, y, z]), [[55, 1, 2]]);
  assert.deepEqual(page.complaints, []);
});

test("begins a new run if the operator declares it, and says before what happens to unsent reports", async (t) => {
  const made = await box(t, slow(300));
  const number = await waiting(made);
  const posted = Date.now();
  const page = await look(t, made);
  await openMore(page);
  const before = (await made.run()).run_number;
  const question = page.getByRole("alertdialog");
  const press = () => page.getByRole("button", { name: "New run" }).first().click();
  await press();
  assert.match(await question.innerText(), new RegExp(`Run ${before} ends, and a new one begins\\. Queued reports are held until you send them: #${number}\\.`));
  await question.getByRole("button", { name: "Cancel" }).click();
  assert.equal((await made.run()).run_number, before);
  assert.equal(await made.state(number), "queued");
  await until(() => Date.now() > posted + 10_500, "the report to be too old for another run");
  await press();
  await question.getByRole("button", { name: "New run" }).click();
  await page.waitForFunction((words) => document.querySelector("#more .outcome").textContent === words, `Run ${before + 1} began.`);
  assert.equal((await made.run()).run_number, before + 1);
  await made.becomes(number, "held");
  await says(page, number, "a new run began");
  assert.equal(await recorded(made, 50), 0);
});
