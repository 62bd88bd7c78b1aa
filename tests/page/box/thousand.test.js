// A thousand reports on one page, against the real programs: all of them are counted, can be reached, and are looked at for
// duplicates; and the map goes on moving under the hand.
import assert from "node:assert/strict";
import { test } from "node:test";
import { withReports } from "./reports.js";
import { leave, logIn, row } from "./visits.js";

const REPORTS = 1000;
const STEPS = 40, MOST_CPU = 100; // ms of the main thread for each frame: half a second's worth would be five times that

const keys = (page) => page.$$eval("#reports .rows > li", (rows) => rows.map(({ dataset }) => Number(dataset.key)));

/** By the wheel, as far down as there is anything. */
async function scrollToTheEnd(page) {
  await page.locator("#reports .rows").hover();
  for (let before = -1, known = 0; known > before || known < REPORTS; ) {
    before = known;
    await page.mouse.wheel(0, 1e6);
    await page.waitForFunction((before) => document.querySelectorAll("#reports .rows > li").length > before, before);
    known = (await keys(page)).length;
    if (known === REPORTS) break;
  }
}

test("a thousand reports are counted, reached and searched for duplicates, and the map moves", async (t) => {
  const made = await withReports(t, REPORTS);
  const page = await logIn(t, made);
  await page.waitForFunction((words) => document.querySelector("#reports .count").textContent === words, `${REPORTS} sent`);

  await t.test("by scrolling: each once, newest first", async () => {
    await scrollToTheEnd(page);
    assert.deepEqual(await keys(page), Array.from({ length: REPORTS }, (_, i) => REPORTS - i));
    await row(page, 1).scrollIntoViewIfNeeded();
    await row(page, 1).locator("button.open").click();
    await row(page, 1).locator(".history li").first().waitFor();
  });

  await t.test("by its link, on a page that was just opened", async () => {
    const other = await logIn(t, made);
    await other.waitForFunction((words) => document.querySelector("#reports .count").textContent === words, `${REPORTS} sent`);
    await other.evaluate(() => (location.hash = "report=2"));
    await row(other, 2).waitFor();
    await other.waitForFunction(() => document.activeElement.closest("li")?.dataset.key === "2");
    await leave(other);
  });

  await t.test("as a near duplicate of a new one", async () => {
    const [oldest] = (await made.ask("/adit/reports")).said;
    await page.getByRole("button", { name: "New report" }).click();
    await page.locator("#compose .types").getByRole("button", { name: oldest.type, exact: true }).click();
    for (const axis of ["x", "y", "z"]) await page.fill(`#compose input[name=${axis}]`, String(oldest.position[axis] + (axis === "x" ? 1 : 0)));
    await page.getByRole("button", { name: "Check" }).click();
    await page.waitForFunction((number) => document.querySelector("#compose .notes").innerText.includes(`#${number} `), oldest.number);
    await page.getByRole("button", { name: "Cancel" }).click();
  });

  await t.test("while the map is dragged", async () => {
    const devtools = await page.context().newCDPSession(page);
    await devtools.send("Performance.enable", { timeDomain: "threadTicks" }); // CPU time, whatever else the machine does
    const busy = async () => (await devtools.send("Performance.getMetrics")).metrics.find(({ name }) => name === "TaskDuration").value;
    const { x, y, width, height } = await page.locator("#map .frame canvas").boundingBox();
    const frame = () => page.evaluate(() => new Promise(requestAnimationFrame));
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    const before = await busy();
    for (let i = 0; i < STEPS; ++i) {
      await page.mouse.move(x + width / 2 + (width / 4) * Math.sin(i / 6), y + height / 2 + (height / 4) * Math.cos(i / 9));
      await frame();
    }
    const each = (1000 * (await busy() - before)) / STEPS;
    await page.mouse.up();
    t.diagnostic(`${each.toFixed(1)} ms of the main thread for each frame`);
    assert.ok(each < MOST_CPU, `${each} ms`);
  });
  assert.deepEqual(page.complaints, []);
});
