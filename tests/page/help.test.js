// The help: in the navigation of each page, with the pages' glyphs, and searched as one types.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { serve } from "./stage.js";
import { axeFindsNothing, openMore, text, visitor, watch } from "./watch.js";

const TROUBLE = readFileSync(new URL("../../firmware/rules/alarms/TROUBLE.md", import.meta.url), "utf8");
const ALARMS = [...TROUBLE.matchAll(/^\| <a id="(\w+)"><\/a>([■?○]) /gm)].map(([, id, sign]) => [id, { "■": "bad", "?": "ask", "○": "wait" }[sign]]);

const FIRST = [...TROUBLE.matchAll(/^\| <a id="(first_\w+)">/gm)].map(([, id]) => id);

async function help(t, options = {}) {
  const stage = await serve("calm");
  t.after(() => stage.end());
  return visitor(t, `${stage.url}help`, options);
}

const shown = (page) => page.$$eval(".troubles dl, .signs dl", (all) => all.filter((each) => each.checkVisibility()).map((each) => each.id || each.querySelector("dt").textContent.trim()));
const search = (page) => page.getByRole("searchbox", { name: "Search" });

test("is linked by the navigation of the run page", async (t) => {
  const { page } = await watch(t, "calm");
  await openMore(page);
  await page.locator("#more").getByRole("link", { name: "Help", exact: true }).click();
  await page.waitForURL(/\/help$/);
  assert.equal(await page.locator("nav [aria-current]").innerText(), "Help");
});

test("shows the glyph of each alarm, and each glyph's meaning", async (t) => {
  const page = await help(t, { bypassCSP: true });
  assert.ok(ALARMS.length > 30, `${ALARMS.length}`);
  const levels = await page.$$eval(".troubles dl:has(.glyph)", (all) => all.map((each) => [each.id, each.querySelector("dt > .glyph").dataset.level]));
  assert.deepEqual(levels, ALARMS);
  assert.doesNotMatch(await text(page, ".troubles"), /[■○]| \?/);
  assert.deepEqual(await page.$$eval(".signs .glyph", (all) => all.map(({ dataset }) => dataset.level)), ["good", "wait", "bad", "ask", "quiet"]);
  const styles = await page.$$eval(".signs .glyph, .troubles dt > .glyph", (all) => all.map((each) => getComputedStyle(each)).map(({ clipPath, borderRadius, borderTopWidth }) => clipPath + borderRadius + borderTopWidth));
  assert.equal(new Set(styles).size, 5, "each level has a shape of its own");
  for (const theme of ["dark", "light", "red"]) {
    await page.evaluate((theme) => (document.documentElement.dataset.theme = theme), theme);
    await axeFindsNothing(page, theme);
  }
  for (const width of [320, 390, 1280, 1920]) {
    await page.setViewportSize({ width, height: 800 });
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${width} px`);
    assert.equal(new Set(await page.$$eval("nav a", (links) => links.map((link) => link.getBoundingClientRect().top))).size, 1, `${width}: the navigation is one line`);
  }
});

test("answers the questions of the first hour before the alarms, and has the signs last", async (t) => {
  const page = await help(t);
  assert.deepEqual(await page.$$eval("main > section", (all) => all.map((each) => each.className)), ["troubles", "signs"]);
  assert.deepEqual(FIRST, ["first_page", "first_https", "first_password", "first_start", "first_boot", "first_log"]);
  assert.deepEqual(await page.$$eval(".troubles dl", (all) => all.slice(0, 6).map(({ id }) => id)), FIRST);
  await search(page).fill("password forgotten");
  assert.deepEqual(await shown(page), ["first_password"]);
});

test("finds entries by their words as one types", async (t) => {
  const page = await help(t), all = await shown(page);
  assert.equal(all.length, ALARMS.length + FIRST.length + 9);
  await search(page).pressSequentially("doubt settle");
  const found = await shown(page);
  assert.ok(found.includes("report_in_doubt") && found.length < 6, found.join());
  assert.equal(await page.locator(".find [role=status]").innerText(), `${found.length} found.`);
  assert.deepEqual(await page.$$eval(".troubles h2", (titles) => titles.filter((title) => title.checkVisibility()).map((title) => title.textContent)), ["When something is wrong", "The Command Post and your reports"]);
  await search(page).fill("no such thing");
  assert.deepEqual(await shown(page), []);
  await page.getByText("Nothing matches.").waitFor();
  await search(page).fill("");
  assert.deepEqual(await shown(page), all);
  assert.deepEqual(page.complaints, []);
});

test("is whole without scripts, and has no search then", async (t) => {
  const page = await help(t, { javaScriptEnabled: false });
  await page.locator("#report_in_doubt").waitFor();
  assert.equal(await page.locator(".find").isVisible(), false);
  assert.equal(await page.locator(".troubles dl").count(), ALARMS.length + FIRST.length);
});

test("leaves the verdict its room beside the navigation", async (t) => {
  const { page } = await watch(t, "calm");
  for (const [width, height] of [[1600, 900], [1800, 900], [1920, 1080]]) {
    await page.setViewportSize({ width, height });
    const cut = await page.$$eval("#arriving strong, #arriving .reason", (parts) => parts.filter((part) => part.scrollWidth > part.clientWidth + 1).map((part) => part.textContent));
    assert.deepEqual(cut, [], `${width}`);
  }
});
