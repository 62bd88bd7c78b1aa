// A report composed with a finger, against the real programs: twenty times the place is tapped on the map, and each report
// that the Command Post records is of the type that was chosen.
import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "../box.js";
import { toTab } from "../parts.js";
import { box, look } from "./visits.js";

const TYPES = ["Drill", "Rope", "Gas", "Vent", "Cube"];
const TAPS = 20;
const canvas = "#map .frame canvas";

const still = (page) => page.waitForSelector("[data-moving]", { state: "detached" });

/** Where on the map the tap goes: all over it, but not on its tools. */
async function placeOn(page, i) {
  for (let n = i; ; n += TAPS) {
    const { x, y, width, height } = await page.locator(canvas).boundingBox();
    const place = [x + width * ((n * 0.618034) % 1), y + height * ((n * 0.754877) % 1)].map(Math.round);
    if (await page.evaluate(([x, y]) => document.elementFromPoint(x, y)?.matches("canvas"), place)) return place;
  }
}

async function compose(page, type, i) {
  await toTab(page, "Reports");
  await page.locator("#reports .compose:enabled").tap();
  await page.locator("#compose .types").getByRole("button", { name: type, exact: true }).tap();
  await still(page);
  await page.touchscreen.tap(...(await placeOn(page, i)));
  await page.fill("#compose input[name=z]", "0.5"); // no robot was there
  await page.locator("#compose .go").tap();
  await page.locator("#compose .check").waitFor();
  assert.equal(await page.textContent("#compose .summary .type"), type);
  await page.locator("#compose .send").tap();
  await page.waitForSelector("#reports:not([hidden])");
}

test("records what was chosen, wherever on the map the finger was", async (t) => {
  const made = await box(t, { settings: { command_post: { rates: { reports_hz: 20 } } }, post: ["--rate", "0"] });
  const page = await look(t, made, "", { hasTouch: true, viewport: { width: 390, height: 844 } });
  const sent = Array.from({ length: TAPS }, (_, i) => TYPES[i % TYPES.length]);
  for (const [i, type] of sent.entries()) await compose(page, type, i);
  const types = async () => (await made.record()).reports.map(({ type }) => type);
  await until(async () => (await types()).length === TAPS, "all of them");
  assert.deepEqual(await types(), sent);
  assert.deepEqual(page.complaints, []);
});
