// The export for a spare box and the box's stick, on the system page. box/spare.test.js has both boxes in full.
import assert from "node:assert/strict";
import { test } from "node:test";
import { axeFindsNothing } from "./axe.js";
import { come, OPERATOR, pressThrice, VIEWER } from "./system_page.js";

const STAGED = "adit-10.0.0.1-20250615T150640Z.adit-spare";

async function spareOf(t) {
  const { page } = await come(t, OPERATOR, { bypassCSP: true });  // for axe
  const section = page.locator("#spare"), waitForText = (words) => section.getByText(words).waitFor();
  await section.getByRole("button", { name: "Start standby, export to the stick" }).waitFor();
  return { page, section, waitForText, press: (name) => section.getByRole("button", { name }).click(), yes: () => page.locator("#confirm button.main").click() };
}

const asked = (page, path) => page.requests.filter((url) => url.endsWith(path)).length;

test("one press puts the box on standby and writes its export to the stick; a failure can be retried, and it says when the stick may be removed", async (t) => {
  const { page, section, waitForText, press, yes } = await spareOf(t);
  await press("Start standby, export to the stick");
  await page.locator("#confirm").getByRole("button", { name: "Cancel" }).click();
  assert.equal(asked(page, "/adit/spare/standby"), 0, "a cancelled action was requested");
  await press("Start standby, export to the stick");
  await yes();
  await waitForText("The stick is full.");
  assert.equal(await section.locator(".stick p").getAttribute("data-bad"), "true");
  assert.equal(await section.locator("dd").first().innerText(), "1234 5678 9012 3456");
  await press("Export to the stick");
  const onlyWrites = { hasText: "Leave the stick in.", hasNot: page.getByRole("button", { name: "Export to the stick" }) };
  await page.locator("#spare").filter(onlyWrites).waitFor();  // one at a time
  await waitForText(`The export is on the stick and was read back: ${STAGED}. You can unplug the stick.`);
  assert.equal(await section.locator(".stick p").getAttribute("data-bad"), "false");
  await axeFindsNothing(page, "an export on a stick");
  assert.deepEqual(page.complaints, []);
});

test("a box is not put on standby if its stick could not be written", async (t) => {
  const { page, waitForText, press } = await spareOf(t);
  await page.route("**/adit/spare", async (route) => {
    const answer = await route.fetch(), view = await answer.json();
    await route.fulfill({ response: answer, json: { ...view, stick: { ...view.stick, hindrance: "there is no stick in the box" } } });
  });
  await press("Start standby, export to the stick");
  await waitForText("The box does not start standby: there is no stick in the box.");
  assert.equal(asked(page, "/adit/spare/standby"), 0);
});

test("a box in service says why the stick cannot be read", async (t) => {
  const { page, waitForText } = await spareOf(t);
  await page.route("**/adit/spare", async (route) => {
    const answer = await route.fetch(), view = await answer.json();
    await route.fulfill({ response: answer, json: { ...view, stick: { ...view.stick, exports: [], unreadable: "the stick is damaged" } } });
  });
  await waitForText("The stick is damaged.");
});

test("an export on the stick is offered by its box and time, and asks for its code like an uploaded one", async (t) => {
  const { page, section, waitForText, press } = await spareOf(t);
  const when = await page.evaluate(() => new Date(1.75e12).toLocaleString());
  await section.getByRole("button", { name: `Import from the stick: the box at 10.0.0.7, ${when}` }).waitFor();
  await press("Import from the stick: zip.adit-spare");
  await waitForText("The file is not an export from Adit.");
  await press("Import from the stick: the box at 10.0.0.7");
  await waitForText("An export was imported.");
  await section.getByLabel("Code of the export").waitFor();
  assert.equal(await section.getByRole("button", { name: /from the stick|to the stick/ }).count(), 0);
  await axeFindsNothing(page, "an export from a stick");
  await press("Forget the export");
  await section.getByRole("button", { name: "Import from the stick: zip.adit-spare" }).waitFor();
  assert.deepEqual(page.complaints, []);
});

test("repeated presses count once until the page shows the first one's result", async (t) => {
  const { page, section, waitForText } = await spareOf(t);
  const count = await pressThrice(page, /\/adit\/spare/, section.getByRole("button", { name: "Import from the stick: zip.adit-spare" }));
  await waitForText("The file is not an export from Adit.");
  assert.deepEqual(count, { presses: 3, posts: 1 });
  assert.deepEqual(page.complaints, []);
});

test("the page does not mention sticks if the box cannot use them", async (t) => {
  const { page, section } = await spareOf(t);
  await page.route("**/adit/spare", async (route) => {
    const answer = await route.fetch();
    await route.fulfill({ response: answer, json: { ...(await answer.json()), stick: null } });
  });
  await section.getByRole("button", { name: "Start standby, export to the stick" }).waitFor({ state: "hidden" });
  assert.equal(await section.getByRole("button", { name: /stick/ }).count(), 0);
  assert.equal(await section.getByRole("button", { name: "Start standby and export", exact: true }).count(), 1);
});

test("a viewer does not see the section", async (t) => {
  const { page } = await come(t, VIEWER);
  assert.equal(await page.locator("#spare").isVisible(), false);
});
