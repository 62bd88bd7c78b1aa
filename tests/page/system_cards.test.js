// The cards of the system page: a line in words for each, the rest opened on demand, and by itself if it needs the operator.
import assert from "node:assert/strict";
import { test } from "node:test";
import { axeFindsNothing } from "./watch.js";
import { come, VIEWER } from "./system_page.js";

const LINES = {
  sessions: /^\s*No one else is logged in$/,
  passwords: /^\s*Operator’s and viewers’$/,
  https: /^\s*Not offered$/,
  clock: /^\s*2:00 h behind this device$/,
  update: /^\s*Slot A, 0\.1\.0; 0\.0\.9 was left$/,
  restart: /^\s*Takes about a minute$/,
  spare: /^\s*An export is on the stick$/,
  bundle: /^\s*One file to find faults$/,
  about: /^\s*Adit 0\.1\.0, A board$/,
  reset: /^\s*Keeps only the reports$/,
};

const card = (page, id) => page.locator(`#${id} > .card`);
const line = (page, id) => page.locator(`#${id} .state`);
const isOpen = (page, id) => card(page, id).evaluate((node) => node.open);
const opened = (page) => page.$$eval(".card[open]", (cards) => cards.map((each) => each.parentElement.id));
const closed = (t, password, options) => come(t, password, { areOpen: false, ...options });

test("says the state of each card in a line, and opens none that is as it should be", async (t) => {
  const { page } = await closed(t, undefined, { bypassCSP: true });
  for (const [id, words] of Object.entries(LINES)) await line(page, id).filter({ hasText: words }).waitFor();
  assert.deepEqual(await opened(page), []);
  for (const theme of ["dark", "light", "red"]) {
    await page.evaluate((theme) => (document.documentElement.dataset.theme = theme), theme);
    await axeFindsNothing(page, theme);
  }
  assert.deepEqual(page.complaints, []);
});

test("has the passwords near the top, and columns of one height", async (t) => {
  const { page } = await closed(t);
  await line(page, "about").filter({ hasText: "Adit" }).waitFor();
  for (const [width, height] of [[1280, 720], [1920, 1080], [3840, 2160]]) {
    await page.setViewportSize({ width, height });
    const boxes = await page.$$eval(".column, #log, #passwords", (nodes) => nodes.map((node) => node.getBoundingClientRect().toJSON()));
    const [cards, passwords, log] = boxes;
    assert.ok(Math.abs(cards.bottom - log.bottom) < 2, `${cards.bottom} and ${log.bottom} at ${width}`);
    assert.ok(log.bottom > 0.85 * height && log.bottom < height, `the log ends at ${log.bottom} of ${height}`);
    assert.ok(passwords.bottom < height / 2, `passwords end at ${passwords.bottom} of ${height}`);
    const cut = await page.$$eval(".card > summary, .card .state", (nodes) => nodes.filter((node) => node.scrollWidth > node.clientWidth + 1).map((node) => node.textContent));
    assert.deepEqual(cut, [], `${width}`);
  }
});

test("opens and closes a card by keyboard", async (t) => {
  const { page } = await closed(t);
  await card(page, "passwords").locator("summary").focus();
  await page.keyboard.press("Enter");
  await page.getByLabel("Present password", { exact: true }).waitFor();
  await page.keyboard.press("Tab");
  assert.ok(await page.evaluate(() => document.activeElement.matches("#passwords [name=current]")));
  await page.keyboard.press("Shift+Tab");
  await page.keyboard.press("Enter");
  await page.getByLabel("Present password", { exact: true }).waitFor({ state: "hidden" });
});

test("opens a card that begins to need the operator, once", async (t) => {
  const { page } = await closed(t);
  await line(page, "update").filter({ hasText: "Slot A" }).waitFor();
  let stray = "slot A with 0.1.0 runs, and slot B with 0.2.0 was good last";
  await page.route("**/adit/update", async (route) => {
    const answer = await route.fetch();
    await route.fulfill({ response: answer, json: { ...(await answer.json()), stray } });
  });
  await line(page, "update").filter({ hasText: "An unexpected slot is running" }).waitFor();
  await page.getByRole("button", { name: "Go back" }).waitFor();
  assert.deepEqual(await opened(page), ["update"]);
  await card(page, "update").locator("summary").click();
  const asked = () => page.waitForResponse((answer) => answer.url().endsWith("/adit/update"));
  await asked();
  await asked();
  assert.equal(await isOpen(page, "update"), false, "the operator closed it");
  stray = null;
  await line(page, "update").filter({ hasText: "Slot A" }).waitFor();
  stray = "another one";
  await page.getByRole("button", { name: "Go back" }).waitFor();
});

test("names a cable that is out, and opens the network", async (t) => {
  const port = (side, carrier) => ({ side, interface: "eth0", carrier, mbit: 1000, duplex: "full", addresses: ["10.0.0.1/24"], name: "adit.local", mac: "00:11:22:33:44:55" });
  const ports = [port("team", true), port("command_post", true)];
  const { page } = await closed(t);
  await page.route("**/adit/network", async (route) => {
    const answer = await route.fetch();
    await route.fulfill({ response: answer, json: { ...(await answer.json()), ports } });
  });
  await line(page, "network").filter({ hasText: /^\s*Both cables in$/ }).waitFor();
  assert.equal(await isOpen(page, "network"), false);
  ports[1].carrier = false;
  await line(page, "network").filter({ hasText: "Command Post’s side: no cable" }).waitFor();
  assert.equal(await isOpen(page, "network"), true);
});

test("opens the card that the address names", async (t) => {
  const { page } = await closed(t);
  await page.goto(new URL("/system#spare", page.url()).href);
  await page.waitForFunction(() => document.querySelector("#spare > .card").open);
  await page.evaluate(() => (location.hash = "#about"));
  await page.waitForFunction(() => document.querySelector("#about > .card").open);
  assert.deepEqual(await opened(page), ["spare", "about"]);
});

test("counts the others that are logged in", async (t) => {
  const { stage, page } = await closed(t);
  await line(page, "sessions").filter({ hasText: "No one else" }).waitFor();
  await come(t, VIEWER, { stage });
  await line(page, "sessions").filter({ hasText: /^\s*1 other is logged in$/ }).waitFor();
});
