// The map's tools: following a robot, measuring, colours.
import assert from "node:assert/strict";
import { test } from "node:test";
import { robotRgb } from "../../firmware/doors/site/files/robot_colour.js";
import { until } from "./box.js";
import { box, canvas } from "./pictures.js";
import { axeFindsNothing, hears, settled, toTab, watch } from "./watch.js";

const SCOUT = robotRgb(1, "dark");
const measure = (page) => page.getByRole("button", { name: "Measure" });
const told = (page) => page.textContent("#map .measured");

/** The centre of the pixels with this colour, in page pixels from the canvas's corner; null if there are none. */
const middleOf = (page, colour) => page.$eval(canvas, (node, colour) => {
  const { data, width } = node.getContext("2d").getImageData(0, 0, node.width, node.height);
  let count = 0, x = 0, y = 0;
  for (let i = 0; i < data.length; i += 4) {
    if (colour.some((part, at) => Math.abs(part - data[i + at]) > 6)) continue;
    ++count;
    x += (i / 4) % width;
    y += Math.floor(i / 4 / width);
  }
  return count > 10 ? [x / count, y / count] : null;
}, colour);

const only = async (page, ...names) => {
  for (const name of ["Grids", "Clouds", "Robots", "Reports", "Tracks", "Markers"]) await box(page, name).setChecked(names.includes(name));
};

async function isInTheMiddle(page) {
  const { width, height } = await page.locator(canvas).boundingBox();
  await until(async () => {
    const at = await middleOf(page, SCOUT);
    return at && Math.hypot(at[0] - width / 2, at[1] - height / 2) < 8;
  }, "Scout in the middle");
}

test("cuts no word of its lists", async (t) => {
  const { page } = await watch(t, "calm");
  await page.locator(".follow select:enabled").waitFor();
  for (const [width, height] of [[390, 844], [1280, 720], [1920, 1080]]) {
    await page.setViewportSize({ width, height });
    await toTab(page, "Map");
    const cut = await page.$$eval("#map select, .filter select", (selects) => selects.filter((select) => {
      if (!select.checkVisibility()) return false;
      const own = select.getBoundingClientRect().width, whole = select.cloneNode(true);
      whole.replaceChildren(select.options[select.selectedIndex].cloneNode(true));
      whole.style.width = "auto";
      select.after(whole);
      const needed = whole.getBoundingClientRect().width;
      whole.remove();
      return own < needed + 8; // other fonts are wider
    }).map((select) => select.value));
    assert.deepEqual(cut, [], `${width}`);
    const [follow, layers] = await Promise.all([".follow select", ".layers summary"].map((part) => page.locator(part).boundingBox()));
    assert.ok(layers.x >= follow.x + follow.width + 4, `${width}: they overlap`);
  }
});

test("follows a chosen robot until the user moves the map", async (t) => {
  const { page } = await watch(t, "calm", { colorScheme: "dark" });
  await only(page, "Robots");
  const choice = page.getByLabel("Follow");
  await page.waitForFunction(() => !document.querySelector("#map .follow select").disabled);
  assert.deepEqual(await choice.locator("option").allTextContents(), ["Follow …", "ANYmal1", "ANYmal2", "Scout"]);
  await choice.selectOption("Scout");
  await page.locator(canvas).press("+");
  await isInTheMiddle(page);
  const at = await page.locator(canvas).boundingBox();
  await page.mouse.move(at.x + 300, at.y + 200);
  await page.mouse.down();
  await page.mouse.move(at.x + 200, at.y + 150, { steps: 3 });
  await page.mouse.up();
  assert.equal(await choice.inputValue(), "");
});

