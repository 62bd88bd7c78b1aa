// The shown time: steps, play, ticks; and the box's history from before the page was opened.
import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "./box.js";
import { kept, spans, withHistory } from "./kept_history.js";
import { hears, settled, toTab, watch } from "./watch.js";

const button = (page, name) => page.locator("#map .time").getByRole("button", { name, exact: true });
const slider = (page) => page.getByRole("slider");
const value = (page) => slider(page).evaluate((node) => Number(node.value));
const most = (page) => slider(page).evaluate((node) => Number(node.max));
const shown = (page) => slider(page).getAttribute("aria-valuetext");

async function opened(t, scene = "calm", options = {}) {
  const { page, stage } = await watch(t, scene, options);
  await toTab(page, "Map");
  await page.waitForSelector("#map input[type=range]:enabled");
  return { page, stage };
}

test("steps by ten seconds, by press and by key, and by a minute by key", async (t) => {
  const { page } = await opened(t);
  const from = async (what, seconds) => {
    await slider(page).press("Home");
    for (let i = 0; i < 3; ++i) await slider(page).press("PageUp");  // into the middle of it
    const before = await value(page);
    assert.equal(before, 180);
    await what();
    assert.equal((await value(page)) - before, seconds);
    assert.match(await shown(page), /^as of \d\d:\d\d:\d\d$/);
  };
  for (const [name, seconds] of [["−10 s", -10], ["+10 s", 10]]) await from(() => button(page, name).click(), seconds);
  for (const [key, seconds] of [["PageDown", -60], ["ArrowLeft", -10], ["ArrowRight", 10], ["PageUp", 60], ["Shift+ArrowRight", 1], ["Shift+PageDown", -10]]) await from(() => slider(page).press(key), seconds);
  for (const [key, seconds] of [["<", -60], [",", -10], [".", 10], [">", 60]]) {
    await from(async () => {
      await page.evaluate(() => document.activeElement.blur());
      await page.keyboard.press(key);
    }, seconds);
  }
  await button(page, "Now").click();
  assert.equal(await shown(page), "now");
  await button(page, "+10 s").click();
  assert.equal(await shown(page), "now", "the slider is at its end");
});

test("plays from the shown time up to now, faster or slower, and pauses", async (t) => {
  const { page } = await opened(t);
  await slider(page).press("Home");
  assert.equal(await page.textContent("#map .speed"), "10×");
  await button(page, "Play").click();
  await until(async () => (await value(page)) >= 10, "ten seconds");
  await button(page, "Pause").click();
  const paused = await value(page);
  await hears(page, 3);
  assert.equal(await value(page), paused);
  await page.locator("#map .speed").click();
  assert.equal(await page.textContent("#map .speed"), "60×");
  for (let i = 0; i < 8; ++i) await slider(page).press("PageUp");
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("p");
  await until(async () => (await shown(page)) === "now", "it to end at now");
  await page.locator('#map .play[aria-label="Play"]').waitFor();
  await button(page, "Play").click();
  await until(async () => (await value(page)) < 200, "it to begin at the first again");
  await slider(page).press("ArrowLeft");
  assert.equal(await page.locator("#map .play").getAttribute("aria-label"), "Play", "moving the slider pauses");
});

test("loads a tile again only if it changed by that time", async (t) => {
  const { page } = await opened(t);
  await slider(page).press("Home");
  for (let i = 0; i < 4; ++i) await slider(page).press("PageUp");
  await settled(page);
  const asked = () => page.requests.filter((url) => url.includes("at=")).map((url) => new URL(url)).flatMap(({ pathname, searchParams }) => searchParams.get("tiles").split(",").map((place) => `${pathname} ${place}`));
  const tiles = () => asked().length, before = tiles();
  for (let i = 0; i < 6; ++i) {
    await slider(page).press("Shift+ArrowRight");  // the scene's map grows every 30 s
    await settled(page);
  }
  const more = tiles() - before, seen = new Set(asked()).size;
  assert.ok(more <= seen, `${more} of ${seen} tiles, in six steps`);
});

/** The number of pixels of ticks in the upper and in the lower half. */
const ticks = (page) => page.$eval("#map .ticks", (canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height), counts = [0, 0];
  for (let i = 3; i < data.length; i += 4) if (data[i] > 100) ++counts[i < data.length / 2 ? 0 : 1];
  return counts;
});

test("has ticks of reports above its line, and of alarms below", async (t) => {
  const { page: calm } = await opened(t, "calm");
  await until(async () => (await ticks(calm))[0] > 20, "the reports");
  assert.equal((await ticks(calm))[1], 0);
  const { page: alarmed } = await opened(t, "calm", { prepare: withHistory((now) => kept(now, 600, [100, 300])) });
  await until(async () => (await ticks(alarmed))[1] > 20, "the alarms");
});

test("fills plots and the robots' lines from the box's history when the page opens", async (t) => {
  const { page } = await opened(t, "calm", { prepare: withHistory((now) => kept(now, 500)) });
  await until(async () => (await spans(page, "#plots .line")).every((span) => span >= 110), "plots of eight minutes"); // of 149
  assert.ok((await spans(page, "#plots .line")).every((span) => span <= 130), "the plot is longer than the history");
  const [first] = await spans(page, '#robots li[data-key="ANYmal1"] path');
  assert.ok(first >= 85, `${first} of 90`);
  assert.equal(page.historyAsked[0], "0");
  await hears(page, 4);
  assert.equal(page.historyAsked.length, 1);
  const { page: young } = await opened(t, "calm", { prepare: withHistory((now) => kept(now, 0)) });
  await young.locator("#plots li").nth(4).waitFor();
  assert.ok((await spans(young, "#plots .line")).every((span) => span < 10), "the plot shows times without data");
});

test("has a slider of at least half of its panel's width", async (t) => {
  const { page } = await opened(t);
  for (const [width, height] of [[390, 844], [1280, 720], [1920, 1080]]) {
    await page.setViewportSize({ width, height });
    const [bar, panel] = await page.$$eval("#map .bar, #map .time", (nodes) => nodes.map((node) => node.clientWidth).sort((a, b) => a - b));
    assert.ok(bar >= panel / 2, `${bar} of ${panel} at ${width}`);
  }
});

test("has room for a gloved finger on a phone, with all parts of a larger screen", async (t) => {
  const { page } = await opened(t, "calm", { viewport: { width: 390, height: 844 }, hasTouch: true });
  const boxes = await page.$$eval("#map .time :is(button, input)", (nodes) => nodes.map((node) => {
    const { left, right, width, height } = node.getBoundingClientRect();
    return { left, right, width, height };
  }));
  assert.equal(boxes.length, 6);
  for (const { left, right, width, height } of boxes) assert.ok(width >= 44 && height >= 44 && left >= 0 && right <= 390, JSON.stringify({ left, right, width, height }));
  await button(page, "−10 s").tap();
  assert.match(await shown(page), /^as of/);
  const before = await value(page);
  await button(page, "−10 s").tap();
  assert.equal(before - (await value(page)), 10);
  assert.ok((await most(page)) >= 570);
});
