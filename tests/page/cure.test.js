// A refusal that a setting would cure leads there whoever may change it.
import assert from "node:assert/strict";
import { test } from "node:test";
import { retell } from "./retold.js";
import { axeFindsNothing, openMore, said, watch, withModules } from "./watch.js";

const KEYS = ["rules.rewrite_frame_id", "rules.map_bytes", "msg.info", "robots[].name", "robots[].alias", "version"];
const withKeys = (page) => page.route("**/adit/settings", (route) => route.fulfill({ json: { keys: KEYS.map((path) => ({ path })) } }));
const cures = (page) => page.locator("#refusals .cure:visible");

test("leads an operator from a refusal to the setting that its sentence names", async (t) => {
  const { page } = await watch(t, "trouble", { prepare: withKeys, bypassCSP: true });
  await openMore(page);
  await page.getByRole("link", { name: "Set rules.rewrite_frame_id" }).waitFor();
  assert.equal(await cures(page).count(), 1, "the other refusal names no setting, only a field");
  assert.equal(await cures(page).getAttribute("href"), "/setup?setting=rules.rewrite_frame_id#all");
  await axeFindsNothing(page, "a refusal with its cure");
});

test("leads from a name that a robot may not have to the robots and their aliases", async (t) => {
  const prepare = async (page) => {
    await withKeys(page);
    await retell(page, () => (view) => {
      for (const row of view.refusals) row.sentence = 'poses[0].name: expected 1 to 10 letters, got "husky-1" (the setting robots[].alias can map this name to a valid one)';
      return view;
    });
  };
  const { page } = await watch(t, "trouble", { prepare });
  await openMore(page);
  const way = page.getByRole("link", { name: "Set robots[].alias" }).first();
  await way.waitFor();
  assert.equal(await way.getAttribute("href"), "/setup#robots");
});

test("takes only a whole key that the box itself names", async (t) => {
  const { page } = await watch(t, "trouble", { prepare: (page) => Promise.all([withKeys(page), withModules(page)]) });
  const found = await page.evaluate(async () => {
    const { cureOf } = await import("/modules/cure.js");
    while (!cureOf("or set rules.map_bytes")) await new Promise(requestAnimationFrame); // until it has the keys
    return [
      "expected at most 9 cells (the setting rules.map_bytes), got 10", "or set rules.rewrite_frame_id.", "x (the setting robots[].alias gives a name)", // named
      'got "rules.map_bytes"', 'got "a \\" rules.map_bytes', "my.rules.map_bytes", "rules.map_bytesx", "rules", "version", "msg.info.width: expected 1", "robots[3].alias: 1", 'got "robots[].alias"', "rules.map_bytes[3]", // not
    ].map(cureOf);
  });
  assert.deepEqual(found, ["rules.map_bytes", "rules.rewrite_frame_id", "robots[].alias", "", "", "", "", "", "", "", "", "", ""]);
});

test("offers a viewer nothing", async (t) => {
  const prepare = async (page) => {
    await withKeys(page);
    await page.route("**/adit/session", (route) => route.fulfill({ json: { role: "viewer", csrf: "x", first_start: false } }));
  };
  const { page } = await watch(t, "trouble", { prepare });
  await said(page, "Only an operator can act");
  await openMore(page);
  await said(page, "the setting rules.rewrite_frame_id accepts any frame");
  assert.equal(await cures(page).count(), 0);
});
