// Names on the map, in a browser: no name under an overlay, and no names on a phone's small map.
import assert from "node:assert/strict";
import { test } from "node:test";
import { until } from "./box.js";
import { retell } from "./retold.js";
import { hears, settled, toTab, watch } from "./watch.js";

/** Reports all over the map. `names()` has each written name with its box in pixels of the map. */
async function crowded(page) {
  await page.addInitScript(() => {
    globalThis.written = [];
    const { fillText, resetTransform } = CanvasRenderingContext2D.prototype, rim = (side) => (side - side / 1.4) / 2;
    CanvasRenderingContext2D.prototype.resetTransform = function () {  // begins a new drawing
      globalThis.written = globalThis.written.filter(({ canvas }) => canvas !== this.canvas);
      return resetTransform.call(this);
    };
    CanvasRenderingContext2D.prototype.fillText = function (text, left, middle) {
      const { canvas } = this, size = parseFloat(this.font.match(/([\d.]+)px/)[1]);
      if (!canvas.isConnected) {  // an offscreen layer: larger than the visible map by a fifth on each side, at most 200 pixels
        const off = [canvas.width, canvas.height].map((side) => Math.ceil(Math.min(200, rim(side))));
        const from = left - off[0], at = middle - off[1];
        globalThis.written.push({ canvas, text, box: [from, at - size / 2, from + this.measureText(text).width, at + size / 2] });
      }
      return fillText.call(this, text, left, middle);
    };
  });
  await retell(page, () => (view) => {
    const like = view.reports.find(({ position, run }) => position && run === view.run_number);
    if (!like) return view;
    const reports = Array.from({ length: 180 }, (_, i) => ({ ...like, number: i + 1, type: "Fire Extinguisher", position: { x: -30 + 5 * (i % 18), y: -20 + 3 * Math.floor(i / 18), z: 0 } }));
    return { ...view, reports: reports.reverse() };
  });
}
const names = (page) => page.evaluate(() => globalThis.written.filter(({ text }) => text.startsWith("#")).map(({ text, box }) => ({ text, box })));
/** Zooms in until the reports are not grouped. */
async function zoomToNames(page) {
  await until(async () => {
    await page.getByRole("button", { name: "Zoom in" }).click();
    await hears(page, 2);
    await settled(page);
    return (await names(page)).length > 5;
  }, "names");
}
const covers = (page) => page.$$eval("#map :is(.zoom, .follow, .legend)", (nodes) => {
  const { left, top } = document.querySelector("#map .frame canvas").getBoundingClientRect();
  return nodes.filter((node) => node.offsetWidth).map((node) => node.getBoundingClientRect()).map((box) => [box.left - left, box.top - top, box.right - left, box.bottom - top]);
});
const overlap = (a, b) => a[0] < b[2] - 1 && a[2] > b[0] + 1 && a[1] < b[3] - 1 && a[3] > b[1] + 1;

test("writes no name under the map's tools and its legend", async (t) => {
  const { page } = await watch(t, "calm", { prepare: crowded });
  for (const [width, height] of [[1280, 720], [1920, 1080], [390, 844]]) {
    await page.setViewportSize({ width, height });
    await toTab(page, "Map");
    await settled(page);
    await page.locator("#map .legend").waitFor();
    await page.getByRole("button", { name: "All", exact: true }).click();
    await zoomToNames(page);
    const over = await covers(page);
    assert.equal(over.length, 3);
    const hidden = (await names(page)).filter(({ box }) => over.some((each) => overlap(box, each)));
    assert.deepEqual(hidden, [], `${width} x ${height}`);
  }
});

test("writes no name on the small map of a phone's first tab", async (t) => {
  const { page } = await watch(t, "calm", { prepare: crowded, viewport: { width: 390, height: 844 } });
  await toTab(page, "Map");
  await settled(page);
  await zoomToNames(page);
  await toTab(page, "Run");
  await until(async () => (await names(page)).length === 0, "the names to go");
  assert.ok(!(await page.locator("#map .legend").isVisible()));
});
