// Which theme the page has: "dark", "light" or "red". Who draws by hand or mixes colours asks here; all else has them from the style.

const THEMES = ["dark", "light", "red"];

/** What `data-theme` of the page says, else what the browser prefers. */
export function themeNow() {
  const { theme } = document.documentElement.dataset;
  return THEMES.includes(theme) ? theme : matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
}

/** Calls `changed` after each change of the theme. */
export function whenThemeChanges(changed) {
  matchMedia("(prefers-color-scheme: light)").addEventListener("change", changed);
  new MutationObserver(changed).observe(document.documentElement, { attributeFilter: ["data-theme"] });
}
