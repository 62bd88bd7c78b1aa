// Composing a report: type, place, check, send.
import assert from "node:assert/strict";
import { test } from "node:test";
import { axeFindsNothing, settled, text, toTab, watch } from "./watch.js";

const TYPES = ["Survivor", "Cell Phone", "Backpack", "Drill", "Fire Extinguisher", "Gas", "Vent", "Helmet", "Rope", "Cube"];
const canvas = "#map .frame canvas";

/** Opens the form by its key, which works only once the page knows the user's role. */
const compose = async (page) => {
  await page.waitForSelector("#reports .compose:enabled", { state: "attached" });
  await page.keyboard.press("n");
  await page.waitForSelector("#compose:not([hidden])");
};
const choose = (page, type) => page.locator("#compose .types").getByRole("button", { name: type, exact: true }).click();
const place = async (page, x, y, z) => {
  for (const [axis, value] of Object.entries({ x, y, z })) await page.fill(`#compose input[name=${axis}]`, value);
};
const check = (page) => page.getByRole("button", { name: "Check" }).click();
const fill = async (page, type, ...where) => {
  await choose(page, type);
  await place(page, ...where);
  await check(page);
};
const send = (page) => page.locator("#compose .send").click();
const becomes = (page, number, words) =>
  page.waitForFunction(([number, words]) => document.querySelector(`#reports li[data-key="${number}"]`)?.innerText.includes(words), [number, words]);

