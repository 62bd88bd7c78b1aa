// The system page as a whole, and its parts: support bundle, reset, software list.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { gunzipSync } from "node:zlib";
import { axeFindsNothing, openMore, shoot, text } from "./watch.js";
import { come, OPERATOR, untilRows, VIEWER } from "./system_page.js";

const SIZES = [["phone", 390, 844], ["720p", 1280, 720], ["1080p", 1920, 1080], ["4k", 3840, 2160]];

test("serves the support bundle as a file", async (t) => {
  const { stage, page } = await come(t);
  const button = page.getByRole("button", { name: "Download the bundle" });
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  assert.match(download.suggestedFilename(), /^adit-support-\d{8}T\d{6}Z\.tar\.gz$/);
  const archive = gunzipSync(await readFile(await download.path())).toString();
  assert.match(archive, /\/reports\.json/);
  assert.match(archive, /disk I\/O error/);
  for (const secret of [OPERATOR, VIEWER, "team-1"]) assert.ok(!archive.includes(secret), secret);
  await page.locator("#bundle .outcome").filter({ hasText: download.suggestedFilename() }).waitFor();
  await stage.end();
  await button.click();
  await page.locator("#bundle .outcome[data-bad=true]").filter({ hasText: "does not answer" }).waitFor();
});

test("lists the box's software", async (t) => {
  const { page } = await come(t);
  await page.locator("#about dd").first().waitFor();
  assert.match(await text(page, "#about dl"), /Version0\.1\.0.*GNU 12\.2\.0.*Apache-2\.0.*1:\d\d h.*aarch64.*A board/);
  await page.getByText("Parts and licences").click();
  assert.match(await page.getByRole("row", { name: /libdeflate/ }).innerText(), /1\.14\s+MIT/);
  for (const name of ["the API", "metrics"]) {
    const path = await page.getByRole("link", { name }).getAttribute("href");
    assert.equal(await page.evaluate(async (path) => (await fetch(path)).status, path), 200, name);
  }
});

test("shows a viewer only permitted parts and no forbidden actions", async (t) => {
  const { page } = await come(t, VIEWER);
  await untilRows(page, 4);
  await page.locator("#looks").waitFor();
  await page.locator("#about dd").first().waitFor();
  for (const id of ["sessions", "passwords", "bundle", "reset"]) assert.equal(await page.locator(`#${id}`).isVisible(), false, id);
  assert.deepEqual(page.requests.filter((url) => /sessions|bundle/.test(url)), []);
  assert.deepEqual(page.complaints, []);
});

test("links all pages", async (t) => {
  const { stage, page } = await come(t);
  const nav = page.getByRole("navigation", { name: /^(All p|P)ages$/ });
  assert.deepEqual(await nav.getByRole("link").allInnerTexts(), ["Run", "Runs", "Set-up", "System", "Display", "Help"]);
  assert.equal(await nav.getByRole("link", { name: "System" }).getAttribute("aria-current"), "page");
  await nav.getByRole("link", { name: "Run", exact: true }).click();
  await page.waitForSelector("body[data-link=live]");
  await openMore(page);
  assert.equal(await nav.locator("[aria-current]").innerText(), "Run");
  await nav.getByRole("link", { name: "System" }).click();
  await page.waitForURL(`${stage.url}system`);
  await nav.getByRole("link", { name: "Display" }).click();
  await page.waitForURL(`${stage.url}display`);
});

test("fits every screen, in both themes, without axe faults", async (t) => {
  const { stage, page } = await come(t, OPERATOR, { bypassCSP: true });
  await page.locator("#sessions li").first().waitFor();
  stage.play(`say ${"long".repeat(200)}`);
  await untilRows(page, 5);
  for (const [name, width, height] of SIZES) {
    await page.setViewportSize({ width, height });
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${name} is wider than the screen`);
    const small = await page.$$eval("main button, main a, nav a, select, main input", (nodes) =>
      nodes.filter((node) => node.checkVisibility() && node.getBoundingClientRect().height < 44).map((node) => node.outerHTML));
    assert.deepEqual(small, [], `${name}: too small for gloves`);
    const colorScheme = { phone: "dark", "1080p": "light" }[name];
    if (!colorScheme) continue;
    await page.emulateMedia({ colorScheme });
    await axeFindsNothing(page, `${name}, ${colorScheme}`);
    await shoot(page, `system-${name}-${colorScheme}`);
  }
  await page.locator("#reset").getByRole("button").click();
  for (const colorScheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme });
    await axeFindsNothing(page, `reset, ${colorScheme}`);
  }
  assert.deepEqual(page.complaints, []);
});

test("can be used by keyboard alone", async (t) => {
  const { page } = await come(t);
  await page.locator("#sessions li").first().waitFor();
  const reached = new Set();
  for (let i = 0; i < 60; ++i) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => document.activeElement.closest("section")?.id));
  }
  for (const id of ["log", "sessions", "passwords", "bundle", "about", "reset"]) assert.ok(reached.has(id), id);
});

test("has a moon on the button for the next theme, as each page has", async (t) => {
  const { page } = await come(t);
  for (const path of ["system", "setup", "runs"]) {
    await page.goto(new URL(`/${path}`, page.url()).href);
    const moon = await page.$eval("button.theme", (button) => getComputedStyle(button, "::before").boxShadow);
    assert.notEqual(moon, "none", path);
  }
});
