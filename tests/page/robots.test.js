// The robots' panel: the worst robots come first, and no row moves under a pointer.
import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "./box.js";
import { retell } from "./retold.js";
import { twenty } from "./twenty.js";
import { axeFindsNothing, openMore, toTab, watch } from "./watch.js";

const SMALL = { width: 1280, height: 720 }, LARGE = { width: 1920, height: 1080 };
const names = (page, list = "#robots") => page.$$eval(`${list} li`, (rows) => rows.map((row) => row.dataset.key));
const watchTwenty = (t, options = {}) => watch(t, "calm", { prepare: twenty, ...options });

test("shows twenty robots as a whole on screens of 720 and 1080 lines", async (t) => {
  const { page } = await watchTwenty(t);
  for (const [viewport, tall] of [[SMALL, 24], [LARGE, 44]]) {
    await page.setViewportSize(viewport);
    const rows = await page.evaluate(() => {
      const { top, bottom, left, right } = document.querySelector("#maps .scroll").getBoundingClientRect();
      return [...document.querySelectorAll("#robots li")].map((row) => {
        const box = row.getBoundingClientRect(), parts = [...row.querySelectorAll(".name, .age .text")];
        const isWhole = box.top >= top - 0.5 && box.bottom <= bottom + 0.5 && box.left >= left && box.right <= right;
        return { tall: box.height, isWhole: isWhole && parts.every((part) => part.scrollWidth <= part.clientWidth + 1 && part.getBoundingClientRect().right <= box.right) };
      });
    });
    assert.deepEqual(rows, Array(20).fill({ tall, isWhole: true }), `${viewport.width}`);
  }
  assert.match(await page.innerText('#robots li[data-key="ugv4"]'), /^ugv4\s+grid (now|\d s) · cloud (now|\d s)\s+(now|\d s)$/);
});

test("takes the height of its rows, and leaves the rest to the reports", async (t) => {
  const heights = (page) => page.$$eval("#reports, #maps .scroll, #robots", (nodes) => nodes.map((node) => node.offsetHeight));
  const { page: few } = await watch(t, "calm");
  const [most, panel, rows] = await heights(few);
  assert.ok(panel - rows < 48, `${panel} for rows of ${rows}`);  // two of three rows
  const { page: many } = await watchTwenty(t);
  await many.locator("#robots li").nth(19).waitFor();
  const [less] = await heights(many);
  assert.ok(less >= 240 && most >= less + 100, `${most} beside few robots, ${less} beside many`);
});

test("cuts no word in the head of its list", async (t) => {
  const prepare = (page) => retell(page, () => (view) => {
    const grid = view.activities.find(({ kind, robot }) => kind === "grid" && !robot);
    return grid ? { ...view, activities: [...view.activities, { ...grid, kind: "cloud" }] } : view;
  });
  const { page } = await watch(t, "calm", { prepare });
  await page.locator("#shared .name", { hasText: "Merged cloud" }).waitFor();
  for (const [width, height] of [[360, 740], [390, 844], [844, 390], [1280, 720], [1440, 900], [1920, 1080], [3840, 2160]]) {
    await page.setViewportSize({ width, height });
    const cut = await page.$$eval("#maps-title, #maps-title .count, #shared .name, #shared .badge", (parts) =>
      parts.filter((part) => part.checkVisibility() && part.scrollWidth > part.clientWidth + 1 && getComputedStyle(part).display !== "inline").map((part) => part.textContent));
    assert.deepEqual(cut, [], `${width} x ${height}`);
  }
});

test("cuts no robot's name", async (t) => {
  const prepare = (page) => retell(page, () => (view) => {
    const names = Array.from({ length: 20 }, (_, i) => `legged_${101 + i}`);
    return { ...view, standings: names.map((name, i) => ({ ...view.standings[0], name, has_map: i % 2 === 0 })) };
  });
  const { page } = await watch(t, "calm", { prepare });
  await page.locator("#robots li[data-key=legged_120]", { hasText: "no map" }).waitFor();
  for (const [width, height] of [[390, 844], [1280, 720], [1600, 900], [1920, 1080], [3840, 2160]]) {
    await page.setViewportSize({ width, height });
    const cut = await page.$$eval("#robots :is(.name, .age)", (parts) => parts.filter((part) =>
      part.scrollWidth > part.clientWidth + 1 || part.getBoundingClientRect().right > part.parentElement.getBoundingClientRect().right + 1).map((part) => part.textContent));
    assert.deepEqual(cut, [], `${width} x ${height}`);
  }
});

