import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { axeFindsNothing } from "./axe.js";
import { openMore } from "./parts.js";
import { launch, leave, serve, visit } from "./stage.js";

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** A page at `path` without a session, for one test. */
async function come(t, path = "", more = [], options) {
  const stage = await serve("calm", 0, ...more);
  t.after(() => stage.end());
  const page = await visit(browser, stage.url + path, options);
  t.after(() => leave(page));
  return { stage, page };
}

const live = (page) => page.waitForSelector("body[data-link=live]");
const isLoggedInAs = (page, role) => page.locator("#who:not([hidden])").getByText(`Logged in as ${role}`, { exact: true }).waitFor({ state: "attached" });

async function logIn(page, password) {
  await page.locator("#login").getByLabel("Password").fill(password);
  await page.keyboard.press("Enter");
}

test("asks an unauthenticated user for the password, and then goes where he wanted to", async (t) => {
  const { page } = await come(t, "index.html?x=1#reports");
  await page.waitForURL(/login\.html/);
  await logIn(page, "correct horse");
  await live(page);
  // #reports was a part of the page, and the login returns to it.
  assert.match(page.url(), /\/index\.html\?x=1$/);
  await isLoggedInAs(page, "operator");
});

test("says what is wrong with a password, and lets the user type again", async (t) => {
  const { page } = await come(t, "login.html");
  await logIn(page, "wrong horse");
  await page.getByRole("alert").getByText("that is not the password").waitFor();
  assert.equal(await page.evaluate(() => document.activeElement.name), "password");
  await logIn(page, "look, do not touch");
  await live(page);
  await isLoggedInAs(page, "viewer");
});

test("sets the first password with the code of the box", async (t) => {
  const { page } = await come(t, "", ["first-start"]);
  await page.getByLabel("Code").fill("12345678");
  await page.getByLabel("New password").fill("a new password");
  await page.getByLabel("Repeat the password").fill("another password");
  await page.keyboard.press("Enter");
  await page.getByRole("alert").getByText("differ").waitFor();
  await page.getByLabel("Repeat the password").fill("a new password");
  await page.getByLabel("Code").fill("11111111");
  await page.keyboard.press("Enter");
  await page.getByRole("alert").getByText("that is not the code").waitFor();
  await page.getByLabel("Code").fill("1234 5678");
  await page.keyboard.press("Enter");
  await live(page);
  await isLoggedInAs(page, "operator");
});

test("offers a new password without the code while set-up is open", async (t) => {
  const { page } = await come(t, "", ["set-up-open"]);
  const first = page.locator("#first");
  await first.waitFor();
  assert.equal(await page.getByLabel("Code").count(), 0);
  assert.ok(await page.locator("#login").isVisible());
  await first.getByLabel("New password").fill("a new password");
  await first.getByLabel("Repeat the password").fill("a new password");
  await page.keyboard.press("Enter");
  await live(page);
  await isLoggedInAs(page, "operator");
});

test("logs out for good", async (t) => {
  const { page, stage } = await come(t);
  await logIn(page, "correct horse");
  await live(page);
  const cookie = (await page.context().cookies()).find(({ name }) => name === `adit-${new URL(stage.url).port}`);
  assert.ok(cookie);
  assert.equal(cookie.httpOnly, true);
  assert.equal(cookie.sameSite, "Strict");
  await openMore(page);
  await page.getByRole("button", { name: "Log out" }).click();
  await page.waitForURL(/login\.html/);
  const old = await fetch(`${stage.url}adit/run`, { headers: { Cookie: `${cookie.name}=${cookie.value}` } });
  assert.equal(old.status, 401);
});

test("goes only to pages of this box", async (t) => {
  const { page, stage } = await come(t, "icon.svg");
  for (const next of ["//evil.example/", "https://evil.example/", "javascript:alert(1)", "/.//evil.example/", "\\\\evil.example", "http://["]) {
    await page.goto(`${stage.url}icon.svg`);  // a page that does not redirect
    await page.context().clearCookies();
    await page.goto(`${stage.url}login.html?next=${encodeURIComponent(next)}`);
    await logIn(page, "correct horse");
    await page.waitForURL((url) => !url.pathname.endsWith("login.html"));
    assert.equal(new URL(page.url()).origin + "/", stage.url, next);
  }
});

for (const [name, form, ...more] of [["log-in", "#login"], ["first password", "#first", "first-start"]]) {
  test(`has the theme's button beside the logo, in one line with it, on the page of the ${name}`, async (t) => {
    const { page } = await come(t, "login.html", more);
    await page.locator(form).waitFor();
    for (const width of [320, 390, 1280, 1920]) {
      await page.setViewportSize({ width, height: 800 });
      const [logo, button, main] = await page.$$eval("h1 img, button.theme, form:not([hidden])", (nodes) => nodes.map((node) => node.getBoundingClientRect().toJSON()));
      assert.ok(button.left >= logo.right && Math.abs(button.right - main.right) < 1, `${width}: ${button.left}, ${logo.right}`);
      assert.ok(Math.abs(button.top + button.bottom - logo.top - logo.bottom) < 2, `${width}: not in one line`);
      assert.ok(button.bottom <= main.top && main.left >= 8, `${width}`);
    }
  });
}

test("has no axe fault, in the dark and the light theme", async (t) => {
  for (const more of [[], ["first-start"], ["set-up-open"]]) {
    const { page } = await come(t, "login.html", more, { bypassCSP: true });
    await page.waitForSelector("form:not([hidden])");
    for (const colorScheme of ["dark", "light"]) {
      await page.emulateMedia({ colorScheme });
      await axeFindsNothing(page, `${more}, ${colorScheme}`);
    }
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    assert.deepEqual(page.complaints, []);
  }
});
