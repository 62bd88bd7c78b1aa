import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { come, freePort, freshBox, LOOKING, TOKENS, until } from "./fresh_box.js";
import { complaints, COURSES, field, fill, hears, openCards, ready, review, step, type } from "./setup_page.js";

/** Runs the Test, and returns each endpoint's steps with their states. */
async function tried(page) {
  await page.getByRole("button", { name: "Run the test" }).click();
  await page.locator("#step-test .outcome", { hasText: "No report was used up." }).waitFor();
  return page.$$eval("#step-test .trial", (all) => all.map((each) => [...each.querySelectorAll("ol .badge")].map((badge) => badge.textContent.trim())));
}

test("tests each endpoint step by step, and says what to do if a step fails", async (t) => {
  const { box, ask, page } = await ready(t, "setup#test");
  const unreached = await tried(page);
  assert.equal(unreached.length, 2);
  for (const states of unreached) assert.deepEqual(states.slice(3), ["bad", "skipped", "skipped"]);
  const reach = page.locator(".trial li", { hasText: "Connection" }).first();
  assert.notEqual(await reach.locator(".said").innerText(), "");
  assert.notEqual(await reach.locator(".advice").innerText(), "");
  await step(page, "Test").getByText("failed").waitFor();

  const { settings, tag } = (await ask("/adit/settings")).said;
  Object.assign(settings.command_post.scoring, { port: box.scoring });
  Object.assign(settings.command_post.mapping, { port: box.mapping });
  let learn;
  const learns = new Promise((done) => (learn = done));
  await page.route("**/adit/settings", (route) => learns.then(() => route.continue()));
  await ask("/adit/settings", { settings, base: tag });
  const free = async () => (await ask("/adit/settings").catch(() => ({}))).said?.applying === false;
  await until(free, "the settings to be applied");
  await ask("/adit/tokens", { name: "scoring", token: "not-the-token" });
  await until(free, "the token to be applied");
  await hears(page, "Live");
  const [scoring, mapping] = await tried(page);
  assert.deepEqual([scoring[3], scoring[4], mapping[4]], ["good", "bad", "good"]);
  learn();  // of the other operator's settings, only now: they are those that were tested
  await page.waitForFunction((port) => document.querySelector('[data-path="command_post.scoring.port"] input').value === port, String(box.scoring));
  assert.match(await page.locator("#step-test .outcome").innerText(), /No report was used up/);
  assert.notEqual(await page.locator(".trial li", { hasText: "Token" }).first().locator(".advice").innerText(), "");
});

test("never shows tokens, and says which exist", async (t) => {
  const { box, ask, page } = await ready(t, "setup#tokens");
  await openCards(page, "Team’s token");
  const token = page.locator("form.token", { hasText: "Team’s token" });
  await token.getByText("is set").waitFor();
  const input = token.getByLabel("Team’s token", { exact: true });
  assert.equal(await input.inputValue(), "");
  assert.equal(await input.getAttribute("type"), "password");
  await token.getByRole("button", { name: "Set" }).click();
  await token.getByText("type a token first").waitFor();
  for (const wrong of ["two words", "grüße", "x".repeat(257)]) {
    await input.fill(wrong);
    await token.getByText("expected 1 to 256 visible ASCII characters").waitFor();
    await token.getByRole("button", { name: "Set" }).click();
    await token.getByText("Team’s token: expected null or 1 to 256 visible ASCII characters").waitFor();
    assert.equal(await input.inputValue(), wrong, "the typed value is lost");
  }
  await token.getByRole("button", { name: "Show" }).click();
  assert.equal(await input.getAttribute("type"), "text");
  await token.getByRole("button", { name: "Hide" }).click();
  await input.fill("another-token");
  await page.keyboard.press("Enter");
  await token.getByText("Set.").waitFor();
  assert.equal(await input.inputValue(), "");
  assert.equal(readFileSync(join(box.state, "secrets/team.token"), "utf8").split("\n")[0], "another-token");
  const asTeam = (bearer) => fetch(`${box.url}adit/run`, { headers: { Authorization: `Bearer ${bearer}` } }).then(({ status }) => status);
  assert.deepEqual([await asTeam("another-token"), await asTeam(TOKENS.team)], [200, 401]);
  await token.getByRole("button", { name: "Remove" }).click();
  await page.locator("#review").getByRole("button", { name: "Cancel" }).click();
  await token.getByRole("button", { name: "Remove" }).click();
  await page.locator("#review").getByRole("button", { name: "Remove" }).click();
  await token.getByText("Removed.").waitFor();
  assert.ok(!existsSync(join(box.state, "secrets/team.token")));
  assert.equal(await asTeam(TOKENS.team), 200, "the token in use is valid again");
  const shown = JSON.stringify((await ask("/adit/settings")).said) + (await page.content());
  for (const secret of [...Object.values(TOKENS), "another-token"]) assert.ok(!shown.includes(secret));
  assert.deepEqual(complaints(page, "422"), []);
});

