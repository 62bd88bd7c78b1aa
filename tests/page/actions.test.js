import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { waitForText, toTab, watch } from "./watch.js";

const row = (page, number) => page.locator(`#reports li[data-key="${number}"]`);
const button = (page, name, number) => page.getByRole("button", { name: `${name}: report ${number}` });
/** Opens a row, and presses again if the row was moving, because a moving row takes no press. */
async function opened(page, number) {
  const isOpen = row(page, number).locator(".open[aria-expanded=true]");
  do await row(page, number).locator(".open").click();
  while (!(await isOpen.waitFor({ timeout: 2000 }).then(() => true, () => false)));
}
const becomes = (page, number, words) =>
  page.waitForFunction(([number, words]) => document.querySelector(`#reports li[data-key="${number}"]`)?.innerText.includes(words), [number, words]);

test("each state of a report has words and a list of actions", () => {
  const text = (file) => `${readFileSync(new URL(`../../firmware/${file}`, import.meta.url))}`;
  const states = text("rules/dispatch/report.hpp").match(/kStateWords\[\] = \{([^}]*)\}/)[1].match(/\w+/g);
  assert.ok(states.length >= 8);
  const words = text("doors/site/files/arriving.js"), actions = text("doors/site/files/actions.js");
  for (const state of states) {
    assert.ok(words.includes(`case "${state}":`), `arriving.js: ${state}`);
    assert.ok(actions.includes(`\n  ${state}: [`), `actions.js: ${state}`);
  }
});

test("offers for each report only the actions that its state allows", async (t) => {
  const { page } = await watch(t, "reports");
  await page.getByRole("button", { name: "All runs" }).click();
  const expected = {
    28: ["Hold", "Withdraw"], 27: [], 26: ["Send again", "Settle"], 25: ["Send again", "Settle"], 24: ["Send", "Correct", "Withdraw"],
    23: ["Resubmit"], 22: ["Resubmit"], 21: ["Send again"], 20: ["Send"], 19: ["Send again"], 18: ["Resubmit"],
  };
  for (const [number, actions] of Object.entries(expected)) {
    await opened(page, number);
    assert.deepEqual(await row(page, number).locator(".actions button").allTextContents(), actions, `report ${number}`);
  }
});

test("shows reports that need the operator, and the others after one press", async (t) => {
  const { page } = await watch(t, "reports");
  assert.equal(await row(page, 25).locator(".actions button").count(), 2);
  assert.equal(await row(page, 23).locator(".actions button").count(), 0);
  await row(page, 23).locator(".open").click();
  assert.equal(await row(page, 23).locator(".actions button").count(), 1);
  await becomes(page, 23, "From 10.0.0.5");
  await row(page, 23).locator(".open").click();
  assert.equal(await row(page, 23).locator(".actions button").count(), 0);
});

test("performs free actions at once", async (t) => {
  const { page } = await watch(t, "reports");
  await button(page, "Withdraw", 24).click();
  await becomes(page, 24, "withdrawn");
  await becomes(page, 24, "Withdrawn.");
  await button(page, "Settle", 25).click();
  await becomes(page, 25, "settled");
  await row(page, 20).locator(".open").click();
  await row(page, 28).locator(".open").click();
  await button(page, "Hold", 28).click();
  await becomes(page, 28, "held");
  assert.deepEqual(page.complaints, []);
});

test("asks before an action that costs a report, and does nothing on no", async (t) => {
  const { page } = await watch(t, "reports");
  await button(page, "Send again", 25).click();
  const question = page.getByRole("alertdialog");
  assert.match(await question.textContent(), /report 25, Gas.*recorded twice.*uses up a report.*18 reports are left/s);
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Cancel");
  await page.keyboard.press("Escape");
  await question.waitFor({ state: "hidden" });
  assert.match(await row(page, 25).innerText(), /in doubt/);
  await button(page, "Send again", 25).click();
  await question.getByRole("button", { name: "Cancel" }).click();
  assert.match(await row(page, 25).innerText(), /in doubt/);
  await button(page, "Send again", 25).click();
  await question.getByRole("button", { name: "Send again" }).click();
  await becomes(page, 25, "queued");
});

