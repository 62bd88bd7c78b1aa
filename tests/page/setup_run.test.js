// How long a run lasts, set on the set-up page.
import assert from "node:assert/strict";
import { test } from "node:test";
import { complaints, field, hears, ready, review, type } from "./setup_page.js";

const PATH = "runs.length_seconds", LEAST = 60, MOST = 86400;

test("takes the length of a run that it can have, and says what is wrong with another", async (t) => {
  const { ask, page } = await ready(t, "setup#all");
  await page.getByLabel("Search").fill("how long a run lasts");
  await page.getByText("1 found.").waitFor();
  for (const wrong of [String(LEAST - 1), String(MOST + 1), "1.5", "an hour", "-60", ""]) {
    await type(page, PATH, wrong);
    await field(page, PATH).locator(".wrong").filter({ hasText: /\S/ }).waitFor().catch((error) => {
      throw new Error(`${wrong}: ${error.message}`);
    });
  }
  for (const right of [LEAST, MOST, 1800]) {
    await type(page, PATH, String(right));
    await field(page, PATH).locator(".wrong").filter({ hasNotText: /\S/ }).waitFor({ state: "attached" });
  }
  await page.getByRole("button", { name: "Apply changes" }).click();
  assert.deepEqual(await review(page), [["Runs: length (s)", "3600", "1800"]]);
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await hears(page, /Applied\./);
  assert.equal((await ask("/adit/settings")).said.settings.runs.length_seconds, 1800);
  assert.equal((await ask("/adit/run")).said.run_seconds, 1800); // from which each face counts down: box/alike.test.js
  assert.deepEqual(complaints(page), []);
});