test("switches to another course by one press, after showing the changes", async (t) => {
  const { box, ask, page } = await ready(t, "setup#courses", { courses: [COURSES[0]] });
  await page.getByRole("button", { name: "Add a course" }).click();
  await page.locator("[data-list=courses] .item .course", { hasText: /New course\s*not applied yet/ }).waitFor();
  await page.keyboard.type("B");
  for (const [name, value] of [["scoring.address", "127.0.0.1"], ["scoring.port", box.scoring], ["mapping.address", "127.0.0.1"], ["mapping.port", box.mapping]]) {
    await type(page, `courses[1].${name}`, String(value));
  }
  assert.ok(await page.getByRole("button", { name: "Switch to Course A" }).isDisabled(), "typed changes must be saved first");
  await hears(page, "1 change not yet applied");
  await page.getByRole("button", { name: "Apply changes" }).click();
  await review(page);
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await hears(page, /Applied\./);
  await step(page, "Courses").getByText("2 saved").waitFor();
  const own = page.locator("[data-list=courses] .item").nth(1).locator("form.token", { hasText: "Own scoring token" });
  await own.locator("input").fill(TOKENS.scoring);
  await own.getByRole("button", { name: "Set" }).click();
  await own.getByText("Set.", { exact: true }).waitFor();
  await page.getByRole("button", { name: "Switch to Course B" }).click();
  assert.deepEqual(await review(page), [
    ["Course", "No course", "Course B"],
    ["Scoring address", "127.0.0.1:1", `127.0.0.1:${box.scoring}`], ["Mapping address", "127.0.0.1:2", `127.0.0.1:${box.mapping}`],
    ["Scoring token", "common", "own of Course B"],
  ]);
  await page.locator("#review").getByText(`reports go to 127.0.0.1:${box.scoring} from then on; no report is queued, in doubt or held now`).waitFor();
  await page.getByRole("button", { name: "Switch", exact: true }).click();
  await page.getByText("Course B is in use.").waitFor();
  await page.waitForFunction(() => document.activeElement.id === "courses-title");  // the button with the focus is gone
  await until(async () => (await ask("/adit/run")).said.endpoints.every(({ last_status: status }) => status === 200 || status === 0) && (await ask("/adit/run")).said.endpoints[0].last_status === 200, "the scoring endpoint's answer");
  await step(page, "Command Post").click();
  await page.getByText("Course B is in use and overrides these addresses.").waitFor();
  await step(page, "Courses").click();
  await page.getByRole("button", { name: "Switch to No course" }).click();
  await page.locator("#review").getByRole("button", { name: "Cancel" }).click();
  assert.equal((await ask("/adit/settings")).said.settings.command_post.course, "B");
  await openCards(page, "of Course A");
  await page.getByRole("button", { name: "Remove: Course 1" }).click();
  await page.getByRole("button", { name: "Apply changes" }).click();
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await hears(page, /Applied\./);
  assert.deepEqual((await ask("/adit/settings")).said.settings.courses.map(({ name }) => name), ["B"]);
  assert.deepEqual(complaints(page), []);
});

