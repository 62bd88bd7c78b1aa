// The plots of the link: current figures, and gaps in the box's measurements.
import assert from "node:assert/strict";
import { test } from "node:test";
import { watch } from "./watch.js";

const gaps = (page) => page.$$eval("#plots .lost", (paths) => paths.map((path) => Boolean(path.getAttribute("d"))));

test("shades lost times only", async (t) => {
  const { page, stage } = await watch(t, "calm");
  await page.locator("#plots li").nth(4).waitFor();
  assert.deepEqual(await gaps(page), Array(5).fill(false));
  assert.match(await page.innerText("#plots"), /Sent\s+[\d.]+ of 100 Mbit\/s\s+Queued\s+1\.5 MB\s+Scoring answers in\s+3\.4 ms\s+Mapping answers in\s+41 ms\s+Asked to slow down\s+0 times/);
  stage.freeze();
  await page.waitForFunction(() => [...document.querySelectorAll("#plots .lost")].every((path) => path.getAttribute("d")));
  assert.match(await page.innerText("#plots li"), /Sent\s+–/);
  stage.thaw();
  await page.waitForFunction(() => !/–/.test(document.querySelector("#plots li strong").textContent));
  assert.deepEqual(await gaps(page), Array(5).fill(true));
});

test("shows three plots on a phone without overlaps", async (t) => {
  const { page } = await watch(t, "calm", { viewport: { width: 390, height: 844 } });
  await page.locator("#plots li").nth(2).waitFor();
  const rows = await page.$$eval("#plots li", (items) => items.filter((item) => item.checkVisibility()).map((item) => {
    const edge = item.getBoundingClientRect().right;
    return [...item.querySelectorAll(".label, strong, .unit")].every((part) => part.getBoundingClientRect().right <= edge + 0.5 && part.scrollWidth <= part.clientWidth + (part.clientWidth ? 1 : 1e4));
  }));
  assert.deepEqual(rows, [true, true, true]);
});

test("says that a report without an answer may have been accepted", async (t) => {
  const { stage, page } = await watch(t, "calm");
  await page.locator("#reports .compose:enabled").click();
  await page.locator("#compose .types").getByRole("button", { name: "Drill", exact: true }).click();
  for (const [name, value] of [["x", "7"], ["y", "2"], ["z", "0.5"]]) await page.fill(`#compose input[name=${name}]`, value);
  await page.getByRole("button", { name: "Check" }).click();
  await page.locator("#compose .send:enabled").waitFor();
  stage.freeze();
  await page.locator("#compose .send").click();
  await page.getByText("No answer came within 30 s. The report may have been accepted: look at the list.").waitFor();
  stage.thaw();
});
