// Shared by all tests of the page: a browser for the file, and a page of a scene.
import assert from "node:assert/strict";
import { after, before } from "node:test";
import { countAwaited, launch, leave, look, serve, visit } from "./stage.js";

export { axeFindsNothing } from "./axe.js";
export { openMore, toTab } from "./parts.js";
export { armed, hears, settled, shoot } from "./stage.js";

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** A page of a scene, for one test. `prepare(page)` runs before it is opened. */
export async function watch(t, scene, { path = "", prepare, ...options } = {}) {
  const stage = await serve(scene);
  let page;
  t.after(async () => {
    if (page) await leave(page);  // first, because its requests must not fail when the server ends
    await stage.end();
  });
  page = await look(browser, stage.url + path, options, async (page) => {
    await page.addInitScript(countAwaited);
    await page.route("**/adit/settings", (route) => route.fulfill({ json: { keys: [] } }));  // a scene has no settings
    await prepare?.(page);
  });
  return { stage, page };
}

/** A page at `url` without a session, for one test. */
export async function visitor(t, url, options = {}, prepare = () => {}) {
  const page = await visit(browser, url, options, prepare);
  t.after(() => leave(page));
  return page;
}

export const text = (page, selector) => page.textContent(selector);
export const waitForText = (page, words) => page.waitForFunction((words) => document.body.innerText.includes(words), words);

/** Fails unless the clock is the scene's: 12:34 at first, plus at most the time since `began`. */
export async function showsTheClock(page, began) {
  const shown = await text(page, "#clock");
  assert.match(shown, /^\d\d:\d\d$/);
  const [minutes, seconds] = shown.split(":").map(Number), gone = minutes * 60 + seconds - 754;
  assert.ok(gone >= 0 && gone <= (Date.now() - began) / 1000 + 1, shown);
}
