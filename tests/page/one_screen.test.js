// In every scene, the run page and the display fit each screen, without axe faults. The scenes `trouble` and `reports` contain every
// colour and are shown in all themes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { axeFindsNothing, watch } from "./watch.js";

const SIZES = [[390, 844], [768, 1024], [1280, 720], [1920, 1080], [3840, 2160]];

for (const path of ["", "display"]) {
  for (const scene of ["empty", "calm", "trouble", "reports", "hostile"]) {
    test(`/${path} is one screen from a phone to 4K, without axe faults: ${scene}`, async (t) => {
      const { page } = await watch(t, scene, { path, bypassCSP: true });
      for (const theme of ["trouble", "reports"].includes(scene) ? ["dark", "light", "red"] : ["dark"]) {
        await page.evaluate((theme) => (document.documentElement.dataset.theme = theme), theme);
        await axeFindsNothing(page, theme);
      }
      for (const [width, height] of SIZES) {
        await page.setViewportSize({ width, height });
        const [wide, tall] = await page.evaluate(({ documentElement: page } = document) => [page.scrollWidth, page.scrollHeight]);
        assert.ok(wide <= width && tall <= height, `${wide} x ${tall} on ${width} x ${height}`);
        const outside = await page.$$eval("ol button, ul button", (buttons) => buttons.map((button) => {
          const [own, list] = [button, button.closest("ol, ul")].map((node) => node.getBoundingClientRect());
          return own.right > list.right + 1 ? button.textContent : "";
        }).filter(Boolean));
        assert.deepEqual(outside, [], `${width} x ${height}`);
      }
    });
  }
}
