// The time bar over a restart: what the box has kept of the run is there again, picture, robots and plots.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { until } from "../box.js";
import { begin } from "./box.js";
import { look, settled } from "./visits.js";

const SAMPLES = 8; // of two seconds

let made;
before(async () => (made = await begin({ robots: 3 })));
after(() => made?.end());

test("shows the run from its beginning on, also after the service was killed", async (t) => {
  await until(async () => (await made.ask("/adit/history")).said.at.length >= SAMPLES, "samples");
  const began = await until(async () => (await made.ask("/adit/map")).said.layers.map(({ first }) => first).sort()[0], "a map");
  const kept = Date.now() / 1000;
  const bytes = async () => (await made.ask("/adit/runs")).said.runs[0]?.bytes ?? 0;
  for (const write of ["first", "second"]) { // the one that was under way may not have had all of it
    const before = await bytes();
    await until(async () => (await bytes()) > before, `the ${write} write`);
  }
  await made.killAditd();
  made.freezeRobots(); // what is seen is what was before
  t.after(() => made.thawRobots());
  await made.startAditd();
  const page = await look(t, made);
  await page.waitForSelector("#map input[type=range]:enabled");
  const slider = page.getByRole("slider");
  await until(async () => Number(await slider.getAttribute("max")) >= Math.floor(kept - began), "the whole run on the bar");
  const plotted = () => page.$$eval("#plots .line", (paths) => paths.map((path) => (path.getAttribute("d") ?? "").split(/[ML]/).length - 1));
  await until(async () => (await plotted()).filter((points) => points >= SAMPLES / 2 - 1).length >= 3, "the plots of before"); // a point each 4 s
  await slider.press("Home");
  await slider.press("ArrowRight");
  assert.match(await slider.getAttribute("aria-valuetext"), /^as of/);
  await until(() => page.requests.some((url) => url.includes(".png?at=")), "tiles as they were");
  await settled(page);
  const robots = await page.$$eval("#map .follow option", (options) => options.map(({ value }) => value).filter(Boolean));
  assert.ok(robots.length > 0, "robots of before");
  assert.deepEqual(page.complaints.filter((text) => !/404|Failed to load/.test(text)), []);
});
