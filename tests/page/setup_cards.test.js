// The cards of set-up: a line in words for each, the rest opened on demand, and by itself if it needs the operator.
import assert from "node:assert/strict";
import { test } from "node:test";
import { come, freshBox, PASSWORD, TOKENS } from "./fresh_box.js";
import { card, complaints, COURSES, field, hears, openCards, openedCards, ready, type } from "./setup_page.js";
import { axeFindsNothing, shoot } from "./watch.js";

const SETTINGS = { robots: [{ name: "ugv1" }], courses: COURSES, reports: { review: "all" }, rules: { forward_unknown_types: true, rewrite_frame_id: true } };
const LINES = {
  tokens: { "tokens-post": "Both tokens are set", "tokens-team": "The token is set" },
  courses: {
    "course-A": "10.100.1.200:8000, 10.100.1.201:8000, common tokens",
    "course-B": "10.100.2.200:8000, 10.100.2.201:8000, common tokens",
  },
  all: { "all-queues": "All at the default", "all-reports": "Review: all", "all-rules": "2 differ from the default" },
};
const SIZES = [[320, 640], [390, 844], [640, 360], [1280, 720], [1920, 1080]];

const says = (page, id, words) => page.waitForFunction(([id, words]) => document.querySelector(`#${id} > .card > summary .state`)?.textContent.trim() === words, [id, words]);
const opens = (page, ...ids) => page.waitForFunction((ids) => [...document.querySelectorAll(".card[open]")].map((each) => each.parentElement.id).join() === ids, ids.join());

async function turnTo(page, address) {
  await page.evaluate((address) => (location.hash = address), address);
}

async function apply(page) {
  await page.getByRole("button", { name: "Apply changes" }).click();
  await page.getByRole("button", { name: "Apply", exact: true }).click();
  await hears(page, /Applied\./);
}

