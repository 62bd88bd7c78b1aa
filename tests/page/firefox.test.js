// The run page in Debian's Firefox, with a real box; all other stories use Chromium. Playwright drives it by WebDriver BiDi, which it
// offers under a private name and without errors of scripts; failed.js shows these.
import assert from "node:assert/strict";
import { test } from "node:test";
import playwright from "playwright-core";
import { box, OPERATOR, play } from "./box.js";
import { patient } from "./patience.js";
import { leave, shoot, visit } from "./stage.js";

const FIREFOX = process.env.FIREFOX ?? "/usr/bin/firefox-esr";
const CLASSIC = { "widget.gtk.overlay-scrollbars.enabled": false };  // scrollbars take room, as on Windows

/** Elements that cut their content; a list may scroll vertically. */
const cut = () =>
  [...document.querySelectorAll(".layers fieldset, main .scroll")].filter((node) => node.scrollWidth > node.clientWidth)
    .map((node) => `${node.closest("[id]").id} ${node.className}`);

test("works in Firefox: shows robots and reports, and sends a report", async (t) => {
  const { url, ask } = await box(t);
  for (const robot of ["ugv1", "ugv2", "ugv3", "spot1", "uav1", "uav2"]) await play(ask, robot);
  const browser = await playwright._bidiFirefox.launch({ executablePath: FIREFOX, firefoxUserPrefs: CLASSIC, timeout: patient(60_000) });
  t.after(() => browser.close());
  const page = await visit(browser, `${url}/login.html`);
  t.after(() => leave(page));
  await page.locator("#login").getByLabel("Password").fill(OPERATOR);
  await page.getByRole("button", { name: "Log in" }).click();
  await page.waitForSelector("body[data-link=live]");
  await page.locator("#robots li").filter({ hasText: "spot1" }).waitFor();
  await page.getByText("No report yet.").waitFor();

  await page.getByRole("button", { name: "New report" }).click();
  await page.locator("#compose .types").getByRole("button", { name: "Drill" }).click();
  for (const axis of ["x", "y", "z"]) await page.fill(`#compose input[name=${axis}]`, "1.5");
  await page.getByRole("button", { name: "Check" }).click();
  await page.getByRole("button", { name: "Send Drill" }).click();
  await page.locator("#reports li").filter({ hasText: "Drill" }).filter({ hasText: "answered" }).waitFor();

  await page.getByText("Layers", { exact: true }).click();
  await page.locator(".layers .robots").getByText("uav2").waitFor();
  assert.ok(await page.$eval(".layers fieldset", (panel) => panel.offsetWidth > panel.clientWidth + 4), "a classic scrollbar");
  assert.deepEqual(await page.evaluate(cut), []);
  await shoot(page, "firefox");
  assert.equal(await page.locator(".fault:visible").count(), 0);
  assert.deepEqual(page.complaints, []);
});
