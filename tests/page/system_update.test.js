// The system page's updates and restart.
import assert from "node:assert/strict";
import { test } from "node:test";
import { come, pressThrice, VIEWER } from "./system_page.js";

const updating = (page) => page.locator("#update .body");
/** Begins like a bundle: as a squashfs of 40 bytes. */
const aFile = (text) => ({ name: "adit-a-board-0.2.0.raucb", mimeType: "", buffer: Buffer.from(`hsqs${"\0".repeat(36)}(${"\0".repeat(7)}${text}`, "latin1") });

test("shows the running version and the result of the last update", async (t) => {
  const { page } = await come(t);
  await updating(page).getByText("0.1.0, slot A. 0.0.9 was left: the update did not become healthy in three starts").waitFor();
  assert.deepEqual(page.complaints, []);
});

test("installs an update from a file, and says why a file was rejected", async (t) => {
  const { page } = await come(t);
  const file = updating(page).getByLabel("Update file"), install = updating(page).getByRole("button", { name: "Install", exact: true });
  await file.setInputFiles({ ...aFile(""), buffer: Buffer.alloc(1 << 20, "no update") });
  await install.click();
  await updating(page).getByText("the file is not an update").waitFor();
  assert.match(page.complaints.splice(0).join(), /^[^,]*status of 422[^,]*$/);  // the browser's own message
  await file.setInputFiles(aFile("xxx"));
  await install.click();
  await updating(page).getByText("Invalid bundle format: Signature size is 0").waitFor();
  await file.setInputFiles(aFile("good"));
  await install.click();
  await updating(page).getByText("0.1.0, slot A. 0.2.0 is used after a restart").waitFor();
  assert.deepEqual(page.complaints, []);
});

test("keeps the sentence of a rejection when later states arrive", async (t) => {
  const { page } = await come(t);
  const answered = (method) => page.waitForResponse((answer) => answer.url().endsWith("/adit/update") && answer.request().method() === method);
  await updating(page).getByLabel("Update file").setInputFiles({ ...aFile(""), buffer: Buffer.alloc(1 << 20, "no update") });
  const refused = answered("POST");
  await page.route("**/adit/update", async (route) => {
    if (route.request().method() === "POST") return route.continue();
    const answer = await route.fetch();
    await refused;  // earlier requests are answered after it
    await route.fulfill({ response: answer });
  });
  await updating(page).getByRole("button", { name: "Install", exact: true }).click();
  await refused;
  for (let shown = 0; shown < 3; ++shown) await answered("GET");  // when the next state is requested, the one before was shown
  assert.ok(await updating(page).getByText("the file is not an update").isVisible());
});

test("counts repeated presses once until it shows the first one's result", async (t) => {
  const { page } = await come(t);
  await updating(page).getByLabel("Update file").setInputFiles(aFile("good"));
  const count = await pressThrice(page, /\/adit\/update$/, updating(page).getByRole("button", { name: "Install", exact: true }));
  await updating(page).getByText("0.2.0 is used after a restart").waitFor();
  assert.deepEqual(count, { presses: 3, posts: 1 });
  assert.deepEqual(page.complaints, []);
});

test("installs an update from a stick, and shows its progress", async (t) => {
  const { page } = await come(t);
  await updating(page).getByRole("button", { name: "Install 0.3.0 from the stick" }).click();
  await updating(page).getByText("The box is installing.").waitFor();
  assert.equal(await updating(page).getByRole("progressbar").getAttribute("value"), "40");
  assert.equal(await updating(page).getByRole("button").count(), 0, "one at a time");
});

