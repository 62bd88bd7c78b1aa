import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { gunzipSync } from "node:zlib";
import { serve } from "./stage.js";
import { axeFindsNothing, openMore, shoot, text, visitor } from "./watch.js";

const OPERATOR = "correct horse", VIEWER = "look, do not touch";
const SIZES = [["phone", 390, 844], ["720p", 1280, 720], ["1080p", 1920, 1080], ["4k", 3840, 2160]];

/** A page that logged in with `password` and looks at the system, for the length of one test. */
async function come(t, password = OPERATOR, { stage, ...options } = {}) {
  if (!stage) {
    stage = await serve("calm");
    t.after(() => stage.end());
  }
  const page = await visitor(t, `${stage.url}system`, options);
  await page.waitForURL(/login\.html\?next=%2Fsystem/);
  await page.locator("#login").getByLabel("Password").fill(password);
  await page.keyboard.press("Enter");
  await page.waitForURL(/\/system$/);
  await page.locator("#link .text", { hasText: "Live" }).waitFor();
  return { stage, page };
}

const rows = (page) => page.$$eval("#log .rows li", (items) => items.map((item) => item.innerText.replace(/\s+/g, " ")));
const untilRows = (page, count) => page.waitForFunction((count) => document.querySelectorAll("#log .rows li").length === count, count);

/** Fills the fields of a form by their names. */
async function fill(form, fields) {
  for (const [name, value] of Object.entries(fields)) await form.locator(`[name=${name}]`).fill(value);
}

test("shows the log as it grows, newest first", async (t) => {
  const { stage, page } = await come(t);
  await untilRows(page, 4);
  const said = await rows(page);
  assert.match(said[0], /error the ledger cannot be written note=disk I\/O error/);
  assert.match(said[3], /notice listening/);
  stage.play("say the cable was pulled");
  await page.locator("#log li", { hasText: "the cable was pulled" }).waitFor();
  assert.match((await rows(page))[0], /the cable was pulled/);
  assert.equal(await page.evaluate(() => window.pwned), undefined, "what anybody sent is text");
  assert.deepEqual(page.complaints, []);
});

test("shows of the log what is asked for, and gives the same as a file", async (t) => {
  const { page } = await come(t);
  await page.getByLabel("Shown").selectOption("Warnings and worse");
  await untilRows(page, 2);
  await page.getByLabel("Holding the text").fill("LEDGER");
  await untilRows(page, 1);
  assert.match((await rows(page))[0], /the ledger/);
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("link", { name: "Download" }).click()]);
  assert.equal(download.suggestedFilename(), "adit-log.txt");
  assert.equal(await readFile(await download.path(), "utf8"), "error: the ledger cannot be written note=disk I/O error\n");
  await page.getByLabel("Holding the text").fill("nobody said this & that");
  await page.getByText("No record matches.").waitFor();
  await page.getByLabel("Holding the text").fill("");
  await page.getByLabel("Shown").selectOption("Everything");
  await untilRows(page, 4);
});

test("says when the box is lost, and comes back with a log of its own when it was restarted", async (t) => {
  const { stage, page } = await come(t);
  await untilRows(page, 4);
  for (let i = 0; i < 3; ++i) stage.play(`say ${i}`);
  await untilRows(page, 7);
  await stage.end();
  await page.locator("#link .text", { hasText: "Box lost" }).waitFor();
  const again = await serve("calm", stage.port);
  t.after(() => again.end());
  await page.waitForURL(/login\.html/); // its sessions are gone, too
  await page.locator("#login").getByLabel("Password").fill(OPERATOR);
  await page.keyboard.press("Enter");
  await untilRows(page, 4);
});