test("follows another operator's switch, and discards a confirmation of an outdated question", async (t) => {
  const { ask, page } = await ready(t, "setup#courses", { courses: COURSES });
  const other = async (name) => {
    assert.equal((await ask("/adit/course", { name })).status, 200);
    await until(async () => (await ask("/adit/settings").catch(() => ({}))).said?.settings.command_post.course === name, "the switch");
  };
  const inUse = (name) => page.locator(".course[data-level=good]", { hasText: name }).waitFor();
  await other("A");
  await inUse("Course A");
  await page.getByRole("button", { name: "Switch to Course B" }).click();
  await review(page);
  await other("");
  await page.locator("#review .text", { hasText: "Another operator has changed this meanwhile." }).waitFor();
  assert.ok(await page.getByRole("button", { name: "Switch", exact: true }).isDisabled());
  await page.getByRole("button", { name: "Cancel" }).click();
  await inUse("No course");

  // The other operator switches just after the press.
  await page.getByRole("button", { name: "Switch to Course B" }).click();
  await review(page);
  await page.route(/\/adit\/(settings|course)$/, async (route) => {
    if (route.request().method() === "POST") await other("A");
    return route.continue();
  });
  await page.getByRole("button", { name: "Switch", exact: true }).click();
  await page.locator("#step-courses > .outcome", { hasText: "Course B is not in use." }).waitFor();
  await hears(page, /has changed the settings meanwhile/);
  assert.equal((await ask("/adit/settings")).said.settings.command_post.course, "A");
  await inUse("Course A");
});

test("exports all settings as a file, and imports a file after a check and a preview", async (t) => {
  const { ask, page } = await ready(t, "setup#file");
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("link", { name: "Download the settings" }).click()]);
  assert.equal(download.suggestedFilename(), "adit-settings.json");
  const settings = JSON.parse(await readFile(await download.path(), "utf8"));
  assert.deepEqual(settings, (await ask("/adit/settings")).said.settings);
  const give = (what) => page.getByLabel("Settings from a file").setInputFiles({ name: "mine.json", mimeType: "application/json", buffer: Buffer.from(what) });
  await give("no JSON");
  await page.getByText("The file is not JSON").waitFor();
  await give(" ".repeat(300_000));
  await page.getByText("The file is too long").waitFor();
  await give("[]");
  await page.getByText("settings: expected an object").waitFor();
  await give(JSON.stringify({ ...settings, robots: [{ name: "two words" }], bugdet: 1 }));
  await page.getByText("The file was not applied, because it has errors.").waitFor();
  await page.getByText(/Robot 1: name: /).waitFor();
  await page.getByText(/bugdet: no such key/).waitFor();
  await give(JSON.stringify(settings));
  await page.getByText("The box already uses the settings in this file.").waitFor();
  const next = JSON.stringify({ ...settings, robots: [{ name: "ugv1" }] });
  await give(next);
  await review(page);
  await page.getByRole("button", { name: "Cancel" }).click();
  await page.getByText("The file was not applied.").waitFor();
  assert.equal((await ask("/adit/settings")).said.settings.robots.length, 0);
  await give(next);
  assert.match(JSON.stringify(await review(page)), /Robot ugv1/);
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await page.locator("#step-file").getByText(/Applied\./).waitFor();
  assert.deepEqual((await ask("/adit/settings")).said.settings.robots, [{ name: "ugv1", alias: "", clouds: "auto", precision: "exact", colour: "auto" }]);
  await step(page, "Robots").getByText("1 named").waitFor();
});

