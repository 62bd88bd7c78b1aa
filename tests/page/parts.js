// The parts of the run page, which are tabs on a phone.

/** Opens that tab, if the screen has tabs. */
export async function toTab(page, name) {
  const tab = page.locator(".tabs").getByRole("button", { name });
  if (await tab.isVisible()) await tab.click();
}

/** Opens the other parts beside the map. */
export async function openMore(page) {
  await page.locator(".strip .menu").click();
  await page.locator("#more").waitFor();
}
