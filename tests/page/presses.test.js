// What opens or moves under a finger does not take that finger's press, nor the second one of a double tap: by real touches,
// from which the browser itself makes its clicks.
import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "./box.js";
import { canvas } from "./pictures.js";
import { settled, watch } from "./watch.js";

const PHONE = { hasTouch: true, viewport: { width: 390, height: 844 } };
const DIALOG = "#compose";

/** What touches the page: fingers, each at its place, or a mouse or pen. */
async function glass(page) {
  const devtools = await page.context().newCDPSession(page);
  const send = (type, touchPoints) => devtools.send("Input.dispatchTouchEvent", { type, touchPoints });
  const down = (...places) => send("touchStart", places.map(([x, y], id) => ({ x, y, id })));
  const up = () => send("touchEnd", []);
  const tap = async (...places) => {
    await down(...places);
    await up();
  };
  const point = (pointerType) => async ([x, y]) => {
    const at = { x, y, pointerType, button: "left", clickCount: 1 };
    await devtools.send("Input.dispatchMouseEvent", { ...at, type: "mousePressed" });
    await devtools.send("Input.dispatchMouseEvent", { ...at, type: "mouseReleased" });
  };
  return { down, up, tap, mouse: point("mouse"), pen: point("pen") };
}

/** Everything that a dialog does has been done. */
const quiet = async (page) => {
  await page.waitForTimeout(100);
  await settled(page);
};

/** What a finger has pressed in the dialog that opened under it; "" where nothing was. */
const pressed = (page) =>
  page.evaluate((dialog) => {
    const node = document.querySelector(dialog);
    if (!node.open) return "it was closed";
    if (node.querySelector(".fields").hidden) return "it was checked";
    const { value } = node.querySelector("input[name=type]:checked");
    if (value !== "Drill") return `it became ${value}`;
    return document.activeElement.matches("input[type=text]") ? "a field took the keyboard" : "";
  }, DIALOG);

/** A report of a Drill is composed, and its place about to be picked. */
async function picking(t, options) {
  const { page } = await watch(t, "calm", options);
  await page.locator("#reports .compose:enabled").click();
  await page.getByRole("radio", { name: "Drill", exact: true }).check();
  await page.fill(`${DIALOG} input[name=z]`, "0.5");
  return page;
}
async function reopen(page) {
  if (await page.locator("#map .hint").isVisible()) await page.keyboard.press("Escape");
  await page.keyboard.press("Escape");
  await page.waitForSelector(DIALOG, { state: "hidden" });
  await page.locator("#reports .compose").click();
  await page.getByRole("radio", { name: "Drill", exact: true }).check();
}
async function pickNow(page) {
  await page.locator(`${DIALOG} .pick`).click();
  await page.waitForSelector("#map .hint:not([hidden])");
  await settled(page);
  await page.waitForSelector("[data-moving]", { state: "detached" });
}

/** Places on the map, as it is while one is picked, under which the open dialog has something to press. */
async function placesUnder(page) {
  const boxes = await page.$$eval(`${DIALOG} label, ${DIALOG} button`, (nodes) =>
    nodes.map((node) => node.getBoundingClientRect()).map(({ x, y, width, height }) => [x + width / 2, y + height / 2]));
  await pickNow(page);
  const places = await page.evaluate((boxes) => boxes.filter(([x, y]) => document.elementFromPoint(x, y)?.closest("#map .frame canvas")), boxes);
  await page.getByRole("button", { name: "Cancel" }).click();
  assert.ok(places.length >= 10, `${places.length} places`);
  return places.slice(0, 10);
}

/** Picks each of the places by `touch`; what was pressed thereby that should not have been. */
async function pickEach(page, places, touch) {
  const wrong = [];
  for (const place of places) {
    await pickNow(page);
    await touch(place);
    await quiet(page);
    const what = await pressed(page);
    if (!what) continue;
    wrong.push(what);
    await reopen(page);
  }
  return wrong;
}

test("a tap that picks a place on the map presses nothing of the dialog that opens under it", async (t) => {
  const page = await picking(t, PHONE);
  const { tap } = await glass(page);
  assert.deepEqual(await pickEach(page, await placesUnder(page), tap), []);
});

test("nor does a slow finger, a double tap, a mouse, a pen or a key that is held", async (t) => {
  const page = await picking(t, PHONE);
  const { down, up, tap, mouse, pen } = await glass(page);
  const places = await placesUnder(page);
  const touches = {
    slow: async (place) => { await down(place); await page.waitForTimeout(300); await up(); },
    double: async (place) => { await tap(place); await tap(place); },
    mouse, pen,
    key: async () => { for (let i = 0; i < 4; ++i) await page.keyboard.down("Enter"); await page.keyboard.up("Enter"); },
  };
  for (const [name, touch] of Object.entries(touches)) assert.deepEqual(await pickEach(page, places.slice(3, 5), touch), [], name);
});