test("says in a line what each card has, on every screen, and opens none that is as it should be", async (t) => {
  const box = await freshBox(t, { secrets: ["scoring", "mapping", "team"], settings: SETTINGS });
  await box.settle();
  const page = await come(t, box, "setup", PASSWORD, { bypassCSP: true });
  await hears(page, "Live");
  for (const [step, lines] of Object.entries(LINES)) {
    await turnTo(page, step);
    for (const [id, words] of Object.entries(lines)) await says(page, id, words);
    for (const [width, height] of SIZES) {
      await page.setViewportSize({ width, height });
      const cut = await page.$$eval(".card > summary, .card .state", (nodes) => nodes.filter((node) => node.scrollWidth > node.clientWidth + 1).map((node) => node.textContent));
      assert.deepEqual(cut, [], `${step} at ${width}`);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${step} at ${width}`);
      await shoot(page, `cards-${step}-${width}`);
    }
    for (const theme of ["dark", "light", "red"]) {
      await page.evaluate((theme) => (document.documentElement.dataset.theme = theme), theme);
      await axeFindsNothing(page, `${step}, ${theme}`);
    }
  }
  assert.deepEqual(await openedCards(page), []);
  assert.deepEqual(complaints(page), []);
});

test("opens and closes a card by keyboard", async (t) => {
  const { page } = await ready(t, "setup#tokens");
  const input = page.getByLabel("Team’s token", { exact: true });
  await card(page, "Team’s token").locator("summary").focus();
  await page.keyboard.press("Enter");
  await input.waitFor();
  await page.keyboard.press("Tab");
  assert.ok(await input.evaluate((node) => node === document.activeElement));
  await page.keyboard.press("Shift+Tab");
  await page.keyboard.press("Enter");
  await input.waitFor({ state: "hidden" });
});

test("opens the card that the address names, or that has the setting of the address", async (t) => {
  const { page } = await ready(t, "setup?setting=reports.near_metres#all", SETTINGS);
  await page.waitForFunction(() => document.activeElement.closest("[data-path]")?.dataset.path === "reports.near_metres");
  assert.deepEqual(await openedCards(page), ["all-reports"]);
  await turnTo(page, "course-B");
  await page.locator("#step-courses").waitFor();
  await opens(page, "course-B", "all-reports");
  await page.goto(new URL("/setup#tokens-team", page.url()).href);
  await page.getByLabel("Team’s token", { exact: true }).waitFor();
  assert.deepEqual(await openedCards(page), ["tokens-team"]);
  await page.goto(new URL("/setup#tokens-post", page.url()).href);
  await page.waitForFunction(() => document.activeElement.closest(".folds")?.id === "tokens-post");
  assert.deepEqual(await openedCards(page), ["tokens-post", "tokens-team"], "also if both are set, for an alarm of a rejected one");
});

test("opens the tokens if one is missing, and says which", async (t) => {
  const box = await freshBox(t, { secrets: ["scoring"] });
  await box.settle();
  const page = await come(t, box, "setup#tokens", PASSWORD);
  await says(page, "tokens-post", "The mapping token is missing");
  await says(page, "tokens-team", "Not set: clients use the Command Post’s");
  await opens(page, "tokens-post");
  await page.getByLabel("Mapping endpoint’s token", { exact: true }).fill(TOKENS.mapping);
  await says(page, "tokens-post", "A typed token is not set yet");
  await page.keyboard.press("Enter");
  await says(page, "tokens-post", "Both tokens are set");
});

test("has a changed card open after a reload, and one with an error whenever it is shown", async (t) => {
  const { page } = await ready(t, "setup#all");
  await openCards(page, "Runs");
  await type(page, "runs.length_seconds", "1800");
  await says(page, "all-runs", "1 change not applied yet");
  await hears(page, "1 change not yet applied");
  await page.reload();
  await opens(page, "all-runs");
  await says(page, "all-runs", "1 change not applied yet");
  await type(page, "runs.length_seconds", "1");
  await says(page, "all-runs", "1 error");
  await card(page, "Runs").locator("summary").click();
  await opens(page);
  await page.getByRole("button", { name: "Apply changes" }).click();
  await page.waitForFunction(() => document.activeElement.closest("[data-path]")?.dataset.path === "runs.length_seconds");
  await opens(page, "all-runs");
  await type(page, "runs.length_seconds", "1800");
  await apply(page);
  await says(page, "all-runs", "Length (s): 1800");
});

test("opens the cards in which a search finds something, for as long", async (t) => {
  const { page } = await ready(t, "setup#all");
  const search = page.getByLabel("Search");
  await openCards(page, "Queues");
  await search.fill("near duplicates");
  await field(page, "reports.near_metres").locator("input").waitFor();
  assert.deepEqual(await page.$$eval("#step-all .folds:not([hidden])", (all) => all.map(({ id }) => id)), ["all-reports"]);
  await search.fill("");
  await opens(page, "all-queues");
  await search.fill("near duplicates");
  await type(page, "reports.near_metres", "3");
  await says(page, "all-reports", "1 change not applied yet");
  await search.fill("");
  await opens(page, "all-reports", "all-queues");
});

test("opens a new course, and a course in use that lacks a token", async (t) => {
  const box = await freshBox(t, { secrets: ["scoring"], settings: { courses: [COURSES[0]], command_post: { scoring: COURSES[0].scoring, mapping: COURSES[0].mapping, course: "A" } } });
  await box.settle();
  const page = await come(t, box, "setup#courses", PASSWORD);
  await says(page, "course-A", "10.100.1.200:8000, 10.100.1.201:8000, no mapping token");
  await opens(page, "tokens-post", "course-A");
  await card(page, "of Course A").locator("summary").click();
  await page.getByRole("button", { name: "Add a course" }).click();
  await page.keyboard.type("B");
  await type(page, "courses[1].scoring.address", "10.100.2.200");
  await type(page, "courses[1].mapping.address", "10.100.2.201");
  await says(page, "course-B", "Not applied yet");
  await apply(page);
  await says(page, "course-B", "10.100.2.200:8000, 10.100.2.201:8000, no mapping token");
  await page.reload();
  await opens(page, "tokens-post", "course-A");
});
