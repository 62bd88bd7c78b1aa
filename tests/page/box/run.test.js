import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { axeFindsNothing } from "../axe.js";
import { becomes, box, canvas, changed, picture } from "../pictures.js";
import { until } from "../box.js";
import { begin } from "./box.js";
import { hears, look, openMore } from "./visits.js";

// One run for all tests of this file: five robots explore, and the operator reports.
let made;
before(async () => {
  made = await begin({ robots: 5, settings: { reports: { review: "duplicates" } }, post: ["--team", "Cerberus"] });
  const [x, y] = await until(async () => {
    const robot = (await made.run()).robots.find(({ name }) => name);
    return robot && [robot.position.x, robot.position.y];
  }, "a robot");
  for (const [type, left, up] of [["Survivor", 4, 2], ["Drill", -3, 6], ["Gas", 8, -4], ["Gas", 10, -4]]) await made.compose(type, x + left, y + up);
  await until(async () => (await made.ask("/adit/markers")).said.markers.length > 5, "markers");
  await until(async () => Math.max(...(await made.ask("/adit/tracks")).said.tracks.map(({ poses }) => poses.length)) > 12, "tracks");
});
after(() => made?.end());

const off = async (page, ...names) => {
  for (const name of names) await box(page, name).uncheck();
};

/** The map's picture, once it is still. */
async function still(page) {
  for (let last = await picture(page); ; ) {
    await hears(page, 2);
    const next = await picture(page);
    if (next === last) return next;
    last = next;
  }
}

test("loads the markers that changed, and the tracks once", async (t) => {
  const began = Date.now(), page = await look(t, made);
  const asked = (part) => page.requests.filter((url) => url.includes(part));
  await until(() => asked("/adit/markers").length > 3, "markers that changed");
  assert.equal(asked("/adit/tracks").length, 1);
  const [first, ...later] = asked("/adit/markers");
  assert.match(first, /since=0$/);
  const seconds = (Date.now() - began) / 1000;
  assert.ok(later.length <= seconds + 2, `${later.length} times in ${seconds} s`);
  for (const url of later) assert.doesNotMatch(url, /since=0$/);
});

test("makes the lights flash on the box and the page, and stops it", async (t) => {
  const page = await look(t, made);
  await openMore(page);
  await page.getByRole("button", { name: "Identify" }).click();
  await page.waitForFunction(() => [...document.querySelectorAll("#lights li")].every((light) => light.dataset.pattern === "twice"));
  await page.waitForFunction(() => /Flashing, \d+ s/.test(document.querySelector("button.identify").textContent));
  assert.equal((await made.ask("/adit/identify", { seconds: 60 })).status, 200, "a longer time, too: a busy machine is slow to look");
  const all = (lit) => until(() => Object.values(made.lights()).every((light) => light === lit), `all lights ${lit}`);
  for (const lit of [true, false, true, false]) await all(lit);
  assert.match(await page.textContent("#lights li"), /flashes/);  // in words, because the page does not blink
  assert.equal((await made.ask("/adit/identify", { seconds: 1 })).status, 200, "a shorter time counts from now");
  await page.waitForFunction(() => [...document.querySelectorAll("#lights li")].every((light) => light.dataset.pattern !== "twice"));
  assert.equal(await page.textContent("button.identify"), "Identify");
});

test("performs each listed shortcut", async (t) => {
  made.freezeRobots();  // so that the map stands still
  t.after(() => made.thawRobots());
  await until(async () => {
    const { reports, activities } = await made.run();
    return reports.every(({ state }) => !["queued", "sending"].includes(state)) && activities.every(({ queued }) => !queued);
  }, "all to be sent: what the whole map is does not change then", 120_000);
  const page = await look(t, made);
  const focus = () => page.evaluate(() => document.activeElement.closest("section")?.id ?? document.activeElement.tagName);
  const blur = () => page.evaluate(() => document.activeElement.blur());
  const isOpen = (id) => page.locator(`#${id}`).isVisible();
  await page.keyboard.press("?");
  assert.ok(await isOpen("help"));
  const listed = await page.locator("#help dt").allTextContents();
  assert.deepEqual(listed, ["n", "r", "m", "l", ",", ".", "<", ">", "p", "0", "?", "← ↑ ↓ →", "+ −", "F", "Esc"]);
  await page.keyboard.press("Escape");
  assert.ok(!(await isOpen("help")));
  await blur();
  await page.keyboard.press("n");
  assert.ok(await isOpen("compose"));
  await page.locator("#compose .types button").first().click();
  await page.fill("#compose input[name=x]", "");
  await page.keyboard.type("nr0?");
  assert.equal(await page.inputValue("#compose input[name=x]"), "nr0?", "shortcuts are off in text fields");
  await page.keyboard.press("Escape");
  await blur();
  await page.keyboard.press("r");
  assert.equal(await focus(), "reports");
  await page.keyboard.press("m");
  assert.equal(await focus(), "map");
  await off(page, "Robots", "Tracks", "Markers", "Clouds", "Grids");
  await page.keyboard.press("0");
  const whole = await still(page);
  for (const [key, back] of [["ArrowLeft", "f"], ["ArrowUp", "0"], ["ArrowRight", "f"], ["ArrowDown", "f"], ["+", "f"], ["-", "f"]]) {
    await page.locator(canvas).press(key);
    await changed(page, whole, key);
    await page.locator(canvas).press(back);
    await becomes(page, whole, back);
  }
  const slider = page.getByRole("slider");
  await slider.press("Home");
  assert.match(await slider.getAttribute("aria-valuetext"), /^as of/);
  await page.keyboard.press("l");
  assert.equal(await slider.getAttribute("aria-valuetext"), "now");
  await page.keyboard.press("Control+n").catch(() => {});
  assert.ok(!(await isOpen("compose")), "a key with Ctrl is no shortcut");
  await page.keyboard.press("?");
  await page.getByRole("checkbox", { name: "Shortcuts are on" }).uncheck();
  await page.keyboard.press("Escape");
  await blur();
  for (const key of ["n", "?"]) await page.keyboard.press(key);
  assert.ok(!(await isOpen("compose")) && !(await isOpen("help")), "the shortcuts are turned off");
});

test("has no axe fault during a run, in the dark and the light theme", async (t) => {
  const page = await look(t, made, "", { bypassCSP: true });
  const isWell = async (what) => {
    for (const colorScheme of ["dark", "light"]) {
      await page.emulateMedia({ colorScheme });
      await axeFindsNothing(page, `${what}, ${colorScheme}`);
    }
  };
  await page.getByRole("button", { name: /^Show both on the map/ }).first().click();
  await isWell("a pair");
  await openMore(page);
  await page.getByRole("button", { name: "New run" }).click();
  await isWell("new run");
});
