// What every test of the page needs: a browser for the file, and a page that looks at a scene.
import assert from "node:assert/strict";
import { after, before } from "node:test";
import { countAwaited, launch, leave, look, serve, visit } from "./stage.js";

export { axeFindsNothing } from "./axe.js";
export { openMore, toTab } from "./parts.js";
export { armed, hears, settled, shoot } from "./stage.js";

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** A page that looks at a scene, for the length of one test; `prepare(page)` before it is opened. */
export async function watch(t, scene, { path = "", prepare, ...options } = {}) {
  const stage = await serve(scene);
  let page;
  t.after(async () => {
    if (page) await leave(page); // first: its requests must not fail with the server
    await stage.end();
  });
  page = await look(browser, stage.url + path, options, async (page) => {
    await page.addInitScript(countAwaited);
    await page.route("**/adit/settings", (route) => route.fulfill({ json: { keys: [] } })); // which a scene has none of
    await prepare?.(page);
  });
  return { stage, page };
}

/** Whoever comes to `url` without a session, for the length of one test. */
export async function visitor(t, url, options = {}, prepare = () => {}) {
  const page = await visit(browser, url, options, prepare);
  t.after(() => leave(page));
  return page;
}

export const text = (page, selector) => page.textContent(selector);
export const said = (page, words) => page.waitForFunction((words) => document.body.innerText.includes(words), words);

/** Fails unless the clock is the scene's: 12:34 at first, and not further than the time since `began`. */
export async function showsTheClock(page, began) {
  const shown = await text(page, "#clock");
  assert.match(shown, /^\d\d:\d\d$/);
  const [minutes, seconds] = shown.split(":").map(Number), gone = minutes * 60 + seconds - 754;
  assert.ok(gone >= 0 && gone <= (Date.now() - began) / 1000 + 1, shown);
}
