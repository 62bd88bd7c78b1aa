// Kept runs of the real box: list, map, print, delete.
import assert from "node:assert/strict";
import { test } from "node:test";
import { robotRgb } from "../../firmware/doors/site/files/robot_colour.js";
import { OPERATOR, VIEWER, box, play, until } from "./box.js";
import { armed, axeFindsNothing, shoot, visitor } from "./watch.js";

const SIZES = [["phone", 390, 844], ["720p", 1280, 720], ["1080p", 1920, 1080], ["4k", 3840, 2160]];

/** A box with two runs. The first one has a map. */
async function withRuns(t) {
  const at = await box(t);
  await play(at.ask);
  await until(async () => (await (await at.ask("GET", "/adit/map")).json()).layers.length > 0, "a picture of a map");
  await at.ask("POST", "/adit/runs");
  await until(async () => (await (await at.ask("GET", "/adit/runs")).json()).runs.length === 2, "two runs");
  return at;
}

async function come(t, { url }, password = OPERATOR) {
  const page = await visitor(t, `${url}/runs`, { bypassCSP: true });
  await page.waitForURL(/login\.html\?next=%2Fruns/);
  await page.locator("#login").getByLabel("Password").fill(password);
  await page.keyboard.press("Enter");
  await page.waitForURL(/\/runs$/);
  await page.locator("#runs .rows li").nth(1).waitFor();
  return page;
}

test("lists runs, shows an earlier run's map at its times, and deletes it after a confirmation", async (t) => {
  const at = await withRuns(t);
  const page = await come(t, at);
  const earlier = page.locator("#runs .rows li", { hasText: "Run 1" });
  assert.equal(await page.locator("#runs .rows li", { hasText: "(now)" }).getByRole("button", { name: /^Delete/ }).isVisible(), false);
  let letGo;
  const held = new Promise((resolve) => (letGo = resolve));
  await page.route(/\/adit\/runs\/1\/history/, (route) => held.then(() => route.continue()));
  await earlier.getByRole("button", { name: /^View/ }).click();
  await page.locator("#look h2", { hasText: "Opening Run 1 …" }).waitFor();
  letGo();
  await until(() => page.requests.some((url) => /\/adit\/runs\/1\/map\/grid\/ugv1\/tiles\?/.test(url)), "the run's tiles");
  assert.deepEqual(await page.locator("#look .follow option").allTextContents(), ["Follow …", "ugv1"]);
  const slider = page.locator("#look input[type=range]");
  assert.equal(await slider.getAttribute("aria-valuetext"), "the end");
  const robot = robotRgb(0, "dark");
  const hasRobot = () => page.$eval("#look .frame canvas", (node, robot) => {
    const { data } = node.getContext("2d").getImageData(0, 0, node.width, node.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (robot.every((part, at) => Math.abs(part - data[i + at]) < 8)) ++count;
    return count > 20;
  }, robot);
  await page.emulateMedia({ colorScheme: "dark" });
  await until(hasRobot, "the robot, where it was at last");
  for (const [name, width, height] of SIZES) {
    await page.setViewportSize({ width, height });
    await shoot(page, `runs-${name}`);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth > innerWidth), false, name);
  }
  await axeFindsNothing(page);
  await slider.press("Home");
  await slider.press("Shift+ArrowRight");
  await slider.press("Shift+ArrowLeft");
  await earlier.getByRole("button", { name: /^Delete/ }).click();
  await page.locator("#confirm button", { hasText: "Cancel" }).click();
  assert.equal(await page.locator("#runs .rows li").count(), 2);
  await armed(page);
  await earlier.getByRole("button", { name: /^Delete/ }).click();
  await page.locator("#confirm .main").click();
  await earlier.waitFor({ state: "detached" });
  assert.equal((await (await at.ask("GET", "/adit/runs")).json()).runs.length, 1);
});

test("prints a run without a script, black on white, on A4", async (t) => {
  const at = await withRuns(t);
  const page = await come(t, at);
  await page.goto(`${at.url}/adit/runs/1/report.html`);
  assert.equal(await page.locator("h1").textContent(), "Run 1");
  assert.ok(await page.locator("svg image").count() > 0);
  assert.equal(await page.evaluate(() => getComputedStyle(document.body).color), "rgb(0, 0, 0)");
  await shoot(page, "run-report");
  await axeFindsNothing(page);
});

test("a viewer can look at runs but cannot delete them", async (t) => {
  const at = await withRuns(t);
  const page = await come(t, at, VIEWER);
  assert.equal(await page.getByRole("button", { name: /^View/ }).count(), 2);
  assert.equal(await page.getByRole("button", { name: /^Delete/ }).count(), 0);
});
