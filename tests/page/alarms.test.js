import assert from "node:assert/strict";
import { test } from "node:test";
import { patient } from "./patience.js";
import { retell } from "./retold.js";
import { axeFindsNothing, settled, shoot, text, watch } from "./watch.js";

const SIZES = [[390, 844], [1280, 720], [1920, 1080], [3840, 2160]];
const shown = (page) => page.locator(".alarms .worst");
const icon = (page) => page.$eval("link[rel=icon]", (link) => link.getAttribute("href"));

test("says that there is no alarm, and which was the last", async (t) => {
  const { page } = await watch(t, "calm");
  await shown(page).getByText("No alarm").waitFor();
  assert.match(await shown(page).innerText(), /last alarm: Scout was silent for 0:41, ended at \d\d:\d\d/);
  assert.equal(await page.title(), "Adit");
  assert.equal(await icon(page), "icon.svg");
});

test("shows the two worst alarms with what to do, in the strip, the title and the icon", async (t) => {
  const { page } = await watch(t, "trouble", { bypassCSP: true });  // axe is a script
  const cards = page.locator(".alarms .worst .alarm");
  assert.equal(await cards.count(), 2);
  assert.match(await cards.nth(0).innerText(), /Mapping is unreachable\s+\d+:\d\d.*Command Post: connecting to.*hides 3/s);
  assert.match(await cards.nth(1).innerText(), /Report 8 is in doubt\s+\d+:\d\d/);
  assert.doesNotMatch(await cards.nth(1).innerText(), /Command Post:/, "the operator decides");
  assert.equal(await cards.nth(0).getByRole("link", { name: "Open test" }).getAttribute("href"), "/setup#test");
  assert.equal(await page.title(), "(3) Mapping is unreachable – Adit");
  assert.equal(await icon(page), "icon_bad.svg");
  await page.getByRole("button", { name: "All 3" }).click();
  assert.match(await page.locator("#all-alarms").innerText(), /5 reports are left/);
  await axeFindsNothing(page);
});

