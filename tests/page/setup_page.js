// The set-up's page, for its tests.

export const field = (page, path) => page.locator(`.field[data-path="${path}"]`);
export const step = (page, name) => page.locator("#steps").getByRole("link", { name });
export const hears = (page, words) => page.locator("#link, #missing, #typed").filter({ hasText: words }).first().waitFor();

/** Types into the field of a setting. */
export async function type(page, path, text) {
  await field(page, path).locator("input").fill(text);
}

export async function fill(page, fields) {
  for (const [label, text] of Object.entries(fields)) await page.getByLabel(label, { exact: true }).fill(text);
}

/** The rows of the dialog that shows what is about to change. */
export async function review(page) {
  await page.locator("#review[open]").waitFor();
  return page.$$eval("#review tbody tr", (rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
}
