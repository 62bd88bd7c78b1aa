// The system page, for its tests, with a program that plays scenes.
import { serve } from "./stage.js";
import { visitor } from "./watch.js";

export const OPERATOR = "correct horse", VIEWER = "look, do not touch";

/** The system page after a log-in with `password`, for one test; with all cards open, unless `areOpen` is false. */
export async function come(t, password = OPERATOR, { stage, areOpen = true, ...options } = {}) {
  if (!stage) {
    stage = await serve("calm");
    t.after(() => stage.end());
  }
  const page = await visitor(t, `${stage.url}system`, options);
  await page.waitForURL(/login\.html\?next=%2Fsystem/);
  await page.locator("#login").getByLabel("Password").fill(password);
  await page.keyboard.press("Enter");
  await page.waitForURL(/\/system$/);
  await page.locator("#link .text", { hasText: "Live" }).waitFor();
  if (areOpen) await page.$$eval(".card", (cards) => cards.forEach((card) => (card.open = true)));
  return { stage, page };
}

/** The rows of the log, the newest first. */
export const rows = (page) => page.$$eval("#log .rows li", (items) => items.map((item) => item.innerText.replace(/\s+/g, " ")));
export const untilRows = (page, count) => page.waitForFunction((count) => document.querySelectorAll("#log .rows li").length === count, count);

/** Fills the fields of a form by their names. */
export async function fill(form, fields) {
  for (const [name, value] of Object.entries(fields)) await form.locator(`[name=${name}]`).fill(value);
}

/** Presses `button`, which POSTs to one of `paths`. Presses it again before the POST is answered, and again before the page shows the
 *  result. Returns the numbers of presses and POSTs so far. */
export async function pressThrice(page, paths, button) {
  const count = { presses: 0, posts: 0 };
  const press = () => ++count.presses && button.click();
  let isAnswered = false;
  await page.route(paths, async (route) => {
    const isPost = route.request().method() === "POST";
    count.posts += isPost;
    if (isPost ? count.presses === 1 : isAnswered && count.presses === 2) await press();
    await route.fulfill({ response: await route.fetch() });
    isAnswered ||= isPost;
  });
  await press();
  return count;
}
