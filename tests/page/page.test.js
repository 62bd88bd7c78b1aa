import assert from "node:assert/strict";
import { test } from "node:test";
import { serve } from "./stage.js";
import { axeFindsNothing, said, settled, shoot, showsTheClock, text, watch } from "./watch.js";

const SIZES = [[390, 844], [768, 1024], [1280, 720], [1920, 1080], [3840, 2160]];

test("shows how the run stands, and that every map arrives", async (t) => {
  const began = Date.now(), { page } = await watch(t, "calm");
  await showsTheClock(page, began);
  assert.equal(await text(page, "#score"), "7");
  assert.equal(await text(page, "#remaining"), "18");
  assert.match(await text(page, "#arriving"), /Yes, every map arrives/);
  assert.equal(await page.getByRole("row", { name: /ANYmal2/ }).count(), 1);
  await page.getByRole("row", { name: /ANYmal2/ }).filter({ hasText: /7 s.*up to date/ }).waitFor(); // its age grows until the next event
  await page.getByTitle(/96 merged, taken as parts, rounded to 8mm$/).waitFor();
  assert.match(await text(page, "#reports .rows li:first-child"), /scored \+1.*Survivor.*85\.8, −4\.5/);
  assert.match(await text(page, "#refusals .rows"), /422.*got 4799/);
  assert.deepEqual(page.complaints, []);
});

