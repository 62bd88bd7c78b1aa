// What every test of the page needs: a browser for the file, and a page that looks at a scene.
import { mkdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { after, before } from "node:test";
import { launch, look, serve, visit } from "./stage.js";

export { axeFindsNothing } from "./axe.js";

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** A page that looks at a scene, for the length of one test; `prepare(page)` before it is opened. */
export async function watch(t, scene, { path = "", prepare, ...options } = {}) {
  const stage = await serve(scene);
  t.after(() => stage.end());
  const page = await look(browser, stage.url + path, options, prepare);
  t.after(() => page.context().close());
  return { stage, page };
}

/** Whoever comes to `url` without a session, for the length of one test. */
export async function visitor(t, url, options = {}) {
  const page = await visit(browser, url, options);
  t.after(() => page.context().close());
  return page;
}

export const text = (page, selector) => page.textContent(selector);
export const said = (page, words) => page.waitForFunction((words) => document.body.innerText.includes(words), words);

/** Kept beside the scene server's build, for people to look at. */
export async function shoot(page, name) {
  const folder = join(dirname(process.env.SCENE_SERVER), "../shots");
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`) });
}