test("composes a report: type, place, a check for near ones, and sends it", async (t) => {
  const { page } = await watch(t, "reports");
  await page.getByRole("button", { name: "New report" }).click();
  assert.deepEqual(await page.locator("#compose .types button").allTextContents(), TYPES);
  await fill(page, "Gas", "306", "-3.5", "0.25");
  assert.match(await text(page, "#compose .summary"), /Gas.*at 306\.0, −3\.5, 0\.3 m/);
  assert.equal(await page.locator("#compose .summary svg").count(), 1);
  assert.match(await text(page, "#compose .notes"), /#25 Gas is 1\.0 m away.*#24 Gas is 1\.0 m away.*Uses up 1 of the 18 reports left\./);
  assert.equal(await text(page, "#compose .send"), "Send Gas");
  assert.ok(await page.locator("#compose .again").isHidden());
  await send(page);
  await becomes(page, 29, "queued");
  await becomes(page, 29, "Accepted.");
  await page.waitForFunction(() => document.activeElement.closest("li")?.dataset.key === "29");
  assert.deepEqual(page.complaints, []);
});

test("replaces the list of reports, never the map, and moves neither", async (t) => {
  for (const viewport of [{ width: 1280, height: 720 }, { width: 1920, height: 1080 }]) {
    const { page } = await watch(t, "reports", { viewport });
    const boxes = () => page.evaluate(() => [".strip", ".alarms", "#map .frame", "#maps", "#link-plots"].map((part) => JSON.stringify(document.querySelector(part).getBoundingClientRect())));
    const before = await boxes(), reports = await page.locator("#reports").boundingBox();
    await compose(page);
    assert.deepEqual(await page.locator("#compose").boundingBox(), reports);
    await choose(page, "Rope");
    assert.deepEqual(await boxes(), before);
    await place(page, "1", "2", "3");
    await check(page);
    assert.deepEqual(await boxes(), before);
    await page.getByRole("button", { name: "Cancel" }).click();
    await page.waitForSelector("#reports:not([hidden])");
    assert.deepEqual(await boxes(), before);
  }
});

test("says how far the nearest report of that type is, if none is near", async (t) => {
  const { page } = await watch(t, "reports");
  await compose(page);
  await fill(page, "Drill", "343", "-104.5", "0.25");
  assert.match(await text(page, "#compose .notes"), /No other Drill within 5 m: the nearest is #28, 100 m away\./);
  const gaps = await page.$$eval("#compose .notes li", (notes) => notes.map(({ firstChild, lastChild }) => lastChild.getBoundingClientRect().left - firstChild.getBoundingClientRect().right));
  for (const gap of gaps) assert.ok(gap >= 4, `${gaps}: a shape stands beside its words, not in them`);
});

test("names the wrong field and focuses it", async (t) => {
  const { page } = await watch(t, "reports");
  await compose(page);
  await choose(page, "Rope");
  for (const [axis, wrong] of [["x", ""], ["x", "1,2,5"], ["y", "left"], ["z", "1e3"], ["z", "."]]) {
    await place(page, "1", "2", "3");
    await page.fill(`#compose input[name=${axis}]`, wrong);
    await check(page);
    assert.match(await text(page, "#compose .trouble"), new RegExp(`^${axis}: expected metres`), wrong);
    assert.equal(await page.evaluate(() => document.activeElement.name), axis);
    assert.equal(await page.getAttribute(`#compose input[name=${axis}]`, "aria-invalid"), "true");
  }
});

test("says that the same report exists, and sends it again only if confirmed", async (t) => {
  const { page } = await watch(t, "reports");
  await compose(page);
  await fill(page, "Helmet", "281,75", "−4.5", ".25");
  assert.match(await text(page, "#compose .notes"), /Already reported at the same place: #23 Helmet, scored \+1/);
  await send(page);
  await becomes(page, 23, "The box has the same report already: this one.");
  assert.equal(await page.locator("#reports li[data-key='29']").count(), 0);

  await page.locator("#reports .compose").click();
  await fill(page, "Helmet", "281.75", "-4.5", "0.25");
  await page.locator("#compose .again").click();
  await send(page);
  await becomes(page, 29, "queued");
});

test("shows the box's sentence if the report was rejected, and keeps the input", async (t) => {
  const { page } = await watch(t, "reports");
  await compose(page);
  await fill(page, "Cube", "666", "0", "0");
  await send(page);
  await page.waitForFunction(() => document.querySelector("#compose .trouble").textContent.includes("this report was not accepted"));
  await page.getByRole("button", { name: "Place", exact: true }).click();
  assert.equal(await page.inputValue("#compose input[name=x]"), "666");
  await page.getByRole("button", { name: "Cancel" }).click();
  await page.locator("#compose").waitFor({ state: "hidden" });
  await compose(page);
  await choose(page, "Cube");
  assert.equal(await page.inputValue("#compose input[name=x]"), "", "a cancelled report is discarded");
});

/** Keeps ANYmal2, which stands at 52, -14 far from all tracks, in the middle of the map. Returns `tap(x, y)` in metres. */
async function aim(page) {
  await page.selectOption("#map .follow select", "ANYmal2");
  await settled(page);
  const { width, height } = await page.locator(canvas).boundingBox();
  const at = (right, down) => page.locator(canvas).tap({ position: { x: width / 2 + right, y: height / 2 + down } });
  const y = async () => Number(await page.inputValue("#compose input[name=y]"));
  await at(0, 40);
  const scale = 40 / (-14 - (await y()));  // pixels per metre
  return (x, y) => at((x - 52) * scale, (-14 - y) * scale);
}
const z = (page) => page.inputValue("#compose input[name=z]");

/** A report whose place is being picked, on a phone. */
async function placeByTouch(t) {
  const { page } = await watch(t, "calm", { viewport: { width: 390, height: 844 }, hasTouch: true, bypassCSP: true });
  await toTab(page, "Reports");
  await page.locator("#reports .compose").tap();
  await choose(page, "Vent");
  return { page, tap: await aim(page) };
}

test("takes the height from the tracks at the place, by touch, and says how it was found", async (t) => {
  const { page, tap } = await placeByTouch(t);
  assert.equal(await z(page), "");
  assert.equal(await text(page, "#compose .height"), "No data within 5 m of this place: type z.");
  await check(page);
  assert.match(await text(page, "#compose .trouble"), /^z: expected metres/);
  assert.equal(await page.evaluate(() => document.activeElement.name), "z");
  await axeFindsNothing(page, "no height");

  await tap(52, -14);
  await page.locator("#compose .check").waitFor();
  assert.match(await text(page, "#compose .notes li"), /^z 0\.3 m from ANYmal2’s track, [01]\.\d m away, (now|\d+ s ago)\.$/);
  await page.getByRole("button", { name: "Place", exact: true }).tap();
  await tap(52, -34);
  assert.equal(await z(page), "", "the height of the earlier place must go");
  await tap(52, -17.5);
  await page.locator("#compose .notes li", { hasText: /^z 0\.3 m from ANYmal2’s track, [34]\.\d m away, .*: check it\.$/ }).waitFor();

  await page.getByRole("button", { name: "Place", exact: true }).tap();
  await page.fill("#compose input[name=x]", "60");
  assert.equal(await z(page), "", "a typed place has no height from the earlier place");
  await page.fill("#compose input[name=z]", "2");
  await check(page);
  assert.equal(await text(page, "#compose .notes li"), "z typed.");
  await axeFindsNothing(page, "check");
});

test("lets the operator choose where two levels cross", async (t) => {
  const { page, tap } = await placeByTouch(t);
  await tap(52, 49);
  await page.getByText("The heights within 5 m of this place differ: choose one, or type z.").waitFor();
  assert.equal(await z(page), "");
  const heights = page.getByRole("group", { name: "Heights at this place" }).getByRole("button");
  assert.deepEqual((await heights.allTextContents()).map((words) => words.replace(/ track.*/, "")), ["z 0.0 m from ANYmal1’s", "z 4.0 m from Scout’s"]);
  await axeFindsNothing(page, "two heights");
  await heights.last().tap();
  await page.locator("#compose .notes li", { hasText: /^z 4\.0 m from Scout’s track/ }).waitFor();
  assert.match(await text(page, "#compose .summary"), /4\.0 m/);
});

test("takes a place by keyboard, and asks for z before the tracks have loaded", async (t) => {
  let release;
  const held = new Promise((resolve) => (release = resolve));
  const { page } = await watch(t, "calm", { prepare: (page) => page.route("**/adit/tracks", (route) => held.then(() => route.continue())) });
  await compose(page);
  await choose(page, "Vent");
  await page.selectOption("#map .follow select", "ANYmal2");
  await page.locator(canvas).press("Enter");
  await page.getByText("The robots’ tracks have not loaded: type z, or tap again.").waitFor();
  const first = await page.inputValue("#compose input[name=x]");
  assert.notEqual(first, "");
  release();
  await settled(page);
  for (let i = 0; i < 3; ++i) await page.locator(canvas).press("ArrowRight");
  await page.keyboard.press("Enter");
  assert.notEqual(await page.inputValue("#compose input[name=x]"), first);
  await page.keyboard.press("Escape");
  await page.locator("#compose").waitFor({ state: "hidden" });
  await compose(page);
  assert.notEqual(await page.inputValue("#compose input[name=x]"), "", "a closed form keeps its input");
});

test("sends the checked report: a tap on the map then changes nothing", async (t) => {
  const { page } = await watch(t, "reports");
  await compose(page);
  await fill(page, "Gas", "306", "-3.5", "0.25");
  await page.locator(canvas).click({ position: { x: 200, y: 150 } });
  assert.match(await text(page, "#compose .summary"), /Gas.*at 306\.0, −3\.5, 0\.3 m/);
  await page.getByRole("button", { name: "Place", exact: true }).click();
  await page.locator(canvas).click({ position: { x: 200, y: 150 } });
  assert.notEqual(await page.inputValue("#compose input[name=x]"), "306");
  assert.equal(await z(page), "", "the typed height belongs to the earlier place");
});

test("shows map and fields together on a phone, in every step", async (t) => {
  const { page } = await watch(t, "reports", { viewport: { width: 390, height: 844 }, hasTouch: true });
  await toTab(page, "Reports");
  await page.locator("#reports .compose").tap();
  const map = await page.locator(canvas).boundingBox();
  assert.ok(map.width > 300 && map.height > 150, JSON.stringify(map));
  await choose(page, "Gas");
  assert.deepEqual(await page.locator(canvas).boundingBox(), map);
  await place(page, "306", "-3.5", "0.25");
  await check(page);
  assert.deepEqual(await page.locator(canvas).boundingBox(), map);
  const button = await page.locator("#compose .send").boundingBox();
  assert.ok(button.y + button.height <= 844 && button.height >= 44, JSON.stringify(button));
});

test("has no axe fault in its steps and dialogs", async (t) => {
  const { page } = await watch(t, "reports", { bypassCSP: true });
  const isWell = async (what, themes = ["dark"]) => {
    for (const theme of themes) {
      await page.evaluate((theme) => (document.documentElement.dataset.theme = theme), theme);
      await page.waitForSelector("[data-moving]", { state: "detached" });
      await axeFindsNothing(page, `${what}, ${theme}`);
    }
  };
  await compose(page);
  await isWell("what");
  await choose(page, "Helmet");
  await place(page, "281.75", "-4.5", "0.25");
  await isWell("where");
  await check(page);
  await isWell("check", ["dark", "light", "red"]);
  await page.keyboard.press("Escape");
  await page.keyboard.press("?");
  await page.waitForSelector("#help[open]");
  await isWell("help");
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Send again: report 25" }).click();
  await page.waitForSelector("#confirm[open]");
  await isWell("confirm", ["dark", "light", "red"]);
  await page.keyboard.press("Escape");
  await page.locator(".strip .menu").click();
  await isWell("more");
});
