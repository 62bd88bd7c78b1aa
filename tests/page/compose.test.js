import assert from "node:assert/strict";
import { test } from "node:test";
import { axeFindsNothing, text, watch } from "./watch.js";

const fill = async (page, type, x, y, z) => {
  await page.getByRole("radio", { name: type, exact: true }).check();
  for (const [axis, value] of Object.entries({ x, y, z })) if (value !== undefined) await page.fill(`#compose input[name=${axis}]`, value);
};
/** By its key, which does nothing until it is known who looks. */
const compose = async (page) => {
  await page.waitForSelector("#reports .compose:enabled");
  await page.keyboard.press("n");
  await page.waitForSelector("#compose[open]");
};
const check = (page) => page.getByRole("button", { name: "Check" }).click();
const send = (page) => page.locator("#compose .send").click();
const becomes = (page, number, words) =>
  page.waitForFunction(([number, words]) => document.querySelector(`#reports li[data-key="${number}"]`)?.innerText.includes(words), [number, words]);

test("composes a report: what, where, a look at what is near, and away", async (t) => {
  const { page } = await watch(t, "reports");
  await page.getByRole("button", { name: "New report" }).click();
  assert.deepEqual(await page.locator("#compose .types label").allTextContents(),
    ["Survivor", "Cell Phone", "Backpack", "Drill", "Fire Extinguisher", "Gas", "Vent", "Helmet", "Rope", "Cube"]);
  await fill(page, "Gas", "306", "-3.5", "0.25");
  await check(page);
  assert.match(await text(page, "#compose .summary"), /Gas at 306\.0, −3\.5, 0\.3 m/);
  assert.match(await text(page, "#compose .notes"), /Near: #25 Gas, 1\.0 m away.*Near: #24 Gas, 1\.0 m away.*18 reports are left/);
  assert.ok(await page.locator("#compose .again").isHidden());
  await send(page);
  await becomes(page, 29, "waiting");
  await becomes(page, 29, "Taken; it is sent in its turn.");
  await page.waitForFunction(() => document.activeElement.closest("li")?.dataset.key === "29");
  assert.deepEqual(page.complaints, []);
});

test("names the field that is wrong, and goes there", async (t) => {
  const { page } = await watch(t, "reports");
  await compose(page);
  await check(page);
  assert.match(await text(page, "#compose .trouble"), /Choose what it is/);
  for (const [axis, wrong] of [["x", ""], ["x", "12,5"], ["y", "left"], ["z", "1e3"], ["z", "."]]) {
    await fill(page, "Rope", "1", "2", "3");
    await page.fill(`#compose input[name=${axis}]`, wrong);
    await check(page);
    assert.match(await text(page, "#compose .trouble"), new RegExp(`^${axis}: expected metres`), wrong);
    assert.equal(await page.evaluate(() => document.activeElement.name), axis);
    assert.equal(await page.getAttribute(`#compose input[name=${axis}]`, "aria-invalid"), "true");
  }
});

test("says that the very same was reported, and sends it again only when told to", async (t) => {
  const { page } = await watch(t, "reports");
  await compose(page);
  await fill(page, "Helmet", "281.75", "−4.5", ".25");
  await check(page);
  assert.match(await text(page, "#compose .notes"), /Reported already, at the very same place: #23 Helmet, scored \+1/);
  await send(page);
  await becomes(page, 23, "The same was reported before: this is it.");
  assert.equal(await page.locator("#reports li[data-key='29']").count(), 0);

  await page.locator("#reports .compose").click();
  await fill(page, "Helmet", "281.75", "-4.5", "0.25");
  await check(page);
  await page.locator("#compose .again").click();
  await send(page);
  await becomes(page, 29, "waiting");
});

test("shows the box's sentence where it was not taken, and keeps what was typed", async (t) => {
  const { page } = await watch(t, "reports");
  await compose(page);
  await fill(page, "Cube", "666", "0", "0");
  await check(page);
  await send(page);
  await page.waitForFunction(() => document.querySelector("#compose .trouble").textContent.includes("this one was not taken"));
  await page.getByRole("button", { name: "Change" }).click();
  assert.equal(await page.inputValue("#compose input[name=x]"), "666");
  await page.getByRole("button", { name: "Close" }).click();
  await page.locator("#compose").waitFor({ state: "hidden" });
});

test("takes a place from the map, by finger and by keyboard, and a robot's height with it", async (t) => {
  const { page } = await watch(t, "calm");
  await compose(page);
  await page.getByRole("button", { name: "Pick on the map" }).click();
  const canvas = page.locator("#map .frame canvas");
  await canvas.click({ position: { x: 200, y: 150 } });
  await page.waitForSelector("#compose[open]");
  const first = Number(await page.inputValue("#compose input[name=x]"));
  assert.ok(Number.isFinite(first) && (await page.inputValue("#compose input[name=y]")) !== "");
  await page.getByRole("button", { name: "Pick on the map" }).click();
  for (let i = 0; i < 3; ++i) await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Enter");
  await page.waitForSelector("#compose[open]");
  assert.notEqual(Number(await page.inputValue("#compose input[name=x]")), first);
  await page.getByRole("button", { name: "Pick on the map" }).click();
  await page.keyboard.press("Escape");
  await page.waitForSelector("#compose[open]");
  await page.getByRole("button", { name: "Pick on the map" }).click();
  await page.getByRole("button", { name: "Cancel" }).click();
  await page.waitForSelector("#compose[open]");
});

test("has nothing that axe finds wrong in its dialogs, in the dark and by day", async (t) => {
  const { page } = await watch(t, "reports", { bypassCSP: true });
  const isWell = async (dialog) => {
    for (const colorScheme of ["dark", "light"]) {
      await page.emulateMedia({ colorScheme });
      await axeFindsNothing(page, `${dialog}, ${colorScheme}`);
    }
  };
  await compose(page);
  await isWell("fields");
  await fill(page, "Helmet", "281.75", "-4.5", "0.25");
  await check(page);
  await isWell("check");
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => !document.activeElement.closest("dialog")); // which takes the keys until the next frame
  await page.keyboard.press("?");
  await page.waitForSelector("#help[open]");
  await isWell("help");
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Send once more: report 25" }).click();
  await page.waitForSelector("#confirm[open]");
  await isWell("confirm");
});
