// The smallest phones: no text is cut, and no texts overlap.
import assert from "node:assert/strict";
import { test } from "node:test";
import { retell } from "./retold.js";
import { openMore, settled, toTab, watch } from "./watch.js";

const PHONES = [[320, 640], [360, 740]];

/** Texts of one row that overlap, leave their section or are cut. */
const faults = (page) => page.evaluate(() => {
  const linesOf = (node) => {
    const range = document.createRange();
    range.selectNodeContents(node);
    return [...range.getClientRects()];
  };
  const isText = (node) => [...node.childNodes].some((child) => child.nodeType === Node.TEXT_NODE && child.data.trim());
  const textsIn = (node) => [...node.querySelectorAll("*")].filter((each) => isText(each) && each.checkVisibility() && !each.closest(".spoken, .pattern"));
  const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 4;
  const found = [];
  for (const row of document.querySelectorAll("main :is(li, tr, dl)")) {
    const texts = textsIn(row).map((node) => [node.textContent, linesOf(node)]);
    texts.forEach(([text, lines], i) => texts.slice(0, i).forEach(([other, under]) =>
      lines.some((line) => under.some((each) => meet(line, each))) && found.push(`"${text}" on "${other}"`)));
  }
  for (const section of document.querySelectorAll("main > section")) {
    const { right } = section.getBoundingClientRect();
    for (const node of textsIn(section)) if (linesOf(node).some((line) => line.right > right)) found.push(`"${node.textContent}" leaves ${section.id}`);
  }
  const isCut = (node) => getComputedStyle(node).textOverflow === "ellipsis" && node.scrollWidth > node.clientWidth;
  return found.concat(textsIn(document.body).filter(isCut).map((node) => `"${node.textContent}" is cut`));
});

for (const [width, height] of PHONES) {
  test(`no text is cut or overlaps another at ${width} x ${height}`, async (t) => {
    for (const scene of ["trouble", "reports"]) {
      const { page } = await watch(t, scene, { viewport: { width, height }, hasTouch: true });
      for (const tab of ["Run", "Map", "Reports", "Robots"]) {
        await toTab(page, tab);
        await settled(page);
        assert.deepEqual(await faults(page), [], `${scene}, ${tab}`);
      }
      await openMore(page);
      assert.deepEqual(await faults(page), [], `${scene}, More`);
      await page.getByRole("button", { name: "Keyboard" }).tap();
      await page.locator("#help[open]").waitFor();
      assert.deepEqual(await faults(page), [], `${scene}, the help`);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    }
  });
}

test("cuts neither the verdict nor its reason", async (t) => {
  const prepare = (page) => retell(page, () => (globalThis.verdict = { level: "wait", what: "17 of 20 arrive", why: "not spot3, spot4; uav5, uav6, ugv12 and 2 more silent; oldest other 22 s" }, (view) => ({ ...view, verdict: globalThis.verdict })));
  const { page } = await watch(t, "calm", { viewport: { width: 390, height: 844 }, prepare });
  const isWhole = async (what) => {
    await page.locator("#arriving", { hasText: what }).waitFor();
    const cut = await page.$$eval("#arriving strong, #arriving .reason", (parts) =>
      parts.filter((part) => part.scrollWidth > part.clientWidth + 1 || part.scrollHeight > part.clientHeight + 1).map((part) => part.textContent));
    assert.deepEqual(cut, []);
  };
  await isWhole("17 of 20");
  await page.evaluate(() => (globalThis.verdict = { level: "good", what: "17 of 20 arrive", why: "oldest 36 s; no map from r5, r12, r19" }));
  await isWhole("17 of 20 arrive");
});

test("scrolls to both reports of a pair and to the button that closes them", async (t) => {
  const { page } = await watch(t, "reports", { viewport: { width: 360, height: 740 }, hasTouch: true });
  await toTab(page, "Reports");
  await page.getByRole("button", { name: /^Show both on the map/ }).first().tap();
  const close = page.locator("#map .pair button");
  await close.waitFor();
  const { y, height } = await page.locator("#map .frame").boundingBox();
  assert.ok(y >= -1 && y + height <= 741, `from ${y} to ${y + height}`);
  assert.ok(await close.evaluate((button) => button === document.activeElement));
});
