// The system page's log.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { serve } from "./stage.js";
import { come, OPERATOR, rows, untilRows } from "./system_page.js";

test("shows the growing log, newest first", async (t) => {
  const { stage, page } = await come(t);
  await untilRows(page, 4);
  const said = await rows(page);
  assert.match(said[0], /error the ledger cannot be written note=disk I\/O error/);
  assert.match(said[3], /notice listening/);
  stage.play("say the cable was pulled");
  await page.locator("#log li", { hasText: "the cable was pulled" }).waitFor();
  assert.match((await rows(page))[0], /the cable was pulled/);
  assert.equal(await page.evaluate(() => window.pwned), undefined, "text in the log was executed");
  assert.deepEqual(page.complaints, []);
});

test("filters the log, and exports the same lines as a file", async (t) => {
  const { page } = await come(t);
  await page.getByLabel("Level").selectOption("Warnings and worse");
  await untilRows(page, 2);
  await page.getByLabel("Search the log").fill("LEDGER");
  await untilRows(page, 1);
  assert.match((await rows(page))[0], /the ledger/);
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("link", { name: "Download" }).click()]);
  assert.equal(download.suggestedFilename(), "adit-log.txt");
  assert.equal(await readFile(await download.path(), "utf8"), "error: the ledger cannot be written note=disk I/O error\n");
  await page.getByLabel("Search the log").fill("nobody said this & that");
  await page.getByText("No record matches.").waitFor();
  await page.getByLabel("Search the log").fill("");
  await page.getByLabel("Level").selectOption("All records");
  await untilRows(page, 4);
});

test("says when the box is lost, and shows the new log after a restart", async (t) => {
  const { stage, page } = await come(t);
  await untilRows(page, 4);
  for (let i = 0; i < 3; ++i) stage.play(`say ${i}`);
  await untilRows(page, 7);
  await stage.end();
  await page.locator("#link .text", { hasText: "Box lost" }).waitFor();
  const again = await serve("calm", stage.port);
  t.after(() => again.end());
  await page.waitForURL(/login\.html/);  // its sessions are gone too
  await page.locator("#login").getByLabel("Password").fill(OPERATOR);
  await page.keyboard.press("Enter");
  await untilRows(page, 4);
});