test("lists who is logged in, and ends a session, whose page goes to the login", async (t) => {
  const { stage, page } = await come(t);
  const { page: other } = await come(t, VIEWER, { stage });
  const row = page.locator("#sessions li", { hasText: /viewer/i });
  await row.waitFor();
  assert.match(await row.innerText(), /127\.0\.0\.1, Chrome on Linux/);
  assert.match(await row.innerText(), /logged in (now|\d+ (s|min) ago), seen (now|\d+ (s|min) ago)/);
  await row.getByRole("button", { name: "End: viewer" }).click();
  await page.getByRole("button", { name: "Leave it" }).click();
  assert.equal(await page.locator("#sessions li").count(), 2, "nothing is done on a no");
  await row.getByRole("button", { name: "End: viewer" }).click();
  await page.getByRole("button", { name: "End it" }).click();
  await row.waitFor({ state: "detached" });
  await page.waitForFunction(() => document.activeElement.matches("#sessions li button"));
  await other.waitForURL(/login\.html/);
  assert.equal(await page.locator("#sessions li").count(), 1);
});

test("logs out by ending the own session", async (t) => {
  const { page } = await come(t);
  await page.locator("#sessions").getByRole("button", { name: /Log out: operator/ }).click();
  await page.getByRole("button", { name: "End it" }).click();
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
    await form.getByRole("button", { name: "Change it" }).click();
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
  await form.getByRole("button", { name: "Remove it" }).click();
  await outcome.filter({ hasText: "present password is missing" }).waitFor();
  await fill(form, { current: "wrong horse" });
  await form.getByRole("button", { name: "Remove it" }).click();
  await outcome.filter({ hasText: "not the operator's present password" }).waitFor();
  await fill(form, { current: OPERATOR });
  await form.getByRole("button", { name: "Remove it" }).click();
  await outcome.filter({ hasText: "nobody can log in as viewer" }).waitFor();
  await other.waitForURL(/login\.html/);
  await fill(form, { current: OPERATOR, password: "for the teammates", again: "for the team" });
  await form.getByRole("button", { name: "Set it" }).click();
  await outcome.filter({ hasText: "differ" }).waitFor();
  await fill(form, { again: "for the teammates" });
  await form.getByRole("button", { name: "Set it" }).click();
  await outcome.filter({ hasText: "Set. Whoever" }).waitFor();
  await other.locator("#login").getByLabel("Password").fill("for the teammates");
  await other.keyboard.press("Enter");
  await other.waitForURL(/\/system$/);
  await other.locator("#looks").waitFor();
});

