// An element that opens or moves under a finger takes neither that finger's press nor the second tap of a double tap. The tests use real
// touches, from which the browser makes clicks.
import assert from "node:assert/strict";
import { test } from "node:test";
import { canvas } from "./pictures.js";
import { armed, settled, toTab, watch } from "./watch.js";

const PHONE = { hasTouch: true, viewport: { width: 390, height: 844 } };
const DIALOG = "#help";

/** Input devices: fingers at their places, a mouse, a pen. */
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

/** The state of the report form. */
const composed = (page) => page.evaluate(() => {
  const panel = document.getElementById("compose");
  return { open: !panel.hidden, type: panel.querySelector(".count").textContent, pressed: panel.querySelector(".types [aria-pressed=true]")?.textContent ?? "",
    x: panel.querySelector("input[name=x]").value, typing: document.activeElement.matches("input[type=text]") };
});

/** A Drill is being composed, and its place is about to be picked. */
async function picking(t, options) {
  const { page } = await watch(t, "calm", options);
  await toTab(page, "Reports");
  await page.locator("#reports .compose:enabled").click();
  await page.locator("#compose .types").getByRole("button", { name: "Drill", exact: true }).click();
  await page.fill("#compose input[name=z]", "0.5");
  await page.locator("#compose h2").focus();
  await settled(page);
  return page;
}

/** Places all over the map at which a finger hits only the map. */
const placesOn = (page, count) => page.$eval(canvas, (node, count) => {
  const { x, y, width, height } = node.getBoundingClientRect(), places = [];
  for (let i = 0; places.length < count && i < 1000; ++i) {
    const place = [x + width * ((i * 0.618034) % 1), y + height * ((i * 0.754877) % 1)].map(Math.round);
    if (document.elementFromPoint(...place) === node) places.push(place);
  }
  return places;
}, count);

/** Picks each place with `touch`. Returns the states after picks that changed more than the place. */
async function pickEach(page, places, touch) {
  const wrong = [];
  for (const place of places) {
    await touch(place);
    await settled(page);
    const now = await composed(page);
    const isUnder = await page.evaluate(([x, y]) => document.elementFromPoint(x, y)?.matches("canvas"), place);
    if (!now.open || now.pressed !== "Drill" || now.typing || !isUnder || !now.x) wrong.push({ place, ...now, isUnder });
    const elsewhere = page.locator("#compose .elsewhere");
    if (await elsewhere.isVisible()) await elsewhere.click();
  }
  return wrong;
}

for (const [name, options] of Object.entries({ "a phone": PHONE, "a screen": { hasTouch: true, viewport: { width: 1280, height: 720 } } })) {
  test(`a tap that picks a place on the map changes only the place: 8 taps on ${name}`, async (t) => {
    const page = await picking(t, options);
    const { tap } = await glass(page);
    assert.deepEqual(await pickEach(page, await placesOn(page, 8), tap), []);
  });
}

test("a slow finger, a double tap, a mouse, a pen and a held key change only the place", async (t) => {
  const page = await picking(t, PHONE);
  const { down, up, tap, mouse, pen } = await glass(page);
  const places = await placesOn(page, 4);
  const touches = {
    slow: async (place) => { await down(place); await page.waitForTimeout(300); await up(); },
    double: async (place) => { await tap(place); await tap(place); },
    mouse, pen,
    key: async () => {
      await page.locator(canvas).focus();
      for (let i = 0; i < 4; ++i) await page.keyboard.down("Enter");
      await page.keyboard.up("Enter");
    },
  };
  for (const [name, touch] of Object.entries(touches)) assert.deepEqual(await pickEach(page, places.slice(0, 2), touch), [], name);
});

test("two fingers on the map pick nothing", async (t) => {
  const page = await picking(t, PHONE);
  const { tap } = await glass(page), [one, other] = await placesOn(page, 2);
  await tap(one, other);
  await settled(page);
  assert.equal((await composed(page)).x, "");
});

/** The centre of the button that closes the open help. */
async function closer(page) {
  const { x, y, width, height } = await page.locator("#help .close").boundingBox();
  return [x + width / 2, y + height / 2].map(Math.round);
}

