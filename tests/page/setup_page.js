// The set-up page, for its tests.
import { come, freshBox, PASSWORD } from "./fresh_box.js";

export const COURSES = [
  { name: "A", scoring: { address: "10.100.1.200", port: 8000 }, mapping: { address: "10.100.1.201", port: 8000 } },
  { name: "B", scoring: { address: "10.100.2.200", port: 8000 }, mapping: { address: "10.100.2.201", port: 8000 } },
];

export const field = (page, path) => page.locator(`.field[data-path="${path}"]`);
export const step = (page, name) => page.locator("#steps").getByRole("link", { name });
export const hears = (page, words) => page.locator("#link, #missing, #typed").filter({ hasText: words }).first().waitFor();

/** A box with all settings except for `settings`, and its operator's set-up page. */
export async function ready(t, path = "setup", settings = {}) {
  const box = await freshBox(t, { secrets: ["scoring", "mapping", "team"], settings });
  const ask = await box.settle();
  const page = await come(t, box, path, PASSWORD);
  await hears(page, "Live");
  return { box, ask, page };
}

/** The card with this title in the step that is shown. */
export const card = (page, title) => page.locator(".card:visible").filter({ has: page.locator("summary h3", { hasText: title }) });

/** Opens each card of the step that is shown, or the one with this title, as a user does. */
export async function openCards(page, title = "") {
  for (const each of await card(page, title).all()) if (!(await each.evaluate((node) => node.open))) await each.locator("summary").click();
}

/** The addresses of the open cards. */
export const openedCards = (page) => page.$$eval(".card[open]", (cards) => cards.map((each) => each.parentElement.id));

/** The browser's complaints, except that a restarting box was unreachable. */
export const complaints = (page, ...known) => page.complaints.filter((each) => !["ERR_CONNECTION", "ERR_EMPTY", ...known].some((part) => each.includes(part)));

/** Types into the field of a setting, and leaves it. */
export async function type(page, path, text) {
  const input = field(page, path).locator("input");
  await input.fill(text);
  await input.dispatchEvent("input");  // fill() causes no event if the text is the same
  await input.evaluate((node) => node.blur());
}

export async function fill(page, fields) {
  for (const [label, text] of Object.entries(fields)) await page.getByLabel(label, { exact: true }).fill(text);
}

/** The rows of the dialog that shows the pending changes. */
export async function review(page) {
  await page.locator("#review[open]").waitFor();
  return page.$$eval("#review tbody tr", (rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
}
