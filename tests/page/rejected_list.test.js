// The list of rejected messages, on a phone and for a screen reader.
import assert from "node:assert/strict";
import { test } from "node:test";
import { retell } from "./retold.js";
import { armed, axeFindsNothing, openMore, text, watch } from "./watch.js";

const WHY = "msg.data: expected 4800 cells for a width of 80 and a height of 60, got 4799, and the last row is cut short";
const ROWS = [7, 8, 9].map((number) =>
  ({ number, kind: "cloud", robot: `ANYmal${number}`, at: Date.now() / 1000 - 40, status: 422, why: WHY, bytes: 412_000, replaced: number === 8 }));

/** A page whose box rejected the messages in the page's `globalThis.rejectedRows`, `its` at first. */
async function withRows(t, { its = ROWS, ...options } = {}) {
  const prepare = (page) => retell(page, (rows) => {
    globalThis.rejectedRows = rows;
    return (view) => ({ ...view, rejected: globalThis.rejectedRows });
  }, its);
  const { page } = await watch(t, "calm", { prepare, ...options });
  await openMore(page);
  await page.locator("#rejected .why").first().waitFor();
  return page;
}

/** Changes the rows that the box reports from now on. */
const become = (page, rows) => page.evaluate((rows) => (globalThis.rejectedRows = rows), rows);
const discard = (page, number) => page.getByRole("button", { name: `Discard: ${number}`, exact: true });
const hasFocus = (page, number) =>
  page.waitForFunction((number) => document.activeElement.matches(`#rejected li[data-key="${number}"] .discard`), number);

const boxes = (page, part) =>
  page.$$eval(`#rejected li:first-child ${part}`, (nodes) => nodes.map((node) => node.getBoundingClientRect().toJSON()));

for (const [name, width] of [["a phone", 360], ["a narrow column", 1056]]) {
  test(`gives the sentence the whole width on ${name}, and the buttons a line below it`, async (t) => {
    const page = await withRows(t, { viewport: { width, height: 740 } });
    const [row] = await boxes(page, ""), [why] = await boxes(page, ".why"), [what] = await boxes(page, ".what");
    assert.ok(why.width > 0.95 * row.width, `${why.width} of ${row.width} pixels`);
    assert.ok(what.width > 0.95 * row.width, `${what.width} of ${row.width} pixels`);
    const buttons = await boxes(page, "button");
    assert.equal(buttons.length, 2);
    for (const button of buttons) assert.ok(button.top >= why.bottom && button.right <= row.right);
    assert.equal(buttons[0].top, buttons[1].top);
  });
}

test("keeps the buttons beside the sentence if there is room", async (t) => {
  const page = await withRows(t, { viewport: { width: 880, height: 740 } });
  const [why] = await boxes(page, ".why");
  for (const button of await boxes(page, "button")) assert.ok(button.left >= why.right);
});

test("names each button by its row, and counts messages that no newer one replaced", async (t) => {
  const page = await withRows(t, { bypassCSP: true });
  for (const { number } of ROWS) {
    for (const word of ["Send again", "Discard"]) assert.equal(await page.getByRole("button", { name: `${word}: ${number}`, exact: true }).count(), 1);
  }
  assert.equal(await text(page, "#rejected .count"), "2");
  await axeFindsNothing(page, "what is rejected");
});

test("shows no status of a map that was put aside", async (t) => {
  const why = "the service ended 3 times by a fault while it packed this map";
  const page = await withRows(t);
  await become(page, [{ ...ROWS[0], status: 0, why }]);
  await page.locator("#rejected .why").filter({ hasText: why }).waitFor();
  assert.equal(await text(page, "#rejected .why"), why);
});

test("hides its title with the last row, and the result after a time to read it", async (t) => {
  const page = await withRows(t);
  await page.route("**/adit/rejected/*/discard", async (route) => {
    await page.evaluate(() => (globalThis.rejectedRows = []));
    await route.fulfill({ json: { rejected: 7 } });
  });
  await page.getByRole("button", { name: "Discard: 7" }).click();
  await page.locator("#rejected .said", { hasText: "7 is discarded." }).waitFor();
  await page.locator("#rejected-title").waitFor({ state: "hidden" });
  await page.locator("#rejected").waitFor({ state: "hidden" });
  assert.equal(await text(page, "#rejected .said"), "");
});

test("keeps the focus in its row while other rows come and go", async (t) => {
  const page = await withRows(t);
  await page.evaluate(() => {
    globalThis.lost = 0;
    document.getElementById("rejected").addEventListener("focusout", () => ++globalThis.lost);
  });
  await discard(page, 9).focus();
  await become(page, [{ ...ROWS[0], number: 6, robot: "six" }, ROWS[2], { ...ROWS[0], number: 11, robot: "eleven" }]);
  await page.locator('#rejected li[data-key="11"]').waitFor();
  assert.equal(await page.locator("#rejected li").count(), 3);
  await hasFocus(page, 9);
  assert.equal(await page.evaluate(() => globalThis.lost), 0, "the focus was lost for a moment");
});

test("moves the focus of a row that another operator discards to the next row, the one before, or the title", async (t) => {
  const page = await withRows(t);
  await discard(page, 8).focus();
  await become(page, [ROWS[0], ROWS[2]]);
  await hasFocus(page, 7);
  await become(page, [ROWS[2]]);
  await hasFocus(page, 9);
  await become(page, []);
  await page.waitForFunction(() => document.activeElement.id === "post-title");
});