test("follows a tapped robot, and stops after a tap beside it", async (t) => {
  const { page } = await watch(t, "calm", { colorScheme: "dark", hasTouch: true });
  await only(page, "Robots");
  const at = await until(() => middleOf(page, SCOUT), "Scout");
  await page.locator(canvas).tap({ position: { x: at[0], y: at[1] } });
  assert.equal(await page.getByLabel("Follow").inputValue(), "Scout");
  await isInTheMiddle(page);
  const { width, height } = await page.locator(canvas).boundingBox();
  await page.locator(canvas).tap({ position: { x: width / 2 - 150, y: height / 2 + 90 } });
  assert.equal(await page.getByLabel("Follow").inputValue(), "");
});

test("measures between two points, by finger and by key", async (t) => {
  const { page } = await watch(t, "empty", { hasTouch: true });
  await settled(page);
  const tap = (x, y) => page.locator(canvas).tap({ position: { x, y } });
  const metres = async () => Number(/^([\d.]+) m \(x −?[\d.]+, y −?[\d.]+\)$/.exec(await told(page))[1]);
  await tap(300, 200);
  assert.equal(await told(page), "", "nothing is measured yet");
  await measure(page).tap();
  assert.equal(await measure(page).getAttribute("aria-pressed"), "true");
  assert.equal(await told(page), "Tap the first point.");
  await tap(300, 200);
  assert.match(await told(page), /^From −?[\d.]+, −?[\d.]+ m\. Tap the second point\.$/);
  await tap(400, 200);
  const one = await metres();
  await tap(300, 200);
  await tap(300, 400);
  const two = await metres();
  assert.ok(one > 0 && Math.abs(two / one - 2) < 0.03, `${one} and ${two} m`);
  await page.locator(canvas).focus();
  await page.keyboard.press("Enter");
  for (let i = 0; i < 5; ++i) await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Enter");
  assert.ok(Math.abs((await metres()) / one - 3) < 0.03, "five presses are 300 pixels");
  await page.keyboard.press("Escape");
  assert.equal(await told(page), "");
  assert.equal(await measure(page).getAttribute("aria-pressed"), "false");
});

test("picks a place while a report is composed, whatever was measured before", async (t) => {
  const { page } = await watch(t, "reports");
  await measure(page).click();
  await page.getByRole("button", { name: "New report" }).click();
  await page.locator("#compose .types").getByRole("button", { name: "Rope", exact: true }).click();
  assert.equal(await measure(page).getAttribute("aria-pressed"), "false");
  await page.locator(canvas).click({ position: { x: 260, y: 250 } });
  await until(() => page.inputValue("#compose input[name=x]"), "the place");
  assert.equal(await told(page), "");
  assert.equal(await page.getByLabel("Follow").inputValue(), "");
});

test("has tools large enough for a gloved finger", async (t) => {
  for (const viewport of [{ width: 390, height: 844 }, { width: 1280, height: 720 }]) {
    const { page } = await watch(t, "calm", { viewport });
    await toTab(page, "Map");
    const small = await page.$$eval("#map :is(button, select, input, label:not([for]))", (nodes) => nodes.filter((node) => node.checkVisibility()).flatMap((node) => {
      const { width, height } = (node.closest("label") ?? node).getBoundingClientRect();
      return width < 44 || height < 44 ? [`${node.className || node.type}: ${width} x ${height}`] : [];
    }));
    assert.deepEqual(small, [], `${viewport.width}`);
  }
});

test("colours clouds by height or by robot, and at night all in red", async (t) => {
  const { page } = await watch(t, "calm", { colorScheme: "dark" });
  await settled(page);
  const clouds = () => page.requests.filter((url) => url.includes("/cloud/ugv1/"));
  assert.ok(clouds().length && clouds().every((url) => !url.includes("from=")));
  assert.ok(await page.locator("#map .legend").isVisible());
  await box(page, "Clouds by robot").check();
  const own = robotRgb(3, "dark").map((part) => part.toString(16).padStart(2, "0")).join("");
  await until(() => clouds().some((url) => url.includes(`to=${own}&`)), "clouds in the robot's colour");
  assert.ok(await page.locator("#map .legend").isHidden());
  await page.locator(".strip .theme").click();  // light theme
  await page.locator(".strip .theme").click();  // night theme
  await page.waitForSelector("[data-theme=red]");
  await settled(page);
  const others = () => page.$eval(canvas, (node) => {
    const { data } = node.getContext("2d").getImageData(0, 0, node.width, node.height);
    let lit = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (Math.max(data[i + 1], data[i + 2]) > Math.max(24, data[i] * 0.8)) return "another";
      if (data[i] > 40) ++lit;
    }
    return lit > 1000 ? "none" : "dark";
  });
  await until(async () => (await others()) === "none", "a map without any light but red");
});