test("has the worst first: silent robots are filled and marked in words, late ones have a shape", async (t) => {
  const { page } = await watchTwenty(t, { viewport: LARGE, colorScheme: "dark" });
  await page.locator("#robots li").nth(19).waitFor();
  assert.deepEqual((await names(page)).slice(0, 2), ["uav5", "uav6"]);
  const look = (name) => page.locator(`#robots li[data-key="${name}"]`);
  assert.match(await look("uav5").innerText(), /^uav5\s+silent\s+1:\d\d$/);
  assert.match(await look("uav6").innerText(), /^uav6\s+grid \d\d s behind · cloud/);
  const styles = await page.$$eval("#robots li", (rows) => rows.slice(0, 3).map((row) => [getComputedStyle(row).backgroundColor, getComputedStyle(row.querySelector(".glyph")).display, row.dataset.level]));
  assert.equal(styles[0][0], "rgb(196, 40, 30)");
  assert.deepEqual(styles.map(([, glyph]) => glyph === "none"), [false, false, true]);
  assert.deepEqual(styles.map(([, , level]) => level), ["bad", "wait", "good"]);
});

test("shows the number by which the rows are sorted", async (t) => {
  const { page } = await watchTwenty(t);
  const numbers = () => page.$$eval("#robots li[data-level=good] .age .text", (ages) => ages.map(({ textContent }) => (textContent === "now" ? 0 : parseInt(textContent))));
  const isSorted = (values) => values.length === 18 && values[0] >= 3 && values.every((value, i) => i === 0 || value <= values[i - 1]);
  await until(async () => isSorted(await numbers()), "numbers in order");
});

test("says that a robot sends no maps, or that its maps never arrived", async (t) => {
  const prepare = (page) => retell(page, () => (view) => {
    const row = { ...view.activities[0], age: null, heard: 1 }, robot = { level: "good", word: "up to date", silent: false, age: null, heard: 1 };
    const waiting = { level: "wait", word: "waiting" };
    const activities = [{ ...row, robot: "scout", kind: "state" }, { ...row, ...waiting, robot: "carter", kind: "grid" }];
    return { ...view, activities, standings: [{ ...robot, name: "scout", has_map: false }, { ...robot, ...waiting, name: "carter", has_map: true }] };
  });
  const { page } = await watch(t, "calm", { prepare, viewport: LARGE });
  const age = (name) => page.innerText(`#robots li[data-key="${name}"] .age`);
  await page.waitForSelector('#robots li[data-key="scout"]');
  assert.deepEqual([await age("scout"), await age("carter")], ["no map", "never"]);
});

for (const [heard, words] of [[94, /^uav9\s+silent\s+1:\d\d$/], [null, /^uav9\s+silent\s+unknown$/]]) test(`has a row for a robot that was silent since the service began, and for how long if that is known: ${heard}`, async (t) => {
  const prepare = (page) => retell(page, (heard) => (view) => ({ ...view, standings: [...view.standings, { name: "uav9", level: "bad", word: "silent", silent: true, has_map: false, age: null, heard }] }), heard);
  const { page } = await watch(t, "calm", { prepare, viewport: LARGE });
  await page.waitForSelector('#robots li[data-key="uav9"][data-level=bad]');
  assert.match(await page.innerText('#robots li[data-key="uav9"]'), words);
  assert.equal((await names(page))[0], "uav9");
});

test("says once what is true of all kinds of a robot's data, and only what differs beside it", async (t) => {
  const prepare = (page) => retell(page, () => (view) => {
    const row = { ...view.activities[0], age: null, heard: 125 }, silent = { level: "bad", word: "silent" }, quiet = { level: "quiet", word: "quiet" };
    const kinds = (robot, states) => ["grid", "cloud", "state"].map((kind, i) => ({ ...row, robot, kind, ...states[i] }));
    const activities = [...kinds("all", [silent, silent, silent]), ...kinds("two", [silent, silent, { level: "bad", word: "not arriving" }]), ...kinds("still", [quiet, quiet, quiet])];
    const standing = { age: null, heard: 125, has_map: true, silent: true, ...silent };
    return { ...view, activities, standings: [{ ...standing, name: "all" }, { ...standing, name: "two" }, { ...standing, name: "still", silent: false, ...quiet }] };
  });
  const { page } = await watch(t, "calm", { prepare, viewport: { width: 390, height: 844 } });
  await toTab(page, "Robots");
  await page.waitForSelector('#robots li[data-key="two"]');
  const line = (name) => page.innerText(`#robots li[data-key="${name}"] .kinds`);
  assert.deepEqual([await line("all"), await line("two"), await line("still")], ["silent", "silent · pose not arriving", "quiet"]);
  assert.match(await page.innerText('#robots li[data-key="all"] .age'), /2:0\d/);
});

test("moves no row under a pointer, and sorts once the pointer has left", async (t) => {
  const { page } = await watchTwenty(t);
  await page.locator("#robots li[data-level=bad]").waitFor();
  await page.locator("#robots li").nth(12).hover();
  const before = await names(page);
  await page.evaluate(() => (globalThis.told.silent = ["uav5", "ugv2"]));
  await page.locator('#robots li[data-key="ugv2"][data-level=bad]').waitFor();
  assert.deepEqual(await names(page), before);
  await page.mouse.move(300, 300);
  await page.waitForFunction(() => document.querySelectorAll("#robots li")[1].dataset.key === "ugv2");
});

