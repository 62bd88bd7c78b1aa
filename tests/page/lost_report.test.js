// A report whose place was lost by damage of the ledger: the list says so, and the map does not draw it at the origin.
import assert from "node:assert/strict";
import { test } from "node:test";
import { retell } from "./retold.js";
import { text, watch } from "./watch.js";

/** The page of a box whose report 8 (in doubt) has lost its position, or has it at the origin. */
async function withReport(t, position) {
  const prepare = (page) => retell(page, (place) => {
    globalThis.written = new Set();
    const { fillText } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.fillText = function (words, ...more) {
      globalThis.written.add(String(words));
      return fillText.call(this, words, ...more);
    };
    return (view) => {
      for (const report of view.reports) if (report.number === 8) Object.assign(report, { type: "", position: place, sender: "lost" });
      return view;
    };
  }, position);
  const { page } = await watch(t, "trouble", { prepare });
  await page.locator('#reports [data-key="8"]').waitFor();
  return page;
}

const names = (page) => page.evaluate(() => [...globalThis.written].map((name) => name.trim()));

test("says that the place is lost, and draws no sign", async (t) => {
  const page = await withReport(t, null);
  assert.match(await text(page, '#reports [data-key="8"] .where'), /^#8 · lost from the ledger · /);
  assert.deepEqual(await page.locator('#reports [data-key="8"] button:visible').allTextContents(), ["Details of report 8", "Settle"]);
  await page.waitForFunction(() => [...globalThis.written].some((name) => name.startsWith("#10")));
  assert.deepEqual((await names(page)).filter((name) => name.startsWith("#8")), []);
});

test("names the robot that found it", async (t) => {
  const prepare = (page) => retell(page, (robot) => (view) => {
    for (const report of view.reports) if (report.number === 8) report.robot = robot;
    return view;
  }, "spot1");
  const { page } = await watch(t, "trouble", { prepare });
  await page.locator('#reports [data-key="8"]').waitFor();
  assert.match(await text(page, '#reports [data-key="8"] .where'), /^#8 · .* m · spot1 · /);
});

test("draws a report that is really at the origin", async (t) => {
  const page = await withReport(t, { x: 0, y: 0, z: 0 });
  await page.waitForFunction(() => [...globalThis.written].some((name) => name.startsWith("#8")));
});