test("is copied while it is dragged; layers are drawn now and then, and at rest", async (t) => {
  const prepare = (page) => page.addInitScript(() => {
    globalThis.drawn = 0;  // how often the reports' layer was drawn
    let isDrawing = false;
    const real = CanvasRenderingContext2D.prototype.roundRect;
    CanvasRenderingContext2D.prototype.roundRect = function (...words) {
      if (!isDrawing) {
        ++globalThis.drawn;
        queueMicrotask(() => (isDrawing = false));
      }
      isDrawing = true;
      return real.apply(this, words);
    };
  });
  const { page } = await watch(t, "calm", { prepare });
  await settled(page);
  await only(page, "Reports");
  await page.locator(canvas).press("f");
  const drawn = () => page.evaluate(() => globalThis.drawn);
  await hears(page, 2);  // the map has come to rest meanwhile
  const { before, during, frames } = await page.$eval(canvas, async (node) => {
    const { x, y } = node.getBoundingClientRect(), frame = () => new Promise(requestAnimationFrame);
    node.setPointerCapture = () => {};
    const send = (type, left) => node.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: x + left, clientY: y + 100, bubbles: true }));
    const look = () => node.toDataURL(), looks = new Set();
    const before = globalThis.drawn;
    send("pointerdown", 300);
    for (let i = 1; i <= 10; ++i) {
      send("pointermove", 300 + 12 * i);
      await frame();
      await frame();
      looks.add(look());
    }
    const during = globalThis.drawn;
    send("pointerup", 420);
    return { before, during, frames: looks.size };
  });
  assert.ok(frames >= 9, `${frames} different pictures`);
  assert.ok(during - before < frames / 2, `drawn ${during - before} times for ${frames} pictures`);
  await until(async () => (await drawn()) > during, "the reports to be drawn where they are now");
});

test("has the layers in one tool, with sets of layers, all visible", async (t) => {
  for (const viewport of [{ width: 1280, height: 720 }, { width: 390, height: 844 }]) {
    const { page } = await watch(t, "calm", { viewport, bypassCSP: true });
    await toTab(page, "Map");
    const panel = page.locator("#map .layers fieldset"), tool = page.getByText("Layers", { exact: true });
    assert.ok(await panel.isHidden());
    await tool.click();
    const checked = () => panel.locator("[data-shows]:checked").evaluateAll((boxes) => boxes.map(({ dataset }) => dataset.shows).sort());
    const sets = { Coverage: ["cloud", "grid"], Robots: ["grid", "robots", "tracks"], Reports: ["grid", "pointless", "reports"], Run: ["cloud", "grid", "markers", "reports", "robots", "tracks"] };
    assert.deepEqual(await checked(), sets.Run);
    for (const [name, layers] of Object.entries(sets)) {
      const preset = panel.getByRole("button", { name, exact: true });
      await preset.click();
      assert.deepEqual([await checked(), await preset.getAttribute("aria-pressed")], [layers, "true"], name);
    }
    const cut = await panel.evaluate((node) => {
      const [own, frame] = [node, node.closest(".frame")].map((each) => each.getBoundingClientRect());
      return own.bottom > frame.bottom || own.right > frame.right || node.scrollWidth > node.clientWidth;
    });
    assert.ok(!cut, `${viewport.width}`);
    await axeFindsNothing(page);
    await page.keyboard.press("Escape");
    assert.ok(await panel.isHidden());
  }
});