test("a finger that is down while a dialog opens does not press it", async (t) => {
  const { page } = await watch(t, "calm", PHONE);
  const { down, up } = await glass(page);
  await page.locator("button.help").first().evaluate((button) => button.click());
  const place = await closer(page);
  await page.keyboard.press("Escape");
  await page.waitForSelector(DIALOG, { state: "hidden" });
  await down(place);
  await page.locator("button.help").first().evaluate((button) => button.click());
  await armed(page);  // the dialog is still by then, and it is not a long press yet
  await up();
  await settled(page);
  assert.ok(await page.locator(DIALOG).isVisible());
});

test("the second tap on a button that closes a dialog does not press the element below", async (t) => {
  const page = await picking(t, { hasTouch: true, viewport: { width: 1920, height: 1080 } });
  const { tap } = await glass(page);
  await page.keyboard.press("?");
  const place = await closer(page);
  await page.waitForSelector("[data-moving]", { state: "detached" });
  await tap(place);
  await tap(place);
  await settled(page);
  assert.ok(await page.locator(DIALOG).isHidden());
  await page.waitForSelector("[data-moving]", { state: "detached" });
  assert.ok(await page.evaluate(([x, y]) => document.elementFromPoint(x, y).matches("canvas"), place), "below it is the map");
  assert.equal((await composed(page)).x, "");
});

const isComposing = async (page) => {
  await settled(page);
  return (await composed(page)).open;
};

test("an element that moves under a finger takes a press only once it is still", async (t) => {
  const { page } = await watch(t, "calm", PHONE);
  await toTab(page, "Reports");
  const { down, up, tap } = await glass(page);
  const button = page.locator("#reports .compose:enabled");
  await armed(page);
  let by = 0;
  /** Moves the panel, which is otherwise still, down by 100 pixels. Returns the button's new place. */
  const shift = () => button.evaluate((node, by) => {
    document.getElementById("reports").style.translate = `0 ${by}px`;
    const { x, y, width, height } = node.getBoundingClientRect();
    return [x + width / 2, y + height / 2];
  }, (by += 100));
  const { x, y, width, height } = await button.boundingBox();
  const next = [x + width / 2, y + height / 2 + 100];
  await down(next);
  await shift();
  await up();
  assert.ok(!(await isComposing(page)), "the button moved under the finger");
  await tap(await shift());
  assert.ok(!(await isComposing(page)), "the button is not still yet");
  const place = await shift();
  await page.waitForFunction(([x, y]) => document.elementFromPoint(x, y)?.matches(".compose"), place);
  await tap(place);
  assert.ok(await isComposing(page), "the button is still");
});

test("the element under the finger at its start is pressed, even if the page moves before its end", async (t) => {
  const { page } = await watch(t, "calm", PHONE);
  await toTab(page, "Reports");
  const { down, up } = await glass(page);
  const button = page.locator("#reports .compose:enabled");
  const touch = { down, up, drag: async () => {} };
  const mouse = { down: async ([x, y]) => { await page.mouse.move(x, y); await page.mouse.down(); }, up: () => page.mouse.up(), drag: (x, y) => page.mouse.move(x, y) };
  for (const [name, hand] of Object.entries({ touch, mouse })) {
    for (const [moves, isMeant] of [["away", true], ["hidden", false], ["dragged", false]]) {
      if (name === "touch" && moves === "dragged") continue;  // that scrolls
      await page.waitForFunction(() => !document.querySelector("[data-moving]"));
      const { x, y, width, height } = await button.boundingBox(), place = [x + width / 2, y + height / 2];
      await hand.down(place);
      if (moves === "dragged") await hand.drag(place[0], place[1] + 100);
      else await button.evaluate((node, moves) => {
        if (moves === "hidden") node.hidden = true;
        else node.style.translate = "0 100px";
      }, moves);
      await hand.up();
      assert.equal(await isComposing(page), isMeant, `${name}: ${moves}`);
      if (isMeant) await page.keyboard.press("Escape");
      await page.locator("#reports .compose").evaluate((node) => Object.assign(node, { hidden: false, style: "" }));
    }
  }
});

test("a question over a dialog takes no press at once, wherever it is in the page", async (t) => {
  const { page } = await watch(t, "calm");
  const moving = await page.evaluate(async () => {
    const [first, last] = document.querySelectorAll("dialog"), seen = [];
    const after = async (done) => {
      done();
      await Promise.resolve();  // presses.js has handled the event
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
