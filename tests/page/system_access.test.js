// Sessions and passwords on the system page.
import assert from "node:assert/strict";
import { test } from "node:test";
import { come, fill, OPERATOR, VIEWER } from "./system_page.js";

test("lists the sessions, and ends one, whose page goes to the login", async (t) => {
  const { stage, page } = await come(t);
  const { page: other } = await come(t, VIEWER, { stage });
  const row = page.locator("#sessions li", { hasText: /viewer/i });
  await row.waitFor();
  assert.match(await row.innerText(), /127\.0\.0\.1, Chrome on Linux/);
  assert.match(await row.innerText(), /logged in (now|\d+ (s|min) ago), seen (now|\d+ (s|min) ago)/);
  await row.getByRole("button", { name: "End: viewer" }).click();
  await page.getByRole("button", { name: "Cancel" }).click();
  assert.equal(await page.locator("#sessions li").count(), 2, "a cancelled action was performed");
  await row.getByRole("button", { name: "End: viewer" }).click();
  await page.getByRole("button", { name: "End", exact: true }).click();
  await row.waitFor({ state: "detached" });
  await page.waitForFunction(() => document.activeElement.matches("#sessions li button"));
  await other.waitForURL(/login\.html/);
  assert.equal(await page.locator("#sessions li").count(), 1);
});

const AGENTS = [
  ["Mozilla/5.0 (Linux; Android 13; Pixel 7) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/108.0.0.0 Mobile Safari/537.36", "Chrome on Android"],
  ["Mozilla/5.0 (Android 13; Mobile; rv:115.0) Gecko/115.0 Firefox/115.0", "Firefox on Android"],
  ["Mozilla/5.0 (Linux; Android 13; SM-X200) AppleWebKit/537.36 (KHTML, like Gecko) SamsungBrowser/20.0 Chrome/106.0.0.0 Safari/537.36", "Samsung Internet on Android"],
  ["Mozilla/5.0 (X11; Linux x86_64; rv:115.0) Gecko/20100101 Firefox/115.0", "Firefox on Linux"],
  ["Mozilla/5.0 (X11; CrOS x86_64 14541.0.0) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/108.0.0.0 Safari/537.36", "Chrome on ChromeOS"],
  ["Mozilla/5.0 (iPad; CPU OS 16_0 like Mac OS X) AppleWebKit/605.1.15 (KHTML, like Gecko) CriOS/108.0.0.0 Mobile/15E148 Safari/604.1", "Chrome on iPad"],
  ["Mozilla/5.0 (iPhone; CPU iPhone OS 16_0 like Mac OS X) AppleWebKit/605.1.15 (KHTML, like Gecko) Version/16.0 Mobile/15E148 Safari/604.1", "Safari on iPhone"],
  ["Mozilla/5.0 (Macintosh; Intel Mac OS X 10_15_7) AppleWebKit/605.1.15 (KHTML, like Gecko) Version/16.0 Safari/605.1.15", "Safari on Mac OS X"],
  ["Mozilla/5.0 (Windows NT 10.0; Win64; x64) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/108.0.0.0 Safari/537.36 Edg/108.0.1462.46", "Edge on Windows"],
];

test("names each session's browser and system", async (t) => {
  const { stage, page } = await come(t);
  const headers = { "Content-Type": "application/json" }, body = JSON.stringify({ password: VIEWER });
  for (const [agent] of AGENTS) await fetch(`${stage.url}adit/login`, { method: "POST", headers: { ...headers, "User-Agent": agent }, body });
  const rows = page.locator("#sessions li", { hasText: /viewer/i });
  await rows.nth(AGENTS.length - 1).waitFor();
  const shown = (await rows.locator(".from").allInnerTexts()).map((text) => text.replace(/^127\.0\.0\.1, /, ""));
  assert.deepEqual(shown.sort(), AGENTS.map(([, name]) => name).sort());
});

test("logs out by ending its own session", async (t) => {
  const { stage, page } = await come(t);
  await page.locator("#sessions").getByRole("button", { name: /Log out: operator/ }).click();
  await page.getByRole("button", { name: "End", exact: true }).click();
  await page.waitForURL(/login\.html/);
  const kept = (await page.context().cookies()).filter(({ value }) => value);
  assert.deepEqual(kept.map(({ name }) => name), [`adit-device-${new URL(stage.url).port}`], "only the device cookie remains");
});

test("says what is wrong with a new password", async (t) => {
  const { page } = await come(t);
  const form = page.locator("form[data-role=operator]"), outcome = form.locator(".outcome");
  const cases = [
    [{ current: "", password: "a new password", again: "a new password" }, /present password is missing/],
    [{ current: OPERATOR, password: "a new password", again: "another password" }, /differ/],
    [{ current: OPERATOR, password: "short", again: "short" }, /password: .*10/],
    [{ current: OPERATOR, password: "x".repeat(129), again: "x".repeat(129) }, /password: .*128/],
    [{ current: "wrong horse", password: "a new password", again: "a new password" }, /not the operator's present password/],
  ];
  for (const [fields, sentence] of cases) {
    await fill(form, fields);
    await form.getByRole("button", { name: "Change" }).click();
    await outcome.filter({ hasText: sentence }).waitFor();
    assert.equal(await outcome.getAttribute("data-bad"), "true");
    assert.equal(await form.locator("[name=current]").inputValue(), fields.current, "the current password is kept");
  }
});

test("changes the operator's password, which sends the other operators to the login", async (t) => {
  const { stage, page } = await come(t);
  const { page: other } = await come(t, OPERATOR, { stage });
  const form = page.locator("form[data-role=operator]");
  await fill(form, { current: OPERATOR, password: "a new password", again: "a new password" });
  await page.keyboard.press("Enter");
  await form.getByText("Changed.").waitFor();
  assert.equal(await form.locator("[name=password]").inputValue(), "", "the field is empty after the change");
  await other.waitForURL(/login\.html/);
  await page.reload();
  await page.locator("#link .text", { hasText: "Live" }).waitFor();
  await other.locator("#login").getByLabel("Password").fill("a new password");
  await other.keyboard.press("Enter");
  await other.waitForURL(/\/system$/);
});

test("sets and removes the viewers' password", async (t) => {
  const { stage, page } = await come(t);
  const { page: other } = await come(t, VIEWER, { stage });
  const form = page.locator("form[data-role=viewer]"), outcome = form.locator(".outcome");
  await form.getByRole("button", { name: "Remove" }).click();
  await outcome.filter({ hasText: "present password is missing" }).waitFor();
  await fill(form, { current: "wrong horse" });
  await form.getByRole("button", { name: "Remove" }).click();
  await outcome.filter({ hasText: "not the operator's present password" }).waitFor();
  await fill(form, { current: OPERATOR });
  await form.getByRole("button", { name: "Remove" }).click();
  await outcome.filter({ hasText: "Viewers cannot log in" }).waitFor();
  await other.waitForURL(/login\.html/);
  await fill(form, { current: OPERATOR, password: "for the teammates", again: "for the team" });
  await form.getByRole("button", { name: "Set", exact: true }).click();
  await outcome.filter({ hasText: "differ" }).waitFor();
  await fill(form, { again: "for the teammates" });
  await form.getByRole("button", { name: "Set", exact: true }).click();
  await outcome.filter({ hasText: "Set. All viewers" }).waitFor();
  await other.locator("#login").getByLabel("Password").fill("for the teammates");
  await other.keyboard.press("Enter");
  await other.waitForURL(/\/system$/);
  await other.locator("#looks").waitFor();
});
