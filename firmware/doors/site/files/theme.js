// The theme, before anything is drawn: dark, light or red for the night, as this browser was last told; else as its system has it.
(() => {
  const THEMES = ["dark", "light", "red"], STORED = "adit.theme";
  const day = matchMedia("(prefers-color-scheme: light)");
  const wanted = () => {
    const stored = localStorage.getItem(STORED);
    return THEMES.includes(stored) ? stored : day.matches ? "light" : "dark";
  };
  const set = (theme) => {
    document.documentElement.dataset.theme = theme;
    for (const button of document.querySelectorAll("button.theme")) {
      button.setAttribute("aria-label", `Theme: ${theme === "red" ? "red for the night" : theme}`);
      button.title = "Theme: dark, light, red for the night";
    }
  };
  set(wanted());
  day.addEventListener("change", () => set(wanted()));
  addEventListener("storage", ({ key }) => key === STORED && set(wanted())); // another tab
  document.addEventListener("DOMContentLoaded", () => set(wanted()));
  document.addEventListener("click", ({ target }) => {
    if (!target.closest("button.theme")) return;
    const next = THEMES[(THEMES.indexOf(wanted()) + 1) % THEMES.length];
    localStorage.setItem(STORED, next);
    set(next);
  });
})();
