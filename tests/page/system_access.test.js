// Who is logged in, and the passwords, on the system page.
import assert from "node:assert/strict";
import { test } from "node:test";
import { come, fill, OPERATOR, VIEWER } from "./system_page.js";

test("lists who is logged in, and ends a session, whose page goes to the login", async (t) => {
  const { stage, page } = await come(t);
  const { page: other } = await come(t, VIEWER, { stage });
  const row = page.locator("#sessions li", { hasText: /viewer/i });
  await row.waitFor();
  assert.match(await row.innerText(), /127\.0\.0\.1, Chrome on Linux/);
  assert.match(await row.innerText(), /logged in (now|\d+ (s|min) ago), seen (now|\d+ (s|min) ago)/);
  await row.getByRole("button", { name: "End: viewer" }).click();
  await page.getByRole("button", { name: "Cancel" }).click();
  assert.equal(await page.locator("#sessions li").count(), 2, "nothing is done on a no");
  await row.getByRole("button", { name: "End: viewer" }).click();
  await page.getByRole("button", { name: "End", exact: true }).click();
  await row.waitFor({ state: "detached" });
  await page.waitForFunction(() => document.activeElement.matches("#sessions li button"));
  await other.waitForURL(/login\.html/);
  assert.equal(await page.locator("#sessions li").count(), 1);
});

test("logs out by ending the own session", async (t) => {
  const { page } = await come(t);
  await page.locator("#sessions").getByRole("button", { name: /Log out: operator/ }).click();
  await page.getByRole("button", { name: "End", exact: true }).click();
  await page.waitForURL(/login\.html/);
  const kept = (await page.context().cookies()).filter(({ value }) => value);
  assert.deepEqual(kept.map(({ name }) => name), ["adit-device"], "which lets nobody in");
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
    assert.equal(await form.locator("[name=current]").inputValue(), fields.current, "and leaves what was typed");
  }
});

test("changes the operator's password, and sends the other operators to the login", async (t) => {
  const { stage, page } = await come(t);
  const { page: other } = await come(t, OPERATOR, { stage });
  const form = page.locator("form[data-role=operator]");
  await fill(form, { current: OPERATOR, password: "a new password", again: "a new password" });
  await page.keyboard.press("Enter");
  await form.getByText("Changed.").waitFor();
  assert.equal(await form.locator("[name=password]").inputValue(), "", "and forgets it");
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