test("moves no row while the panel has the focus of the keyboard", async (t) => {
  const { page } = await watchTwenty(t);
  await page.locator("#robots li[data-level=bad]").waitFor();
  await page.keyboard.press("Tab");
  await page.locator("#maps .whole").focus();
  const before = await names(page);
  await page.evaluate(() => (globalThis.told.silent = ["uav5", "ugv2"]));
  await page.locator('#robots li[data-key="ugv2"][data-level=bad]').waitFor();
  assert.deepEqual(await names(page), before);
});

test("opens the list in place of the reports by a touch anywhere on it, and by a key", async (t) => {
  for (const viewport of [SMALL, LARGE]) {
    const { page } = await watchTwenty(t, { viewport, hasTouch: true, bypassCSP: true });
    await page.locator("#robots li").nth(13).tap();
    const list = page.locator("#all-robots");
    await list.waitFor();
    assert.equal(await list.locator("li").count(), 20);
    assert.equal(await list.locator("li").first().evaluate((row) => row.getBoundingClientRect().height), 44);
    assert.match(await list.locator('li[data-key="uav6"]').innerText(), /grid \d\d s behind, 3 queued · cloud .* · pose /);
    const [its, reports] = [await list.boundingBox(), await page.locator("#map").boundingBox()];
    assert.ok(its.x >= reports.x + reports.width, "the map stays where it is");
    for (const theme of viewport === SMALL ? ["dark", "light", "red"] : ["dark"]) {
      await page.evaluate((theme) => (document.documentElement.dataset.theme = theme), theme);
      await axeFindsNothing(page, theme);
    }
    await list.getByRole("button", { name: "Close" }).tap();
    await page.locator("#reports").waitFor();
    await page.locator("#maps-title").tap();
    await list.waitFor();
    await openMore(page);
    await list.waitFor({ state: "hidden" });
    await page.getByRole("button", { name: /^Show all robots/ }).press("Enter");
    await list.waitFor();
    assert.deepEqual(page.complaints, []);
  }
});

test("shows on a phone the worst robots below the map, and all in their tab", async (t) => {
  const { page } = await watchTwenty(t, { viewport: { width: 390, height: 844 }, hasTouch: true });
  const inSight = () => page.evaluate(() => {
    const { top, bottom } = document.querySelector("#maps .scroll").getBoundingClientRect();
    return [...document.querySelectorAll("#robots li")].filter((row) => row.getBoundingClientRect().top >= top && row.getBoundingClientRect().bottom <= bottom).map((row) => row.dataset.key);
  });
  const few = await inSight();
  assert.ok(few.length >= 4, `${few}`);
  assert.equal(few[0], "uav5");
  await page.locator("#robots li").first().tap();
  await page.waitForSelector("body[data-tab=robots]");
  assert.ok((await inSight()).length >= 9);
  await toTab(page, "Run");
});

test("shows the area that the grids cover, together and for each robot, and which robot has no grid", async (t) => {
  const covered = { version: 1, square_metres: 4213.06, whole: true, robots: [{ robot: "carter", square_metres: 812.5 }] };
  const prepare = async (page) => {
    await retell(page, () => (view) => {
      const row = { ...view.activities[0], age: 0, heard: 0 }, robot = { level: "good", word: "up to date", silent: false, has_map: true, age: 0, heard: 0 };
      const activities = [["carter", "grid"], ["scout", "cloud"], ["rover", "grid"]].map(([robot, kind]) => ({ ...row, robot, kind }));
      return { ...view, activities, standings: activities.map(({ robot: name }) => ({ ...robot, name })) };
    });
    await page.route("**/adit/covered", (route) => route.fulfill({ json: covered }));
  };
  const { page } = await watch(t, "calm", { prepare });
  const shared = page.locator("#shared [data-key=covered]");
  await shared.waitFor();
  assert.match(await shared.innerText(), /^Covered\s+4,213 m²$/);
  await page.locator("#maps-title").click();
  const words = (name) => page.locator(`#all-robots li[data-key="${name}"] .kinds`).innerText();
  await page.locator("#all-robots li").first().waitFor();
  assert.match(await words("carter"), /^grid .* · covers 813 m²$/);
  assert.match(await words("scout"), /^cloud .* · no grid$/);
  assert.doesNotMatch(await words("rover"), /covers|no grid/);  // its grid is not drawn yet
  assert.deepEqual(page.complaints, []);
});

test("draws each map's age over time, with now at the right", async (t) => {
  const { page } = await watchTwenty(t);
  await page.clock.install();
  await page.clock.runFor(20_000);
  await page.waitForFunction(() => (document.querySelector('#robots li[data-key="uav6"] path').getAttribute("d").match(/L/g) ?? []).length >= 3);
  const [x] = (await page.getAttribute('#robots li[data-key="uav6"] path', "d")).match(/[\d.]+(?= [\d.]+$)/);
  assert.equal(Number(x), 89, "now is at the right");
});