test("follows what changes, and says so to those who only listen", async (t) => {
  const { stage, page } = await watch(t, "calm");
  const alert = page.locator("#attention");
  assert.equal(await alert.getAttribute("aria-live"), "assertive");
  assert.equal(await alert.textContent(), "");
  stage.play("trouble");
  await said(page, "1 report is in doubt");
  assert.match(await text(page, "#arriving"), /No: ANYmal1 cloud not arriving, ANYmal1 grid not arriving/); // the one longest behind first
  await page.getByRole("row", { name: /ANYmal2/ }).filter({ hasText: /\d s behind *247 waiting/ }).waitFor(); // though one was just sent
  assert.match(await text(page, "#sayings"), /ANYmal2 cloud: 429 "Cloud updates too frequent/);
  assert.match(await text(page, "#post"), /not connected.*Connection refused/);
  assert.match(await text(page, "#reports .rows"), /waiting.*Helmet.*sending.*Cube.*in doubt.*Vent/);
  stage.play("calm");
  await page.waitForFunction(() => document.getElementById("attention").textContent === "");
  assert.match(await text(page, "#arriving"), /Yes/);
});

test("tells every state by a shape and a word, not by colour alone", async (t) => {
  const { page } = await watch(t, "trouble");
  const shapes = await page.$$eval(".glyph", (glyphs) => {
    const shape = (glyph) => {
      const style = getComputedStyle(glyph);
      return [style.clipPath, style.borderRadius, style.borderTopStyle].join(" ");
    };
    return glyphs.map((glyph) => [glyph.dataset.level, shape(glyph)]);
  });
  const byLevel = new Map(shapes);
  assert.deepEqual([...byLevel.keys()].sort(), ["ask", "bad", "good", "quiet", "wait"]);
  assert.equal(new Set(byLevel.values()).size, 5, "five levels, five shapes");
  for (const badge of await page.$$eval("td[data-empty=false]", (cells) => cells.map((cell) => cell.innerText))) {
    assert.match(badge, /up to date|arriving|behind|throttled|quiet/);
  }
});

test("has what is done of other runs behind one press, and says how many there are", async (t) => {
  const { page } = await watch(t, "reports");
  const others = page.getByRole("button", { name: "Other runs" });
  const shown = () => page.locator("#reports .rows li").count();
  assert.match(await text(page, "#reports .count"), /^10, 5 open, 1 of other runs$/);
  assert.equal(await shown(), 10);
  assert.equal(await others.getAttribute("aria-pressed"), "false");
  await others.click();
  assert.equal(await shown(), 11);
  assert.equal(await others.getAttribute("aria-pressed"), "true");
  await others.click();
  assert.equal(await shown(), 10);
});

test("goes to the first report of another run where it shows them, however many are before it", async (t) => {
  const prepare = (page) => page.addInitScript(() => {
    const { parse } = JSON;
    JSON.parse = (...words) => {
      const view = parse(...words);
      if (!view?.endpoints) return view;
      const reports = Array.from({ length: 200 }, (_, i) => ({ ...view.reports.at(-1), number: 200 - i, run: 1 + Math.floor((199 - i) / 70) }));
      return { ...view, reports, run_number: 3 };
    };
  });
  for (const viewport of [{ width: 1280, height: 720 }, { width: 360, height: 740 }]) {
    const { page } = await watch(t, "reports", { prepare, viewport });
    const others = page.getByRole("button", { name: "Other runs" });
    const look = () => others.evaluate((button) => [getComputedStyle(button).borderColor, getComputedStyle(button).boxShadow].join());
    assert.match(await text(page, "#reports .count"), /^60, 140 of other runs$/);
    const off = await look();
    await others.press("Enter");
    assert.notEqual(await look(), off, "it is seen to be pressed");
    const first = page.locator('#reports li[data-key="140"]');
    await page.waitForFunction((row) => {
      const { top, bottom } = row.getBoundingClientRect(), list = row.parentNode.getBoundingClientRect();
      return top >= list.top - 1 && bottom <= list.bottom + 1;
    }, await first.elementHandle());
    assert.ok(await others.evaluate((button) => button === document.activeElement));
    assert.match(await text(page, "#reports .count"), /^60, 140 of other runs$/);
    await first.locator(".open").press("Enter");
    await others.press("Enter");
    assert.equal(await page.locator("#reports li").count(), 60);
  }
});

test("tells where each report is in its life, and what waits for the operator's word", async (t) => {
  const { page } = await watch(t, "reports");
  await page.getByRole("button", { name: "Other runs" }).click();
  const rows = await page.$$eval("#reports .rows li", (items) => items.map((item) => [item.dataset.level, item.innerText.replace(/More of report \d+/, "").replace(/\s+/g, " ").trim()]));
  const expected = [
    ["wait", /^waiting Drill/],
    ["wait", /^sending Cube/],
    ["wait", /^in doubt, asking Vent.*is being asked$/],
    ["ask", /^in doubt Gas.*another client reports, too · 2\.0 m from #24.* Send once more Call it done$/],
    ["ask", /^held Gas.*2 m from it/],
    ["good", /^scored \+1 Helmet.*found out from the run’s status$/],
    ["quiet", /^called done Helmet.*the operator calls it done$/],
    ["quiet", /^same as #17 Backpack/],
    ["quiet", /^withdrawn Backpack/],
    ["bad", /^refused Survivor.*status 422$/],
    ["good", /^scored \+1 Survivor.*#18 · 15 min ago · run 1$/],
  ];
  assert.equal(rows.length, expected.length);
  expected.forEach(([level, words], i) => {
    assert.equal(rows[i][0], level, rows[i][1]);
    assert.match(rows[i][1], words);
  });
  assert.match(await text(page, "#reports .count"), /^10, 5 open, 1 of other runs$/);
  assert.deepEqual(page.complaints, []);
});

test("puts in anybody's text as text", async (t) => {
  const { page } = await watch(t, "hostile");
  await said(page, "<script>window.pwned=1</script>");
  assert.equal(await page.evaluate(() => window.pwned), undefined);
  assert.equal(await page.locator("main img, main script").count(), 0);
  assert.deepEqual(page.complaints, []);
});

for (const path of ["", "display"]) {
  for (const scene of ["empty", "calm", "trouble", "reports", "hostile"]) {
    test(`/${path} fits every screen from a phone to 4K, and axe finds nothing wrong with it in the dark and by day: ${scene}`, async (t) => {
      const { page } = await watch(t, scene, { path, bypassCSP: true });
      for (const colorScheme of ["dark", "light"]) {
        await page.emulateMedia({ colorScheme });
        await axeFindsNothing(page, colorScheme);
      }
      for (const [width, height] of SIZES) {
        await page.setViewportSize({ width, height });
        const wide = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${wide} wide on ${width}`);
      }
    });
  }
}

test("shows its large figures large enough for two metres", async (t) => {
  const { page } = await watch(t, "calm");
  for (const [width, height] of SIZES.slice(2)) {
    await page.setViewportSize({ width, height });
    const size = await page.$eval("#clock", (clock) => parseFloat(getComputedStyle(clock).fontSize));
    assert.ok(size >= height / 12, `${size}px of ${height}`);
  }
});

test("is kept as pictures, for people to look at", async (t) => {
  for (const path of ["", "display"]) {
    const { page } = await watch(t, "reports", { path });
    for (const [width, height] of SIZES.filter(([width]) => width !== 768)) {
      await page.setViewportSize({ width, height });
      for (const colorScheme of ["dark", "light"]) {
        await page.emulateMedia({ colorScheme });
        await settled(page);
        await shoot(page, `${path || "page"}-${width}x${height}-${colorScheme}`);
      }
    }
  }
});

test("can be walked through by keyboard", async (t) => {
  const { page } = await watch(t, "calm");
  await page.waitForSelector("#run .newrun:enabled");
  await page.keyboard.press("Tab");
  await page.waitForFunction(() => document.activeElement.textContent === "Skip to the run");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.activeElement.id === "main");
  for (const section of ["run", "map"]) {
    await page.keyboard.press("Tab");
    await page.waitForFunction((section) => document.activeElement.closest("section")?.id === section, section);
  }
});

test("loads nothing from anywhere but the box", async (t) => {
  for (const path of ["", "display"]) {
    const { stage, page } = await watch(t, "calm", { path });
    await settled(page);
    await page.waitForTimeout(1000); // nothing with the next events, either
    assert.ok(page.requests.length > 10);
    for (const url of page.requests) assert.ok(url.startsWith(stage.url), url);
    assert.deepEqual(page.complaints, []);
  }
});

test("says that a silent box is lost, and recovers by itself", async (t) => {
  const { stage, page } = await watch(t, "calm");
  stage.freeze();
  await page.waitForSelector("body[data-link=lost]");
  await said(page, "The box does not answer");
  assert.match(await text(page, "#link"), /Box lost/);
  assert.match(await text(page, "#arriving"), /Unknown/);
  assert.match(await page.title(), /lost/);
  stage.thaw();
  await page.waitForSelector("body[data-link=live]");
  assert.equal(await text(page, "#attention"), "");
  assert.match(await text(page, "#arriving"), /Yes/);
});

test("says at once that a box that stopped is lost, and finds the next one at its address", async (t) => {
  const prepare = async ({ clock }) => {
    await clock.install();
    await clock.pauseAt(Date.now() + 60_000);
  };
  const { stage, page } = await watch(t, "calm", { prepare });
  await stage.end();
  await page.waitForSelector("body[data-link=lost]"); // while the page's clock stands still
  const next = await serve("trouble", stage.port);
  t.after(() => next.end());
  await page.clock.resume();
  await page.waitForSelector("body[data-link=live]");
  await said(page, "1 report is in doubt");
});
