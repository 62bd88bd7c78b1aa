// The list of reports under a mouse or finger while another operator acts; and reports beyond those in an event.
import assert from "node:assert/strict";
import { test } from "node:test";
import { COUNT, withMany } from "./many_reports.js";
import { until } from "./box.js";
import { watch } from "./watch.js";

const row = (page, number) => page.locator(`#reports li[data-key="${number}"]`);
const boxes = (page) => page.$$eval("#reports .rows > li, #reports .actions button", (nodes) => nodes.map((node) => [node.closest("li").dataset.key, node.textContent.slice(0, 9), node.getBoundingClientRect().top]));

/** Acts as another operator. */
const elsewhere = (stage, path, body = {}) =>
  fetch(`${stage.url}adit/reports${path}`, { method: "POST", headers: { Authorization: "Bearer team-1", "Content-Type": "application/json" }, body: JSON.stringify(body) });

test("no row moves under a mouse while another operator acts: new rows wait above, and appear once the mouse has left", async (t) => {
  const { stage, page } = await watch(t, "reports");
  await row(page, 25).locator(".title").hover();
  assert.match(await row(page, 25).locator(".more").innerText(), /no answer came/);
  const before = (await boxes(page)).map(([key, , top]) => [key, top]);
  assert.equal((await elsewhere(stage, "/25/settle")).status, 200);
  assert.equal((await elsewhere(stage, "", { type: "Rope", x: 1, y: 2, z: 3 })).status, 202);
  await page.getByRole("button", { name: "1 new" }).waitFor();
  await row(page, 25).getByText("settled").waitFor();
  assert.deepEqual((await boxes(page)).map(([key, , top]) => [key, top]), before);
  assert.doesNotMatch(await row(page, 25).locator(".more").innerText(), /no answer came/);
  for (const button of await row(page, 25).locator(".actions button").all()) assert.ok(await button.isDisabled());
  await page.mouse.move(100, 300);
  await row(page, 29).waitFor();
  assert.equal(await page.locator("#reports .newer").isVisible(), false);
  assert.equal(await row(page, 25).locator(".actions button").count(), 0);
  assert.equal(await page.locator("#reports li").first().getAttribute("data-key"), "24", "reports that need the operator come first");
});

test("shows new rows at once if asked to", async (t) => {
  const { stage, page } = await watch(t, "reports", { hasTouch: true });
  await row(page, 25).locator(".title").tap();
  await elsewhere(stage, "", { type: "Rope", x: 1, y: 2, z: 3 });
  const end = Date.now() + 30_000;
  while (Date.now() < end && !(await row(page, 29).count())) {  // the row may have appeared by itself if this test is slow
    await page.getByRole("button", { name: "1 new" }).tap({ timeout: 1000 }).catch(() => {});
  }
  await row(page, 29).waitFor();
});

test("reaches every report, also those past the newest 200, and checks all for duplicates", async (t) => {
  const { page } = await watch(t, "reports", { prepare: withMany });
  await page.locator("#reports .count", { hasText: `${COUNT} sent` }).waitFor();
  const list = page.locator("#reports .scroll");
  for (const end = Date.now() + 60_000; Date.now() < end && !(await row(page, 1).count()); ) {
    await list.evaluate((node) => (node.scrollTop = node.scrollHeight));
    await page.waitForTimeout(100);
  }
  assert.equal(await page.locator("#reports li").count(), COUNT);
  await page.keyboard.press("n");
  await page.locator("#compose .types").getByRole("button", { name: "Rope" }).click();
  for (const [axis, value] of [["x", "41"], ["y", "0"], ["z", "0"]]) await page.fill(`#compose input[name=${axis}]`, value);
  await page.getByRole("button", { name: "Check" }).click();
  assert.match(await page.textContent("#compose .notes"), /#4 Rope is 1\.0 m away/);
});

test("filters reports by state, type and need of a decision, and shows all for a report that an alarm names", async (t) => {
  const { page } = await watch(t, "reports");
  const shown = () => page.$$eval("#reports .rows > li:not([data-level=ask])", (rows) => rows.map((row) => row.querySelector(".what").textContent));
  const filter = page.locator("#reports .filter select");
  await row(page, 28).waitFor();
  const whole = await shown();
  assert.ok(new Set(whole).size > 1);
  await filter.selectOption({ label: "Drill" });
  await until(async () => (await shown()).every((type) => type === "Drill"), "Drills alone");
  assert.equal((await shown()).length, whole.filter((type) => type === "Drill").length);
  await row(page, 25).and(page.locator("[data-level=ask]")).waitFor();
  await page.evaluate(() => (location.hash = "report=28"));
  await row(page, 28).locator("[aria-expanded=true]").waitFor();
  assert.equal((await shown()).length, whole.length);
});