test("asks before it sends a near duplicate or a withdrawn report", async (t) => {
  const { page } = await watch(t, "reports");
  const question = page.getByRole("alertdialog");
  await button(page, "Send", 24).click();
  assert.match(await question.textContent(), /report 24, Gas.*close by.*uses up a report.*18 reports are left/s);
  await question.getByRole("button", { name: "Cancel" }).click();
  assert.match(await row(page, 24).innerText(), /held/);
  await row(page, 20).locator(".open").click();
  await button(page, "Send", 20).click();
  assert.match(await question.textContent(), /report 20.*withdrawn.*uses up a report/s);
  await question.getByRole("button", { name: "Send" }).click();
  await becomes(page, 20, "queued");
});

test("resubmits as a new report and shows its number", async (t) => {
  const { page } = await watch(t, "reports");
  await row(page, 23).locator(".open").click();
  await button(page, "Resubmit", 23).click();
  await page.getByRole("alertdialog").getByRole("button", { name: "Resubmit" }).click();
  await becomes(page, 23, "as report 29");
  await becomes(page, 29, "queued");
});

test("shows the box's sentence if an action is impossible", async (t) => {
  const { page } = await watch(t, "reports");
  await row(page, 19).locator(".open").click();
  await button(page, "Send again", 19).click();
  await becomes(page, 19, "the step could not be written down; try again");
  assert.equal(await row(page, 19).locator(".outcome").getAttribute("data-bad"), "true");
});

test("shows a viewer the reports and why he has no actions", async (t) => {
  const prepare = (page) => page.route("**/adit/session", (route) => route.fulfill({ json: { role: "viewer", csrf: "x", first_start: false } }));
  const { page } = await watch(t, "reports", { prepare });
  await waitForText(page, "Only an operator can act");
  for (const one of await page.locator("#reports .actions button, #reports button.compose").all()) assert.ok(await one.isDisabled());
  await page.keyboard.press("n");
  assert.ok(await page.locator("#compose").isHidden());
});

test("offers no action while the box is lost, and all once it is back", async (t) => {
  const { stage, page } = await watch(t, "reports");
  stage.freeze();
  await page.waitForSelector("body[data-link=lost]");
  await waitForText(page, "The box sends no data to this page, so you cannot act");
  assert.ok(await button(page, "Send", 24).isDisabled());
  stage.thaw();
  await page.waitForSelector("body[data-link=live]");
  await page.waitForFunction(() => !document.querySelector("#reports .actions button").disabled);
});

test("has no button smaller than a gloved finger", async (t) => {
  for (const viewport of [{ width: 390, height: 844 }, { width: 1280, height: 720 }, { width: 3840, height: 2160 }]) {
    const { page } = await watch(t, "reports", { viewport });
    await toTab(page, "Reports");
    await row(page, 23).locator(".open").click();
    const small = await page.$$eval("button, .head a, .layers label, main input[type=range], .strip a", (nodes) =>
      nodes.map((node) => [node.textContent || node.type, node.getBoundingClientRect()]).filter(([, box]) => box.width && (box.height < 44 || box.width < 44)).map(([name, box]) => `${name}: ${box.width} x ${box.height}`));
    assert.deepEqual(small, [], `${viewport.width}`);
  }
});

test("leaves the focus in the row if an action changes its buttons", async (t) => {
  const { page } = await watch(t, "reports");
  await row(page, 28).locator(".open").click();
  for (const [number, action, words] of [[24, "Withdraw", "Withdrawn."], [28, "Hold", "Held until"], [25, "Settle", "Settled."]]) {
    await button(page, action, number).focus();
    await page.waitForSelector("[data-given]", { state: "detached" });
    await page.keyboard.press("Enter");
    await becomes(page, number, words);
    await button(page, action, number).waitFor({ state: "detached" });
    await page.waitForFunction((number) => document.activeElement.closest("li")?.dataset.key === String(number), number);
  }
});
