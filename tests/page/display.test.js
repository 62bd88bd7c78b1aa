import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "./box.js";
import { COUNT, withMany } from "./many_reports.js";
import { retell } from "./retold.js";
import { kept, spans, withHistory } from "./kept_history.js";
import { axeFindsNothing, waitForText, showsTheClock, text, watch } from "./watch.js";

const SCREENS = [[1280, 720], [1920, 1080], [3840, 2160]];

test("shows the run on one screen, without buttons", async (t) => {
  for (const path of ["display", "display.html"]) {
    const began = Date.now(), { page } = await watch(t, "reports", { path });
    await showsTheClock(page, began);
    assert.equal(await text(page, "#score"), "7");
    assert.equal(await text(page, "#remaining"), "18");
    assert.match(await text(page, "#arriving"), /Every map arrives/);
    assert.match(await text(page, "#reports ol"), /Drill.*queued.*#28.*Cube.*sending.*#27/);
    assert.match(await text(page, "#attention"), /report 25 is in doubt/i);
    assert.equal(await page.locator("button, input, a, select, [tabindex]").count(), 0);
    assert.deepEqual(page.complaints, []);
  }
});

test("fits 720p, 1080p and 4K, with all text large enough", async (t) => {
  const { page } = await watch(t, "trouble", { path: "display" });
  for (const [width, height] of SCREENS) {
    await page.setViewportSize({ width, height });
    const tall = await page.evaluate(() => Math.max(...[...document.querySelectorAll("main > *")].map((node) => node.getBoundingClientRect().bottom)));
    assert.ok(tall <= height, `${tall} of ${height}`);
    const sizes = await page.$$eval("main *", (nodes) => nodes.filter((node) => node.childNodes.length && node.offsetHeight > 1 && !node.closest(".spoken")).map((node) => parseFloat(getComputedStyle(node).fontSize)));
    assert.ok(Math.min(...sizes) >= height / 68, `${Math.min(...sizes)} px of ${height}`);
    const map = await page.locator("#map").boundingBox();
    assert.ok(map.width * map.height > (width * height) / 4, "the map is large");
    const clock = await page.$eval("#clock", (node) => parseFloat(getComputedStyle(node).fontSize));
    assert.ok(clock >= height / 15, `${clock}`);
  }
});

test("hides reports without points if its address says so, and says how many", async (t) => {
  const prepare = (page) => page.addInitScript(() => {
    globalThis.written = new Set();
    const { fillText } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.fillText = function (words, ...more) {
      globalThis.written.add(String(words).trim());
      return fillText.call(this, words, ...more);
    };
  });
  for (const [path, areShown] of [["display", true], ["display?hide=no-points", false]]) {
    const { page } = await watch(t, "calm", { path, prepare });
    await page.locator('#reports [data-key="7"]').waitFor();
    await page.waitForFunction(() => globalThis.written.has("#7 Survivor"));
    assert.equal(await page.locator("#reports li", { hasText: "no points" }).count() > 0, areShown);
    assert.equal((await text(page, "#reports .count")).trim(), areShown ? "7" : "5, 2 without points hidden");
    assert.equal(await page.evaluate(() => globalThis.written.has("#6 Gas")), areShown, "on the map");
  }
});

test("has no axe fault on a phone", async (t) => {
  const { page } = await watch(t, "trouble", { path: "display", bypassCSP: true, viewport: { width: 390, height: 844 } });  // axe is a script
  await axeFindsNothing(page);
});

test("shows each report as a whole or not at all, because the display does not scroll", async (t) => {
  const { page } = await watch(t, "trouble", { path: "display" });
  await page.locator("#reports li").nth(9).waitFor();
  for (const [width, height] of [[360, 740], ...SCREENS]) {
    await page.setViewportSize({ width, height });
    const [shown, halves, cut] = await page.evaluate(() => {
      const list = document.querySelector("#reports ol"), { right, bottom } = document.getElementById("reports").getBoundingClientRect();
      const inSight = [...list.children].filter((row) => row.getBoundingClientRect().left < right);
      const isCut = (row) => [...row.children].some((part) => part.scrollWidth > part.clientWidth + 1);
      const names = (rows) => rows.map((row) => row.textContent);
      return [inSight.length, names(inSight.filter((row) => row.getBoundingClientRect().bottom > bottom + 1)), names(inSight.filter(isCut))];
    });
    assert.ok(shown >= 4, `${shown} at ${width}`);
    assert.deepEqual([halves, cut], [[], []], `${width} x ${height}`);
  }
});

test("cuts no figure, not even on a phone", async (t) => {
  const { page } = await watch(t, "reports", { path: "display" });
  for (const [width, height] of [[390, 844], [844, 390], [768, 1024], ...SCREENS]) {
    await page.setViewportSize({ width, height });
    const cut = await page.$$eval(".figures dd", (nodes) => nodes.filter((node) => node.scrollWidth > node.clientWidth + 1).map((node) => node.id));
    assert.deepEqual(cut, [], `${width} x ${height}`);
    const outside = await page.$$eval(".figures, .figures > div", ([box, ...parts]) => parts.filter((part) => part.getBoundingClientRect().right > box.getBoundingClientRect().right + 1).length);
    assert.equal(outside, 0, `${width} x ${height}`);
  }
});

test("cuts no word in the head of a list, and shows problems first", async (t) => {
  const prepare = (page) => retell(page, () => (view) => {
    const grid = view.activities.find(({ kind, robot }) => kind === "grid" && !robot), markers = view.activities.find(({ kind }) => kind === "markers");
    if (!grid || !markers) return view;
    const late = { level: "wait", word: "1 min behind", age: 95 };
    const shared = [{ ...grid, ...late }, { ...grid, kind: "cloud", age: 3599 }, { ...markers, level: "bad", word: "rejected" }];
    return { ...view, activities: [...view.activities.filter((row) => row.robot), ...shared] };
  });
  for (const told of [undefined, prepare]) {
    const { page } = await watch(t, "reports", { path: "display", prepare: told });
    await page.locator("#shared .name", { hasText: "Markers" }).waitFor({ state: "attached" });
    for (const [width, height] of SCREENS) {
      await page.setViewportSize({ width, height });
      const [cut, words] = await page.evaluate(() => {
        const parts = [...document.querySelectorAll(".panel h2:not(.spoken), .panel h2:not(.spoken) .count, #shared > *, #shared .name, #shared .badge")];
        const head = (node) => node.closest(".line") ?? node.closest("h2");
        const inSight = parts.filter((node) => node.getBoundingClientRect().top < head(node).getBoundingClientRect().bottom - 1);
        const isCut = (node) => {
          const its = node.getBoundingClientRect(), { left, right } = node.closest(".panel").getBoundingClientRect();
          return its.left < left || its.right > right || (node.scrollWidth > node.clientWidth + 1 && node.matches(".count, .name, .badge"));
        };
        return [inSight.filter(isCut).map((node) => node.textContent), inSight.map((node) => node.textContent.trim())];
      });
      assert.deepEqual(cut, [], `${width} x ${height}`);
      for (const word of ["Markers", "Merged"]) assert.ok(words.includes(word), `${word} of ${words} at ${width}`);
      assert.ok(words.some((word) => word.startsWith("Robots")), "the title");
    }
    await page.close();
  }
});

test("shows each robot's full name, and marks questions and faults differently", async (t) => {
  const { page } = await watch(t, "reports", { path: "display" });
  await page.$$eval("#robots .name", ([first]) => (first.textContent = "explorer10"));
  for (const [width, height] of SCREENS) {
    await page.setViewportSize({ width, height });
    const cut = await page.$$eval("#robots .name", (names) => names.filter((name) => name.scrollWidth > name.clientWidth).map((name) => name.textContent));
    assert.deepEqual(cut, [], `${width} x ${height}`);
  }
  await page.setViewportSize({ width: 1280, height: 720 });
  await page.$$eval("#shared .name", (names) => names.forEach((name) => (name.textContent = "Merged cloud")));  // the longest names
  const [end, edge] = await page.evaluate(() => ["#shared", "#maps"].map((part) => document.querySelector(part).getBoundingClientRect().right));
  assert.ok(end <= edge, `${end} of ${edge}`);
  const levels = await page.$$eval("#attention .alarm", (nodes) => nodes.map((node) => node.dataset.level));
  assert.deepEqual(levels, ["ask", "ask"]);
});

test("shows a temporary alarm if there is no other", async (t) => {
  const prepare = (page) => retell(page, () => (view) => ({ ...view, alarms: view.alarms.filter(({ severity }) => severity === "wait") }));
  const { page } = await watch(t, "trouble", { path: "display", prepare });
  await page.locator("#attention .alarm[data-level=wait]", { hasText: "5 reports are left" }).waitFor();
});

test("says that the box is lost, and recovers by itself", async (t) => {
  const { stage, page } = await watch(t, "calm", { path: "display" });
  stage.freeze();
  await page.waitForSelector("body[data-link=lost]");
  await waitForText(page, "The box does not answer");
  assert.match(await text(page, "#arriving"), /Unknown/);
  stage.thaw();
  await page.waitForSelector("body[data-link=live]");
  assert.equal((await text(page, "#attention")).trim(), "No alarm");
});

test("shows the run even if damage took a report's place from the ledger", async (t) => {
  const prepare = (page) => retell(page, () => (view) => {
    for (const report of view.reports) if (report.number === 8) Object.assign(report, { type: "", position: null, sender: "lost", run: view.run_number });
    return view;
  });
  const { page } = await watch(t, "trouble", { path: "display", prepare, viewport: { width: 3840, height: 2160 } });
  await page.locator("#reports li", { hasText: "#8 · lost from the ledger" }).waitFor({ state: "attached" });
  await page.waitForFunction(() => document.querySelector("#map canvas").width > 300);
  assert.deepEqual(page.complaints, []);
});

test("counts every report, also those past the newest 200", async (t) => {
  const { page } = await watch(t, "reports", { path: "display", prepare: withMany });
  await page.locator("#reports .count", { hasText: new RegExp(`^${COUNT}$`) }).waitFor();
});

test("shows the robots' lines from the box's history when it opens", async (t) => {
  const { page } = await watch(t, "calm", { path: "display", prepare: withHistory((now) => kept(now, 500)) });
  await until(async () => (await spans(page, '#robots li[data-key="ANYmal1"] path'))[0] >= 85, "a line of three minutes");
  assert.deepEqual(page.complaints, []);
});