test("links each alarm in the list to its explanation", async (t) => {
  const { page } = await watch(t, "trouble", { bypassCSP: true });
  await page.getByRole("button", { name: "All 3" }).click();
  await page.locator("#all-alarms li", { hasText: "5 reports are left" }).getByRole("link", { name: "Help" }).click();
  await page.waitForURL(/\/help#reports_left$/);
  await page.locator("#reports_left").waitFor();
  assert.ok(await page.$eval("#reports_left:target", (row) => row.getBoundingClientRect().top < innerHeight));
  for (const width of [360, 1280]) {
    await page.setViewportSize({ width, height: 740 });
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${width} px`);
    await shoot(page, `help_${width}`);
  }
  await axeFindsNothing(page, "the page of all alarms");
});

test("keeps its place and height in every state", async (t) => {
  const { stage, page } = await watch(t, "calm");
  for (const [width, height] of SIZES) {
    await page.setViewportSize({ width, height });
    const boxes = [];
    for (const scene of ["calm", "trouble", "hostile", "reports"]) {
      stage.play(scene);
      await page.waitForFunction((name) => (document.querySelector(".alarms .alarm") === null) === (name === "calm"), scene);
      await settled(page);
      boxes.push(JSON.stringify(await page.locator(".alarms").boundingBox()));
      if (scene === "trouble") await shoot(page, `alarms_${width}`);
    }
    assert.equal(new Set(boxes).size, 1, boxes.join(" "));
  }
});

test("cuts no headline on any screen, whatever its length", async (t) => {
  const WORDS = ["The server is not a Command Post", "Too many clients are anonymous"];
  const prepare = (page) => retell(page, (words) => (view) => ({ ...view, alarms: view.alarms.slice(0, 2).map((alarm, i) => ({ ...alarm, what: words[i], acknowledged: false, action: { word: "Open set-up", link: "/setup" } })) }), WORDS);
  const { page } = await watch(t, "trouble", { prepare });
  await page.locator(".alarms .what", { hasText: WORDS[0] }).waitFor();
  for (const [width, height] of [...SIZES, [360, 740], [844, 390], [1024, 768], [1279, 800], [1440, 900], [1600, 900]]) {
    await page.setViewportSize({ width, height });
    const cut = await page.$$eval(".alarms .alarm", (cards) => cards.filter((card) => card.checkVisibility()).map((card) => card.querySelector(".what"))
      .filter((what) => what.scrollWidth > what.clientWidth + 1 && getComputedStyle(what).display !== "inline" || what.getBoundingClientRect().bottom > what.closest(".alarm").getBoundingClientRect().bottom).map((what) => what.textContent));
    assert.deepEqual(cut, [], `${width} x ${height}`);
    const targets = await page.$$eval(".alarms :is(a, button)", (nodes) => nodes.map((node) => node.getBoundingClientRect()).filter(({ width }) => width).map(({ width, height }) => Math.min(width, height)));
    assert.ok(Math.min(...targets) >= 44, `${targets} at ${width}`);
  }
});

test("offers an alarm's action on a phone, or to acknowledge an alarm without an action", async (t) => {
  const prepare = (page) => retell(page, () => (view) => {
    for (const alarm of view.alarms) if (globalThis.without) alarm.action = { word: "", link: "" };
    return view;
  });
  const { page } = await watch(t, "trouble", { prepare, viewport: { width: 390, height: 844 } });
  const card = page.locator(".alarms .worst .alarm").first();
  await card.getByRole("link", { name: "Open test" }).waitFor();
  assert.equal(await card.getByRole("button", { name: "Acknowledge" }).isVisible(), false);
  await page.evaluate(() => (globalThis.without = true));
  await card.getByRole("button", { name: "Acknowledge" }).waitFor();
  const { width, height } = await card.getByRole("button", { name: "Acknowledge" }).boundingBox();
  assert.ok(width >= 44 && height >= 44);
});

test("counts alarms on the tab that shows them", async (t) => {
  const prepare = (page) => retell(page, () => (view) => {
    const alarm = (severity, what, link) => ({ ...view.alarms[0], id: what, severity, what, action: { word: "Show", link } });
    return { ...view, alarms: view.alarms.length ? [
      alarm("bad", "uav5 is silent", "/#robot=uav5"), alarm("wait", "uav6 is late", "/#robot=uav6"),
      alarm("ask", "Report 8 is in doubt", "/#report=8"), alarm("bad", "Mapping is unreachable", "/setup#test"),
    ] : [] };
  });
  const { page } = await watch(t, "trouble", { prepare, viewport: { width: 390, height: 844 } });
  await page.locator(".tabs .waits", { hasText: "2" }).waitFor();
  const badges = await page.$$eval(".tabs button", (tabs) => tabs.map((tab) => {
    const badge = tab.querySelector(".waits:not([hidden])");
    return badge && [tab.dataset.tab, badge.textContent, badge.dataset.level, tab.title];
  }).filter(Boolean));
  assert.deepEqual(badges, [["reports", "1", "ask", "Report 8 is in doubt"], ["robots", "2", "bad", "uav5 is silent, uav6 is late"]]);
});

test("mutes acknowledged alarms and lists new ones first", async (t) => {
  const { page } = await watch(t, "trouble");
  const first = page.locator(".alarms .worst .alarm").first();
  await first.getByRole("button", { name: "Acknowledge" }).click();
  await page.waitForFunction(() => /Report 8/.test(document.querySelector(".alarms .alarm").innerText));
  assert.equal(await page.title(), "(3) Report 8 is in doubt – Adit");
  assert.equal(await icon(page), "icon_ask.svg");
  await page.getByRole("button", { name: "All 3" }).click();
  const known = page.locator("#all-alarms .alarm", { hasText: "Mapping is unreachable" });
  assert.equal(await known.getAttribute("data-acknowledged"), "true");
  assert.equal(await known.getByRole("button", { name: "Acknowledge" }).isVisible(), false);
});

test("links only to the box, whatever the text of an alarm", async (t) => {
  const { page } = await watch(t, "hostile");
  await page.waitForSelector(".alarms .alarm");
  assert.equal(await page.locator(".alarms a[href^=javascript]").count(), 0);
  assert.equal(await page.locator(".alarms .act").isVisible(), false);
  assert.equal(await page.evaluate(() => globalThis.pwned), undefined);
});

test("makes sounds only if the user wants them, and remembers the choice", async (t) => {
  const { page } = await watch(t, "trouble", { prepare: (fresh) => fresh.addInitScript(() => {
    globalThis.tones = 0;
    const real = AudioContext.prototype.createOscillator;
    AudioContext.prototype.createOscillator = function () {
      ++globalThis.tones;
      return real.call(this);
    };
  }) });
  await page.waitForSelector(".alarms .alarm");
  assert.equal(await page.evaluate(() => globalThis.tones), 0);
  await page.getByRole("button", { name: "Sound is off" }).click();
  await page.waitForFunction(() => globalThis.tones >= 4);  // one for switching it on, one for the alarm
  await page.reload();
  await page.getByRole("button", { name: "Sound is on" }).waitFor();
  await page.waitForFunction(() => globalThis.tones >= 2);
  await page.getByRole("button", { name: "Sound is on" }).click();
  await page.getByRole("button", { name: "Sound is off" }).waitFor();
});

test("still makes sounds after the box's clock stepped back", async (t) => {
  const prepare = async (page) => {
    await page.addInitScript(() => {
      localStorage.setItem("adit-sound", "on");
      globalThis.tones = 0;
      const real = AudioContext.prototype.createOscillator;
      AudioContext.prototype.createOscillator = function () {
        ++globalThis.tones;
        return real.call(this);
      };
    });
    await retell(page, () => (view) => ({ ...view, now: view.now - (globalThis.step ?? 0) }));
  };
  const { page } = await watch(t, "trouble", { prepare });
  await page.waitForFunction(() => globalThis.tones > 0);
  const before = await page.evaluate(() => {
    globalThis.step = 3600;
    return globalThis.tones;
  });
  await page.waitForFunction((before) => globalThis.tones >= before + 4, before, { timeout: patient(40_000) });  // two more within 20 s
});

test("is one line for a screen reader", async (t) => {
  const { page } = await watch(t, "calm");
  assert.equal(await page.locator(".alarms .worst").getAttribute("aria-live"), "assertive");
  assert.equal(await text(page, ".alarms .all"), "History");
});
