import assert from "node:assert/strict";
import { test } from "node:test";
import { come, LOOKING, TOKENS } from "./fresh_box.js";
import { complaints, COURSES, openCards, ready, step } from "./setup_page.js";

const tries = (page) => page.getByRole("button", { name: "Try before applying" });
const outcome = (page, where) => page.locator(`[data-tried=${where}] > .outcome`);
/** Each endpoint's steps with their states. */
const states = (page, where) =>
  page.$$eval(`[data-tried=${where}] .trial`, (all) => all.map((each) => [...each.querySelectorAll("ol .badge")].map((badge) => badge.textContent.trim())));

async function tried(page, where, verdict) {
  await outcome(page, where).filter({ hasText: verdict }).waitFor();
  return states(page, where);
}

test("tests addresses as they are typed, before they are saved, and says what to do", async (t) => {
  const { box, ask, page } = await ready(t, "setup#post");
  await page.getByLabel("Scoring port", { exact: true }).fill(String(box.scoring));
  await tries(page).click();
  const [scoring, mapping] = await tried(page, "typed", "1 of 12 steps failed: mapping connection. These values are not applied yet. No report was used up.");
  assert.deepEqual([scoring[3], scoring[4], mapping[3]], ["good", "good", "bad"]);
  assert.match(await page.locator("[data-tried=typed] .trial").last().innerText(), /127\.0\.0\.1:2[\s\S]*no server at that port[\s\S]*Compare the port/);
  await page.getByLabel("Mapping port", { exact: true }).fill(String(box.mapping));
  await tries(page).click();
  const all = await tried(page, "typed", "All is well. These values are not applied yet");
  assert.deepEqual(all.map((each) => each.slice(3, 5)), [["good", "good"], ["good", "good"]]);
  const { settings } = (await ask("/adit/settings")).said;
  assert.deepEqual([settings.command_post.scoring.port, settings.command_post.mapping.port], [1, 2]);
  await step(page, "Test").getByText("not run").waitFor();
  assert.deepEqual(complaints(page), []);
});

test("drops a result once its values changed: typed, saved, or saved by another operator", async (t) => {
  const { box, ask, page } = await ready(t, "setup#post");
  const type = (label, port) => page.getByLabel(label, { exact: true }).fill(String(port));
  const shows = async (where, words) => {
    await page.waitForFunction(([where, words]) => document.querySelector(`[data-tried=${where}] > .outcome`).textContent === words, [where, words]);
    return (await states(page, where)).length;
  };
  const changed = "The settings have changed since the last test.";
  await type("Scoring port", box.scoring);
  await tries(page).click();
  await tried(page, "typed", "1 of 12 steps failed: mapping connection. These values are not applied yet.");
  await type("Mapping port", box.mapping);
  assert.equal(await shows("typed", ""), 0);
  await type("Mapping port", 2);
  assert.equal(await shows("typed", "1 of 12 steps failed: mapping connection. These values are not applied yet. No report was used up."), 2);
  await page.reload();  // the typed values stay, but the page does not know whether they were tested
  assert.equal(await shows("typed", "1 of 12 steps failed: mapping connection. This test began elsewhere, perhaps with other values. No report was used up."), 2);

  await type("Mapping port", box.mapping);
  await tries(page).click();
  await tried(page, "typed", "All is well. These values are not applied yet.");
  await page.getByRole("button", { name: "Apply changes" }).click();
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await page.locator("#typed", { hasText: /Applied\./ }).waitFor();
  assert.ok(!(await outcome(page, "typed").innerText()).includes("not applied yet"));
  assert.equal(await shows("typed", changed), 0);
  await tries(page).click();
  assert.equal(await shows("typed", "All is well. No report was used up."), 2);
  await page.locator("#typed").waitFor({ state: "hidden" });

  await step(page, "Test").click();
  await page.getByRole("button", { name: "Run the test" }).click();
  await tried(page, "applied", "All is well. No report was used up.");
  await step(page, "Test").getByText("passed").waitFor();
  const { settings, tag } = (await ask("/adit/settings")).said;
  settings.runs.length_seconds = 1800;
  await ask("/adit/settings", { settings, base: tag });
  assert.equal(await shows("applied", changed), 0);
  await step(page, "Test").getByText("not run").waitFor();
});

test("tests a typed token, and neither stores nor shows it", async (t) => {
  const { box, ask, page } = await ready(t, "setup#post");
  for (const [label, port] of [["Scoring port", box.scoring], ["Mapping port", box.mapping]]) await page.getByLabel(label, { exact: true }).fill(String(port));
  await step(page, "Tokens").click();
  await openCards(page, "Command Post’s tokens");
  await page.getByLabel("Scoring endpoint’s token", { exact: true }).fill("typed-and-wrong");
  await page.getByRole("link", { name: "Try these tokens before you set them" }).click();
  await tries(page).click();
  await tried(page, "typed", "1 of 12 steps failed");
  assert.match(await page.locator("[data-tried=typed] .trial").first().innerText(), /scoring token is rejected/);
  await page.getByRole("link", { name: "Open the token" }).click();
  await page.getByLabel("Scoring endpoint’s token", { exact: true }).waitFor();
  await step(page, "Command Post").click();
  assert.ok(!(await page.locator("#step-post").innerText()).includes("typed-and-wrong"));
  assert.ok(!JSON.stringify([(await ask("/adit/test")).said, (await ask("/adit/log")).said]).includes("typed-and-wrong"));
  assert.deepEqual((await ask("/adit/settings")).said.saved, false);
  assert.deepEqual(complaints(page), []);
});

