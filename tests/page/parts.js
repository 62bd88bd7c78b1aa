// The parts of the run view, where they are not beside each other.

/** To that tab, where the screen has tabs: a phone. */
export async function toTab(page, name) {
  const tab = page.locator(".tabs").getByRole("button", { name });
  if (await tab.isVisible()) await tab.click();
}

/** Opens what else there is, beside the map. */
export async function openMore(page) {
  await page.locator(".strip .menu").click();
  await page.locator("#more").waitFor();
}