test("finds a setting by its name or meaning, and changes it", async (t) => {
  const { ask, page } = await ready(t, "setup#all");
  const search = page.getByLabel("Search");
  await search.fill("held until the operator");
  await page.getByText("1 found.").waitFor();
  await field(page, "reports.review").locator("select").selectOption("all");
  await search.fill("no such thing at all");
  await page.getByText("No setting matches").waitFor();
  await search.fill("map_hz");
  await type(page, "command_post.rates.map_hz", "0.5");
  await search.fill("require_token");
  await field(page, "team.require_token").locator("input").uncheck();
  await page.getByRole("button", { name: "Apply changes" }).click();
  assert.deepEqual(await review(page), [["Command Post: rates, map (a second)", "1", "0.5"], ["Team: require token", "true", "false"], ["Reports: review", "off", "all"]]);
  await page.locator("#review .warnings").getByText("without a token").waitFor();
  await page.getByRole("button", { name: "Cancel" }).click();
  await hears(page, "3 changes not yet applied");
  await page.getByRole("button", { name: "Apply changes" }).click();
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await hears(page, /Applied\./);
  const { settings } = (await ask("/adit/settings")).said;
  assert.deepEqual([settings.reports.review, settings.command_post.rates.map_hz, settings.team.require_token], ["all", 0.5, false]);
});

test("says where the page moves, and reverts values that the box cannot use", async (t) => {
  const { page } = await ready(t, "setup#network");
  await type(page, "team.listen[0].address", "203.0.113.7");
  await page.getByRole("button", { name: "Apply changes" }).click();
  await page.locator("#review .warnings").getByText("this page move").waitFor();
  const movesTo = page.evaluate(() => new Promise((found, missed) => {  // shown until the revert, which may be soon
    const says = () => [...document.querySelectorAll("#typed a")].some((link) => link.textContent.includes("http://203.0.113.7:"));
    new MutationObserver(() => says() && found()).observe(document.body, { subtree: true, childList: true, characterData: true });
    setTimeout(missed, 30000, new Error("the page did not say where it goes"));
  }));
  await Promise.all([movesTo, page.getByRole("button", { name: "Apply", exact: true }).click()]);
  await page.locator("#typed").getByText("the last change was reverted").waitFor();
  const port = await freePort();
  await type(page, "team.listen[0].address", "127.0.0.1");
  await type(page, "team.listen[0].port", String(port));
  await page.getByRole("button", { name: "Apply changes" }).click();
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  const link = page.locator("#typed a", { hasText: `http://127.0.0.1:${port}/setup#network` });
  await link.waitFor();
  await until(() => fetch(`http://127.0.0.1:${port}/`).then(({ ok }) => ok, () => false), "the box at its new address");
  await link.click();
  await page.waitForURL((url) => url.port === String(port));
  await hears(page, "Live");
});

test("shows a viewer all settings without a way to change them", async (t) => {
  const box = await freshBox(t, { secrets: ["scoring", "mapping"], settings: { robots: [{ name: "ugv1" }], courses: COURSES } });
  await box.settle();
  const page = await come(t, box, "setup", LOOKING);
  await hears(page, "Live");
  await page.locator("#looks").waitFor();
  for (const name of ["network", "post", "tokens", "robots", "test", "courses", "all"]) {
    await page.evaluate((name) => (location.hash = name), name);
    await page.locator(`#step-${name}`).waitFor();
    await openCards(page);
    const usable = await page.$$eval(`#step-${name} :is(input:not([type=search]), select, button:not(.opens))`, (nodes) => nodes.filter((node) => node.checkVisibility() && !node.disabled && !node.readOnly).map((node) => node.outerHTML));
    assert.deepEqual(usable, [], name);
  }
  assert.equal(await field(page, "robots[0].name").locator("input").inputValue(), "ugv1");
  assert.ok(await page.getByRole("button", { name: "Apply" }).isHidden());
  assert.deepEqual(page.requests.filter((url) => url.includes("check")), []);
  assert.deepEqual(complaints(page), []);
});
