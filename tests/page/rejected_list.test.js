// The list of rejected messages, on a phone and for a screen reader.
import assert from "node:assert/strict";
import { test } from "node:test";
import { retell } from "./retold.js";
import { axeFindsNothing, openMore, text, watch } from "./watch.js";

const WHY = "msg.data: expected 4800 cells for a width of 80 and a height of 60, got 4799, and the last row is cut short";
const ROWS = [7, 8, 9].map((number) =>
  ({ number, kind: "cloud", robot: "ANYmal1", at: Date.now() / 1000 - 40, status: 422, why: WHY, bytes: 412_000, replaced: number === 8 }));

/** A page whose box rejected the messages in the page's `globalThis.rejectedRows`. */
async function withRows(t, options) {
  const prepare = (page) => retell(page, (rows) => {
    globalThis.rejectedRows = rows;
    return (view) => ({ ...view, rejected: globalThis.rejectedRows });
  }, ROWS);
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
  await become(page, [{ ...ROWS[0], number: 6 }, ROWS[2], { ...ROWS[0], number: 11 }]);
  await page.locator('#rejected li[data-key="11"]').waitFor();
  assert.equal(await page.locator("#rejected li").count(), 3);
  await hasFocus(page, 9);
  assert.equal(await page.evaluate(() => globalThis.lost), 0, "the focus was lost for a moment");
});

test("moves the focus of a row that another operator discards to the next row, the one before, or the title", async (t) => {
  const page = await withRows(t);
  await discard(page, 8).focus();
  await become(page, [ROWS[0], ROWS[2]]);
  await hasFocus(page, 9);
  await become(page, [ROWS[0]]);
  await hasFocus(page, 7);
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