test("restarts the box only if the operator confirms while a report is queued", async (t) => {
  const { page } = await come(t);
  const restart = page.locator("#restart"), dialog = page.locator("#confirm");
  const press = (name) => dialog.getByRole("button", { name, exact: true }).click();
  await restart.getByRole("button", { name: "Restart the box" }).click();
  await dialog.getByText("The restart takes about a minute.").waitFor();
  await press("Cancel");
  assert.ok(!page.requests.some((url) => url.endsWith("/adit/update/restart")), "a cancelled action was requested");
  await restart.getByRole("button", { name: "Restart the box" }).click();
  await press("Restart");
  await dialog.getByText("1 report waits to be sent.").waitFor();
  await press("Cancel");
  await restart.getByText("The box was not restarted.").waitFor();
  await restart.getByRole("button", { name: "Restart the box" }).click();
  await press("Restart");
  await dialog.getByText("1 report waits to be sent.").waitFor();
  await press("Restart");
  await restart.getByText("The box is restarting.").waitFor();
  await page.waitForFunction(() => document.querySelector("#restart button").disabled);
});

const STRAY = "slot A with 0.1.0 runs, and slot B with 0.2.0 was good last";

/** The page of a box that runs from an unexpected slot, until it is told to stay. */
async function strayed(t, password) {
  const { page } = await come(t, password);
  let stray = STRAY;
  await page.route("**/adit/update", async (route) => {
    const answer = await route.fetch();
    await route.fulfill({ response: answer, json: { ...(await answer.json()), stray } });
  });
  await page.route("**/adit/update/stay", (route) => {
    stray = null;
    return route.continue();
  });
  await updating(page).getByText(`An unexpected slot is running: ${STRAY}.`).waitFor();
  return page;
}

test("goes back from an unexpected slot after a confirmation", async (t) => {
  const page = await strayed(t), dialog = page.locator("#confirm");
  const press = (name) => dialog.getByRole("button", { name, exact: true }).click();
  await updating(page).getByRole("button", { name: "Go back" }).click();
  await press("Cancel");
  assert.ok(!page.requests.some((url) => url.endsWith("/adit/update/back")), "a cancelled action was requested");
  await updating(page).getByRole("button", { name: "Go back" }).click();
  await press("Go back");
  await dialog.getByText("1 report waits to be sent.").waitFor();
  await press("Go back");
  await updating(page).locator(".stray").getByText("The box is restarting.").waitFor();
});

test("stays with the running slot after a confirmation", async (t) => {
  const page = await strayed(t), dialog = page.locator("#confirm");
  await updating(page).getByRole("button", { name: "Stay with slot A" }).click();
  await dialog.getByRole("button", { name: "Stay", exact: true }).click();
  await updating(page).getByText("An unexpected slot is running").waitFor({ state: "hidden" });
  assert.ok(page.requests.some((url) => url.endsWith("/adit/update/stay")));
});

test("tells a viewer that another slot is running, without buttons", async (t) => {
  const page = await strayed(t, VIEWER);
  assert.equal(await updating(page).getByRole("button").count(), 0);
});

test("says why it cannot restart the box, and what to do", async (t) => {
  const { page } = await come(t);
  let runsHere = true, newer = null, notKnown = null;
  await page.route("**/adit/update", (route) => route.fulfill({ json: { managed: false, why: "cannot read the status of adit-update: Input/output error", runs_here: runsHere, doing: null, progress: null, refusal: null, last: null, stick: null, stick_why: null, newer, newer_why: notKnown } }));
  await page.locator("#restart").getByText("This page cannot restart the box: cannot read the status of adit-update: Input/output error. To restart it now, switch the box off and on.").waitFor();
  assert.equal(await page.locator("#restart").getByRole("button").count(), 0);
  runsHere = false;  // a PC
  for (const id of ["#update", "#restart"]) await page.locator(id).waitFor({ state: "hidden" });
  newer = "0.2.0";
  await updating(page).getByText('apt has 0.2.0. To install it, run "apt upgrade" on this machine.').waitFor();
  [newer, notKnown] = [null, "no permission"];
  await updating(page).getByText("The newer version of apt is not known: no permission.").waitFor();
});

test("shows a viewer the update without buttons", async (t) => {
  const { page } = await come(t, VIEWER);
  await updating(page).getByText("0.1.0, slot A").waitFor();
  assert.equal(await updating(page).getByRole("button").count(), 0);
  assert.equal(await page.locator("#restart").getByRole("button").count(), 0);
});
