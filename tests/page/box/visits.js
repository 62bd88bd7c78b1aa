// Shared by all tests against the real box: a browser for the file, and pages of the box.
import { after, before } from "node:test";
import { countAwaited, launch, leave, visit } from "../stage.js";
import { begin, PASSWORD, TOKENS } from "./box.js";

export { hears, leave, settled } from "../stage.js";
export { canBeDeaf } from "../retold.js";
export { openMore } from "../parts.js";

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** A box for one test. */
export async function box(t, options) {
  const made = await begin(options);
  t.after(() => made.end());
  return made;
}

/** A page of the box, with the team's token. */
export async function look(t, made, path = "", { prepare, ...options } = {}) {
  const page = await visit(browser, made.url + path, { extraHTTPHeaders: { Authorization: `Bearer ${TOKENS.team}` }, ...options }, async (page) => {
    await page.addInitScript(countAwaited);
    await prepare?.(page);
  });
  t.after(() => leave(page));
  await page.waitForSelector("body[data-link=live]");
  return page;
}

/** A page with a password log-in, in its own browser. `prepare(page)` runs before it is opened. */
export async function logIn(t, made, prepare) {
  const page = await visit(browser, `${made.url}login.html`, {}, prepare);
  t.after(() => leave(page));
  await page.fill("#login input[name=password]", PASSWORD);
  await page.click("#login button");
  await page.waitForSelector("body[data-link=live]");
  return page;
}

export const row = (page, number) => page.locator(`#reports li[data-key="${number}"]`);
export const action = (page, name, number) => page.getByRole("button", { name: `${name}: report ${number}` });
export const says = (page, number, words) =>
  page.waitForFunction(([number, words]) => document.querySelector(`#reports li[data-key="${number}"]`)?.innerText.includes(words), [number, words]);
