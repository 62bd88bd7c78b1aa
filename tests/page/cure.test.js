// If a setting can prevent a rejection, the page links to this setting, by its key and not by the sentence, if the user may change
// settings.
import assert from "node:assert/strict";
import { test } from "node:test";
import { retell } from "./retold.js";
import { axeFindsNothing, openMore, waitForText, watch } from "./watch.js";

const cures = (page) => page.locator("#refusals .cure:visible");
/** A page whose box names `setting` for each rejection. */
const naming = (setting) => (page) => retell(page, (setting) => (view) => {
  for (const row of view.refusals) Object.assign(row, { sentence: "rules.map_bytes: (the setting rules.map_bytes)", setting });
  return view;
}, setting);

test("links an operator from a rejection to the setting that can prevent it", async (t) => {
  const { page } = await watch(t, "trouble", { bypassCSP: true });
  await openMore(page);
  await page.getByRole("link", { name: "Set rules.rewrite_frame_id" }).waitFor();
  assert.equal(await cures(page).count(), 1, "no setting prevents the other refusal");
  assert.equal(await cures(page).getAttribute("href"), "/setup?setting=rules.rewrite_frame_id#all");
  await axeFindsNothing(page, "a refusal with its cure");
});

test("links from a rejected robot name to the robots and their aliases", async (t) => {
  const { page } = await watch(t, "trouble", { prepare: naming("robots[].alias") });
  await openMore(page);
  const way = page.getByRole("link", { name: "Set robots[].alias" }).first();
  await way.waitFor();
  assert.equal(await way.getAttribute("href"), "/setup#robots");
});

test("has no link if the box names no setting, even if its sentence does", async (t) => {
  const { page } = await watch(t, "trouble", { prepare: naming("") });
  await openMore(page);
  await waitForText(page, "the setting rules.map_bytes");
  assert.equal(await cures(page).count(), 0);
});

test("shows a viewer no link", async (t) => {
  const prepare = (page) => page.route("**/adit/session", (route) => route.fulfill({ json: { role: "viewer", csrf: "x", first_start: false } }));
  const { page } = await watch(t, "trouble", { prepare });
  await waitForText(page, "Only an operator can act");
  await openMore(page);
  await waitForText(page, "the setting rules.rewrite_frame_id accepts any frame");
  assert.equal(await cures(page).count(), 0);
});