test("gives the support bundle as a file", async (t) => {
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

test("resets the box for whoever knows the operator's password, and asks first", async (t) => {
  const { page } = await come(t);
  const posted = [];
  let asked = 0; // until it is asked twice the box has not restarted
  await page.route("**/adit/session", (route) =>
    posted.includes(OPERATOR) ? route.fulfill({ json: { role: null, csrf: null, first_start: ++asked > 2 } }) : route.continue());
  await page.route("**/adit/reset", (route) => {
    const { password } = route.request().postDataJSON();
    posted.push(password);
    return password === OPERATOR ? route.fulfill({ json: {} }) : route.fulfill({ status: 403, json: "that is not the operator's present password" });
  });
  const open = page.locator("#reset").getByRole("button", { name: "Reset the box" }), dialog = page.locator("#wipe");
  await open.click();
  await dialog.getByRole("button", { name: "Leave it" }).click();
  await open.click();
  await page.keyboard.press("Escape");
  assert.deepEqual(posted, []);
  await open.click();
  await dialog.getByLabel("present password").fill("wrong horse");
  await page.keyboard.press("Enter");
  await dialog.getByRole("alert").filter({ hasText: "not the operator's present password" }).waitFor();
  await dialog.getByLabel("present password").fill(OPERATOR);
  await dialog.getByRole("button", { name: "Reset the box" }).click();
  await page.getByLabel("Code").waitFor();
  assert.equal(await page.locator("#login").isVisible(), false, "nobody is asked for a password that is gone");
  assert.deepEqual(posted, ["wrong horse", OPERATOR]);
});

test("tells what the box is made of", async (t) => {
  const { page } = await come(t);
  await page.locator("#about dd").first().waitFor();
  assert.match(await text(page, "#about dl"), /Version0\.1\.0.*GNU 12\.2\.0.*Apache-2\.0.*1:\d\d h.*aarch64.*A board/);
  await page.getByText("Parts and licences").click();
  assert.match(await page.getByRole("row", { name: /SQLite/ }).innerText(), /3\.40\.1\s+blessing/);
  for (const name of ["the API", "metrics"]) {
    const path = await page.getByRole("link", { name }).getAttribute("href");
    assert.equal(await page.evaluate(async (path) => (await fetch(path)).status, path), 200, name);
  }
});

test("shows a viewer what he may see, and nothing that he may not do", async (t) => {
  const { page } = await come(t, VIEWER);
  await untilRows(page, 4);
  await page.locator("#looks").waitFor();
  await page.locator("#about dd").first().waitFor();
  for (const id of ["sessions", "passwords", "bundle", "reset"]) assert.equal(await page.locator(`#${id}`).isVisible(), false, id);
  assert.deepEqual(page.requests.filter((url) => /sessions|bundle/.test(url)), []);
  assert.deepEqual(page.complaints, []);
});

test("leads from each page to the others", async (t) => {
  const { stage, page } = await come(t);
  const nav = page.getByRole("navigation", { name: /^(All p|P)ages$/ });
  assert.deepEqual(await nav.getByRole("link").allInnerTexts(), ["Run", "Runs", "Set-up", "System", "Display"]);
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

test("fits every screen, in the dark and by day, with nothing that axe finds wrong", async (t) => {
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
    if (name !== "phone" && name !== "1080p") continue;
    for (const colorScheme of ["dark", "light"]) {
      await page.emulateMedia({ colorScheme });
      await axeFindsNothing(page, `${name}, ${colorScheme}`);
      await shoot(page, `system-${name}-${colorScheme}`);
    }
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
  for (let i = 0; i < 40; ++i) {
    await page.keyboard.press("Tab");
    reached.add(await page.evaluate(() => document.activeElement.closest("section")?.id));
  }
  for (const id of ["log", "sessions", "passwords", "bundle", "about", "reset"]) assert.ok(reached.has(id), id);
});

const updating = (page) => page.locator("#update");
/** Begins as a bundle does: as a squashfs of 40 bytes. */
const aFile = (text) => ({ name: "adit-a-board-0.2.0.raucb", mimeType: "", buffer: Buffer.from(`hsqs${"\0".repeat(36)}(${"\0".repeat(7)}${text}`, "latin1") });

test("tells which version runs and what became of the last update", async (t) => {
  const { page } = await come(t);
  await updating(page).getByText("0.1.0, slot A. 0.0.9 left: it did not come up healthy in three starts").waitFor();
  assert.deepEqual(page.complaints, []);
});

test("installs an update from a file, and says why one was refused", async (t) => {
  const { page } = await come(t);
  const file = updating(page).getByLabel("The update"), install = updating(page).getByRole("button", { name: "Install it" });
  await file.setInputFiles({ ...aFile(""), buffer: Buffer.alloc(1 << 20, "no update") });
  await install.click();
  await updating(page).getByText("it is no update").waitFor();
  assert.match(page.complaints.splice(0).join(), /^[^,]*status of 422[^,]*$/); // the browser's own word of it
  await file.setInputFiles(aFile("xxx"));
  await install.click();
  await updating(page).getByText("Invalid bundle format: Signature size is 0").waitFor();
  await file.setInputFiles(aFile("good"));
  await install.click();
  await updating(page).getByText("0.1.0, slot A. 0.2.0 waits for a restart").waitFor();
  assert.deepEqual(page.complaints, []);
});

test("installs what is on a stick, and shows how far it is", async (t) => {
  const { page } = await come(t);
  await updating(page).getByRole("button", { name: "Install 0.3.0 from the stick" }).click();
  await updating(page).getByText("The box is installing.").waitFor();
  assert.equal(await updating(page).getByRole("progressbar").getAttribute("value"), "40");
  assert.equal(await updating(page).getByRole("button").count(), 0, "one at a time");
});

test("restarts the box only on the operator's word while a report waits", async (t) => {
  const { page } = await come(t);
  const restart = page.locator("#restart"), dialog = page.locator("#confirm");
  const press = (name) => dialog.getByRole("button", { name, exact: true }).click();
  await restart.getByRole("button", { name: "Restart the box" }).click();
  await dialog.getByText("It takes about a minute.").waitFor();
  await press("Leave it");
  assert.ok(!page.requests.some((url) => url.endsWith("/adit/update/restart")), "nothing is asked for on a no");
  await restart.getByRole("button", { name: "Restart the box" }).click();
  await press("Restart");
  await dialog.getByText("1 report waits to be sent.").waitFor();
  await press("Leave it");
  await restart.getByText("The box was not restarted.").waitFor();
  await restart.getByRole("button", { name: "Restart the box" }).click();
  await press("Restart");
  await dialog.getByText("1 report waits to be sent.").waitFor();
  await press("Restart");
  await restart.getByText("The box is restarting.").waitFor();
  await page.waitForFunction(() => document.querySelector("#restart button").disabled);
});

test("has a moon on the button for the next theme, as each page has", async (t) => {
  const { page } = await come(t);
  for (const path of ["system", "setup", "runs"]) {
    await page.goto(new URL(`/${path}`, page.url()).href);
    const moon = await page.$eval("button.theme", (button) => getComputedStyle(button, "::before").boxShadow);
    assert.notEqual(moon, "none", path);
  }
});

const STRAY = "slot A with 0.1.0 runs, and slot B with 0.2.0 was good last";

/** The page of a box that runs from another slot than the one that was good last, until it is told to stay. */
async function strayed(t, password) {
  const { page } = await come(t, password);
  let stray = STRAY;
  await page.route("**/adit/update", async (route) => {
    const answer = await route.fetch();
    await route.fulfill({ response: answer, json: { ...(await answer.json()), stray } });
  });
  await page.route("**/adit/update/stay", (route) => {
    stray = null;
    return route.continue();
  });
  await updating(page).getByText(`Another slot is running: ${STRAY}.`).waitFor();
  return page;
}

test("goes back from a slot that nobody meant, once it is confirmed", async (t) => {
  const page = await strayed(t), dialog = page.locator("#confirm");
  const press = (name) => dialog.getByRole("button", { name, exact: true }).click();
  await updating(page).getByRole("button", { name: "Go back" }).click();
  await press("Leave it");
  assert.ok(!page.requests.some((url) => url.endsWith("/adit/update/back")), "nothing is asked for on a no");
  await updating(page).getByRole("button", { name: "Go back" }).click();
  await press("Go back");
  await dialog.getByText("1 report waits to be sent.").waitFor();
  await press("Go back");
  await updating(page).locator(".stray").getByText("The box is restarting.").waitFor();
});

test("stays with the slot that runs, once it is confirmed", async (t) => {
  const page = await strayed(t), dialog = page.locator("#confirm");
  await updating(page).getByRole("button", { name: "Stay with slot A" }).click();
  await dialog.getByRole("button", { name: "Stay", exact: true }).click();
  await updating(page).getByText("Another slot is running").waitFor({ state: "hidden" });
  assert.ok(page.requests.some((url) => url.endsWith("/adit/update/stay")));
});

test("says to a viewer that another slot is running, and offers him nothing", async (t) => {
  const page = await strayed(t, VIEWER);
  assert.equal(await updating(page).getByRole("button").count(), 0);
});

test("says why it cannot restart the box, and what to do then", async (t) => {
  const { page } = await come(t);
  await page.route("**/adit/update", (route) => route.fulfill({ json: { managed: false, why: "adit-update does not run here", doing: null, progress: null, refusal: null, last: null, stick: null, stick_why: null } }));
  await page.locator("#restart").getByText("This page cannot restart the box (adit-update does not run here). Switch it off and on.").waitFor();
  assert.equal(await page.locator("#restart").getByRole("button").count(), 0);
});

test("lets a viewer see the update and do nothing", async (t) => {
  const { page } = await come(t, VIEWER);
  await updating(page).getByText("0.1.0, slot A").waitFor();
  assert.equal(await updating(page).getByRole("button").count(), 0);
  assert.equal(await page.locator("#restart").getByRole("button").count(), 0);
});