test("a finger that is down while a dialog opens by another hand does not press it", async (t) => {
  const page = await picking(t, PHONE);
  const { down, up } = await glass(page);
  const [place] = await placesUnder(page);
  await page.keyboard.press("Escape");
  await page.waitForSelector(DIALOG, { state: "hidden" });
  await down(place);
  await page.locator("#reports .compose").evaluate((button) => button.click());
  await page.waitForTimeout(400); // the dialog stands still by then, and it is not a long press yet
  await up();
  await quiet(page);
  assert.equal(await pressed(page), "");
});

test("the second tap on what closes a dialog does not go through to the map, and two fingers pick nothing", async (t) => {
  const page = await picking(t, PHONE);
  const { tap } = await glass(page);
  const [one, other] = await placesUnder(page);
  await pickNow(page);
  const canPick = async () => {
    await quiet(page);
    return page.locator("#map .hint").isVisible();
  };
  await tap(one, other);
  assert.ok(await canPick(), "after two fingers");
  await page.getByRole("button", { name: "Cancel" }).click();
  const { x, y, width, height } = await page.locator(`${DIALOG} .pick`).boundingBox();
  const place = [x + width / 2, y + height / 2];
  await page.waitForFunction(([x, y]) => document.elementFromPoint(x, y)?.matches(".pick"), place);
  await tap(place);
  await tap(place);
  assert.ok(await canPick(), "after a double tap");
});

test("what moves under a finger is not pressed by it, and is once it has stood still", async (t) => {
  const { page } = await watch(t, "calm", PHONE);
  const { down, up, tap } = await glass(page);
  const button = page.locator("#reports .compose:enabled");
  await button.evaluate((node) => node.scrollIntoView({ block: "center" }));
  await page.waitForTimeout(400);
  /** The whole page, which holds still otherwise, goes down by 100 pixels; gives where the button is then. */
  const shift = () => button.evaluate((node) => {
    const space = document.createElement("div");
    space.style.height = "100px";
    document.body.style.overflowAnchor = "none";
    document.querySelector("main").prepend(space);
    const { x, y, width, height } = node.getBoundingClientRect();
    return [x + width / 2, y + height / 2];
  });
  const isOpen = async () => {
    await quiet(page);
    return page.locator(DIALOG).isVisible();
  };
  const { x, y, width, height } = await button.boundingBox();
  const next = [x + width / 2, y + height / 2 + 100];
  await down(next);
  await shift();
  await up();
  assert.ok(!(await isOpen()), "it came under the finger");
  await tap(await shift());
  assert.ok(!(await isOpen()), "it had just come there");
  const place = await shift();
  await page.waitForFunction(([x, y]) => document.elementFromPoint(x, y)?.matches(".compose"), place);
  await tap(place);
  assert.ok(await isOpen(), "it stood still");
});

test("what was under the finger as it came down is pressed, also where the page moves before it is lifted", async (t) => {
  const { page } = await watch(t, "calm", PHONE);
  const { down, up } = await glass(page);
  const button = page.locator("#reports .compose:enabled");
  const touch = { down, up, drag: async () => {} };
  const mouse = { down: async ([x, y]) => { await page.mouse.move(x, y); await page.mouse.down(); }, up: () => page.mouse.up(), drag: (x, y) => page.mouse.move(x, y) };
  for (const [name, hand] of Object.entries({ touch, mouse })) {
    for (const [moves, isMeant] of [["away", true], ["hidden", false], ["dragged", false]]) {
      if (name === "touch" && moves === "dragged") continue; // that scrolls
      await button.evaluate((node) => node.scrollIntoView({ block: "center" }));
      await page.waitForFunction(() => !document.querySelector("[data-moving]"));
      const { x, y, width, height } = await button.boundingBox(), place = [x + width / 2, y + height / 2];
      await hand.down(place);
      if (moves === "dragged") await hand.drag(place[0], place[1] - 100);
      else await button.evaluate((node, moves) => {
        if (moves === "hidden") node.hidden = true;
        else node.style.translate = "0 100px";
      }, moves);
      await hand.up();
      await quiet(page);
      assert.equal(await page.locator(DIALOG).isVisible(), isMeant, `${name}: ${moves}`);
      if (isMeant) await page.keyboard.press("Escape");
      await page.locator("#reports .compose").evaluate((node) => Object.assign(node, { hidden: false, style: "" }));
    }
  }
});

test("a question that opens over a dialog takes no press at once, wherever it stands in the page", async (t) => {
  const { page } = await watch(t, "calm");
  const moving = await page.evaluate(async () => {
    const [first, last] = document.querySelectorAll("dialog"), seen = [];
    const after = async (done) => {
      done();
      await Promise.resolve(); // presses.js was told
      seen.push([first, last].map((dialog) => [...dialog.querySelectorAll("button")].some(({ dataset }) => "moving" in dataset)));
      for (const node of document.querySelectorAll("[data-moving]")) delete node.dataset.moving;
    };
    await after(() => last.showModal());
    await after(() => first.showModal());
    await after(() => first.close());
    await after(() => last.close());
    return seen;
  });
  assert.deepEqual(moving, [[false, true], [true, false], [false, true], [false, false]]);
});