test("a key that is pressed twice discards only one row", async (t) => {
  const page = await withRows(t);
  await page.evaluate(() => {
    const press = (node) => node.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true, cancelable: true }));
    globalThis.pressNow = () => press(document.activeElement);
    document.addEventListener("focusin", ({ target }) => (globalThis.atOnce = press(target)));
  });
  await discard(page, 7).focus();
  assert.equal(await page.evaluate(() => globalThis.atOnce), true, "a user who moves the focus sees the new rows at once");
  await become(page, ROWS.slice(1));
  await hasFocus(page, 8);
  assert.equal(await page.evaluate(() => globalThis.atOnce), false);
  await page.waitForFunction(() => globalThis.pressNow());
});

const OTHER = "Internal Server Error";
/** 59 messages of three senders, for two reasons; the newest is the last. */
const MANY = Array.from({ length: 59 }, (_, i) => ({
  ...ROWS[0], number: 100 + i, kind: i % 2 ? "grid" : "cloud", robot: i === 58 ? "alone" : `ugv${1 + (i % 2)}`, at: ROWS[0].at + i / 10, ...(i % 10 === 0 && { status: 500, why: OTHER }),
}));
const groups = (page) => page.locator("#rejected .rows > li");
const groupOf = (page, words) => page.locator("#rejected .rows > .group", { hasText: words });
const dialog = (page) => page.locator("#confirm");
const answer = async (page, name) => {
  await armed(page);
  await dialog(page).getByRole("button", { name, exact: true }).click();
};

/** A box that discards what it is told to: its rows are `globalThis.rejectedRows`. Gives the numbers of the POSTs. */
async function discards(page, { failing = () => null } = {}) {
  const posted = [];
  await page.route("**/adit/rejected/*/discard", async (route) => {
    const number = Number(/rejected\/(\d+)/.exec(route.request().url())[1]), failure = failing(number);
    posted.push(number);
    if (failure) return route.fulfill(failure);
    await page.evaluate((number) => (globalThis.rejectedRows = globalThis.rejectedRows.filter((row) => row.number !== number)), number);
    await route.fulfill({ json: { rejected: number } });
  });
  return posted;
}

test("has one row for a sender and a reason, with the newest first, and its messages on demand", async (t) => {
  const page = await withRows(t, { its: MANY, bypassCSP: true });
  const rows = (await groups(page).allInnerTexts()).map((text) => text.replace(/\s+/g, " "));
  assert.equal(rows.length, 4);
  assert.match(rows[0], /^158: cloud of alone, 412 kB .* Send again Discard$/);
  assert.match(rows[1], /^ugv2: 29 messages \(grid\), 12 MB newest .* ago 422: msg\.data.* Show Discard all$/);
  assert.match(rows[2], /^ugv1: 23 messages \(cloud\), 9\.5 MB newest /);
  assert.match(rows[3], /^ugv1: 6 messages \(cloud\), 2\.5 MB newest .* 500: Internal Server Error/);
  assert.equal(await text(page, "#rejected .count"), "59");
  await axeFindsNothing(page, "groups");

  const group = groupOf(page, OTHER), open = group.locator(".opens");
  assert.match(await open.getAttribute("aria-label"), /^Show the 6 messages of ugv1: 500: Internal/);
  assert.equal(await group.locator(".singles li").first().isVisible(), false);
  await open.focus();
  await page.keyboard.press("Enter");
  await group.locator(".singles li").nth(5).waitFor();
  assert.equal(await open.getAttribute("aria-expanded"), "true");
  assert.deepEqual((await group.locator(".singles .what").allInnerTexts()).map((what) => Number(what.split(":")[0])), [150, 140, 130, 120, 110, 100]);
  await axeFindsNothing(page, "single messages");
  const posted = await discards(page);
  await discard(page, 140).click();
  await page.locator('#rejected li[data-key="140"]').waitFor({ state: "detached" });
  assert.deepEqual(posted, [140]);
  assert.ok(await group.locator(".singles li").first().isVisible(), "it stays open");
});

test("discards a group after one question that says its number, but no message that came since", async (t) => {
  const page = await withRows(t, { its: MANY }), posted = await discards(page);
  await groupOf(page, OTHER).getByRole("button", { name: /^Discard all 6 messages of ugv1/ }).click();
  await dialog(page).getByText("Discard 6 messages of ugv1?").waitFor();
  await answer(page, "Cancel");
  assert.deepEqual(posted, []);

  await groupOf(page, OTHER).getByRole("button", { name: /^Discard all/ }).click();
  await become(page, [...MANY, { ...MANY[50], number: 200 }]);
  await groupOf(page, "ugv1: 7 messages").waitFor();
  await answer(page, "Discard 6");
  await page.locator("#rejected .said", { hasText: /^6 of 6 are discarded\.$/ }).waitFor();
  assert.deepEqual(posted, [150, 140, 130, 120, 110, 100]);
  await page.locator('#rejected .rows > li[data-key="200"]').waitFor();
  assert.equal(await groups(page).count(), 4);
  assert.deepEqual(page.complaints, []);
});

test("goes on where another operator discarded one, and stops at a failure", async (t) => {
  const page = await withRows(t, { its: MANY });
  const failures = { 140: { status: 404, json: "There is no rejected message 140." }, 120: { status: 503, json: "The disk is full." } };
  const posted = await discards(page, { failing: (number) => failures[number] });
  const all = () => groupOf(page, OTHER).getByRole("button", { name: /^Discard all/ }).click();
  await all();
  await answer(page, "Discard 6");
  await page.locator("#rejected .said", { hasText: "2 of 6 are discarded. The disk is full." }).waitFor();
  assert.deepEqual(posted, [150, 140, 130, 120]);
  delete failures[120];
  await groupOf(page, "ugv1: 4 messages").waitFor();
  await all();
  await answer(page, "Discard 4");
  await page.locator("#rejected .said", { hasText: "3 of 4 are discarded; the others were gone." }).waitFor();
  assert.deepEqual(posted.slice(4), [140, 120, 110, 100]);
});
