// What every test of the page needs: a browser for the file, and a page that looks at a scene.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { after, before } from "node:test";
import { launch, look, serve, visit } from "./stage.js";

export { axeFindsNothing } from "./axe.js";

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** Counts, in the page, what it asked for and has not yet. */
function countAwaited() {
  globalThis.awaited = globalThis.still = 0;
  const { prototype } = Response;
  for (const [owner, name] of [[globalThis, "fetch"], [globalThis, "createImageBitmap"], [prototype, "json"], [prototype, "blob"]]) {
    const real = owner[name];
    owner[name] = function (...words) {
      ++globalThis.awaited;
      return real.apply(this, words).finally(() => --globalThis.awaited);
    };
  }
}

/** Until a page that is watched has all that it asked for, and has drawn it: for three frames nothing was awaited. */
export const settled = (page) =>
  page.waitForFunction(() => {
    globalThis.still = globalThis.awaited ? 0 : (globalThis.still + 1) % 4;
    return !globalThis.awaited && !globalThis.still;
  });

/** A page that looks at a scene, for the length of one test; `prepare(page)` before it is opened. */
export async function watch(t, scene, { path = "", prepare, ...options } = {}) {
  const stage = await serve(scene);
  t.after(() => stage.end());
  const page = await look(browser, stage.url + path, options, async (page) => {
    await page.addInitScript(countAwaited);
    await page.route("**/adit/settings", (route) => route.fulfill({ json: { keys: [] } })); // which a scene has none of
    await prepare?.(page);
  });
  t.after(() => page.context().close());
  return { stage, page };
}

/** Whoever comes to `url` without a session, for the length of one test. */
export async function visitor(t, url, options = {}, prepare = () => {}) {
  const page = await visit(browser, url, options, prepare);
  t.after(() => page.context().close());
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

/** Kept beside the scene server's build, for people to look at. */
export async function shoot(page, name) {
  const folder = join(dirname(process.env.SCENE_SERVER), "../shots");
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`) });
}
