import assert from "node:assert/strict";
import { test } from "node:test";
import { serve } from "./stage.js";
import { axeFindsNothing, visitor } from "./watch.js";

const OPERATOR = "correct horse", VIEWER = "look, do not touch";

/** The logged-in page of a box whose clock is two hours behind. */
async function come(t, password, options = {}) {
  const stage = await serve("calm", 0, "clock-behind");
  t.after(() => stage.end());
  const page = await visitor(t, `${stage.url}system`, options);
  await page.waitForURL(/login\.html/);
  await page.locator("#login").getByLabel("Password").fill(password);
  await page.keyboard.press("Enter");
  await page.waitForURL(/\/system$/);
  await page.locator("#link .text", { hasText: "Live" }).waitFor();
  return { page, dialog: page.locator("dialog#confirm[open]") };
}

const clockOf = (page) => page.evaluate(async () => (await fetch("/adit/clock")).json());

test("asks the operator once whether to use this device’s time, and sets the box’s clock to it", async (t) => {
  const { page, dialog } = await come(t, OPERATOR, { bypassCSP: true });  // for axe
  await dialog.getByText(/2:00 h behind this device/).waitFor();
  await axeFindsNothing(page);
  await dialog.getByRole("button", { name: "Set the clock" }).click();
  await page.waitForFunction(async () => Math.abs((await (await fetch("/adit/clock")).json()).now - Date.now() / 1000) < 60);
  assert.deepEqual(page.complaints, []);
});

test("does not ask again after no, and does not set the clock", async (t) => {
  const { page, dialog } = await come(t, OPERATOR);
  await dialog.waitFor();
  const before = (await clockOf(page)).now;
  await dialog.locator("button").first().click();
  await page.reload();
  await page.locator("#who .text", { hasText: "operator" }).waitFor();
  assert.equal(await dialog.count(), 0);
  assert.equal((await clockOf(page)).now, before);
});

test("says who set the box’s clock", async (t) => {
  const { page, dialog } = await come(t, OPERATOR);
  await dialog.locator("button").first().click();
  await page.locator("#clock").getByText(/(Set by|Not set since|Continued from) .*2:00 h behind this device/).waitFor();
});

test("does not ask a viewer", async (t) => {
  const { page, dialog } = await come(t, VIEWER);
  await page.locator("#who .text", { hasText: "viewer" }).waitFor();
  assert.equal(await dialog.count(), 0);
  assert.deepEqual(page.complaints, []);
});
