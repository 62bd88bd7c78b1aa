// Keyboard shortcuts, and the dialog that lists them. Letters alone do nothing while somebody types, and can be
// turned off (WCAG 2.1.4).
import { open } from "./dialog.js";
import { make } from "./dom.js";

const help = document.getElementById("help");
const on = help.querySelector("input");
const STORED = "adit.shortcuts";
on.checked = localStorage.getItem(STORED) !== "off";
on.addEventListener("change", () => localStorage.setItem(STORED, on.checked ? "on" : "off"));

const types = (node) => node.closest("input:not([type=checkbox], [type=range]), textarea, select, dialog");

function row(key, text) {
  return make("div", make("dt", make("kbd", key)), make("dd", text));
}

/** `shortcuts`: [{key, text, act}]; `others`: [[key, text]], for the list alone. */
export function listenToKeys(shortcuts, others) {
  help.querySelector("dl").append(
    ...shortcuts.map(({ key, text }) => row(key, text)), row("?", "this help"), ...others.map(([key, text]) => row(key, text)));
  const showHelp = () => open(help);
  for (const button of document.querySelectorAll("button.help")) button.addEventListener("click", showHelp);
  document.addEventListener("keydown", (event) => {
    if (!on.checked || event.ctrlKey || event.metaKey || event.altKey || types(event.target)) return;
    const act = event.key === "?" ? showHelp : shortcuts.find(({ key }) => key === event.key)?.act;
    if (!act) return;
    event.preventDefault();
    act();
  });
}
