// Set-up's bar of typed changes: as wide as its card, and over no field that gets the focus.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ready, type } from "./setup_page.js";

test("has the bar of typed changes as wide as its card, and below each field that gets the focus", async (t) => {
  const { page } = await ready(t, "setup#post");
  await type(page, "command_post.scoring.address", "10.100.1.2");
  await page.locator("#typed").getByText("1 change not yet applied.").waitFor();
  for (const [width, height] of [[390, 600], [1280, 480], [1920, 600]]) {
    await page.setViewportSize({ width, height });
    const [card, bar] = await page.$$eval("#step-post, #typed", (nodes) => nodes.map((node) => node.getBoundingClientRect().toJSON()));
    assert.ok(Math.abs(card.left - bar.left) < 1 && Math.abs(card.right - bar.right) < 1, `${width}: ${bar.left} to ${bar.right} of ${card.left} to ${card.right}`);
    await page.evaluate(() => scrollTo(0, 0));
    const covered = await page.$$eval("#step-post input", (inputs) => inputs.filter((input) => {
      input.focus();
      return input.getBoundingClientRect().bottom > document.getElementById("typed").getBoundingClientRect().top;
    }).map((input) => input.id));
    assert.deepEqual(covered, [], `${width}`);
  }
});