test("names the field of an error", async (t) => {
  const { page } = await ready(t, "setup#post");
  await page.getByLabel("Mapping address", { exact: true }).fill("10.100.1");
  await tries(page).click();
  await tried(page, "typed", "Mapping address: expected an IPv4 or IPv6 address");
  assert.equal(await outcome(page, "typed").getAttribute("data-bad"), "true");
  assert.ok(await tries(page).isEnabled());
});

test("keeps an error if an earlier request is answered later", async (t) => {
  const { page } = await ready(t, "setup#post");
  await page.getByLabel("Mapping address", { exact: true }).fill("10.100.1");
  const isTest = (answer, method) => answer.url().endsWith("/adit/test") && answer.request().method() === method;
  const refused = page.waitForResponse((answer) => isTest(answer, "POST")), late = page.waitForResponse((answer) => isTest(answer, "GET"));
  await page.route("**/adit/test", async (route) => {
    if (route.request().method() === "GET") await refused;
    await route.continue();
  });
  await page.reload();  // the typed values stay, and the page asks for the state of the test
  await tries(page).click();
  await tried(page, "typed", "Mapping address: expected an IPv4 or IPv6 address");
  await (await late).finished();
  await page.evaluate(() => fetch("/adit/session").then((answer) => answer.json()));  // the page has read it too
  assert.match(await outcome(page, "typed").innerText(), /Mapping address: expected an IPv4 or IPv6 address/);
});

test("shows the running test if another one is rejected for it", async (t) => {
  const { ask, page } = await ready(t, "setup#post");
  let isShown;
  const shown = new Promise((resolve) => (isShown = resolve));
  await page.route("**/adit/test", async (route) => {
    if (route.request().method() === "POST") return route.fulfill({ status: 409, json: "a test is running: see GET /adit/test" });
    await shown;
    await route.continue();
  });
  await page.reload();
  await ask("/adit/test", {});
  await tries(page).click();
  await tried(page, "typed", "a test is running");
  isShown();
  await step(page, "Test").getByText("failed").waitFor();
  assert.equal(await outcome(page, "typed").textContent(), "");
});

test("tests a course before a switch, and marks it apart from the Test of the current course", async (t) => {
  const { box, ask, page } = await ready(t, "setup#courses", { courses: COURSES });
  const { settings, tag } = (await ask("/adit/settings")).said;
  settings.courses[1] = { name: "B", scoring: { address: "127.0.0.1", port: box.scoring }, mapping: { address: "127.0.0.1", port: box.mapping } };
  await ask("/adit/settings", { settings, base: tag });
  await page.reload();
  const course = page.locator("[data-list=courses] .item", { hasText: "Course B" });
  await page.waitForFunction((port) => document.querySelector("[data-path='courses[1].scoring.port'] input")?.value === port, String(box.scoring));
  await course.getByRole("button", { name: "Try Course B" }).click();
  await tried(page, "course", "All is well. This course is not in use yet.");
  assert.equal((await ask("/adit/settings")).said.settings.command_post.course, "");
  await step(page, "Test").click();
  await page.getByRole("button", { name: "Run the test" }).click();
  await tried(page, "applied", "2 of 12 steps failed: scoring connection, mapping connection. No report was used up.");
  await step(page, "Test").getByText("failed").waitFor();
  await page.getByRole("link", { name: "Open the Command Post’s address" }).first().click();
  await page.locator("#step-post").getByLabel("Scoring address", { exact: true }).waitFor();
});

test("leads to a course’s own address and token, while it is in use", async (t) => {
  const { ask, page } = await ready(t, "setup#test", { courses: COURSES });
  const { settings, tag } = (await ask("/adit/settings")).said;
  settings.courses[1] = { name: "B", scoring: { address: "127.0.0.1", port: 1 }, mapping: { address: "127.0.0.1", port: 2 } };
  settings.command_post.course = "B";
  await ask("/adit/settings", { settings, base: tag });
  await ask("/adit/tokens", { name: "course.B.mapping", token: "own" });
  await page.reload();
  await page.getByRole("button", { name: "Run the test" }).click();
  await page.getByRole("link", { name: "Open the Command Post’s address" }).first().click();
  const course = page.locator("[data-list=courses] .item", { hasText: "Course B" });
  await course.getByLabel("Scoring address", { exact: true }).waitFor();
  await step(page, "Tokens").click();
  await openCards(page, "Command Post’s tokens");
  const own = page.getByRole("link", { name: "Course B has its own token" });
  await own.click();  // waits until the page has read the tokens; more than one would fail
  await course.getByLabel("Own mapping token", { exact: true }).waitFor();
  assert.deepEqual(complaints(page), []);
});

test("shows a viewer no tests", async (t) => {
  const { box, page } = await ready(t, "setup#post");
  await page.close();
  const viewer = await come(t, box, "setup#post", LOOKING);
  await viewer.locator("#link", { hasText: "Live" }).waitFor();
  await viewer.getByRole("heading", { name: "Command Post" }).waitFor();
  assert.equal(await tries(viewer).isVisible(), false);
  assert.ok(TOKENS.scoring && !(await viewer.content()).includes(TOKENS.scoring));
});
