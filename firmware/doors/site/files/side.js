// The place beside the map: the reports, or one of the panels that replace them (`section.side`); and on a phone, the shown
// tab. The map does not move.

import { drawn } from "./icons.js";
import { isShown, mark, say, set } from "./dom.js";
import { clip } from "./words.js";

const sides = [...document.querySelectorAll("main > .side")];
const tabs = [...document.querySelectorAll(".tabs button")];
const changes = new Map(); // a panel's id to whom to tell
let back = null; // the element that had the focus before

export const side = () => document.body.dataset.side;

/** Calls `changed(isOpen)` whenever that panel opens or closes. */
export const whenSide = (id, changed) => changes.set(id, changed);

/** Opens a panel in the place of the reports; `focused`: what of it has the focus then, if not its title. */
export function openSide(id, focused = null) {
  const before = side();
  if (before === id) return;
  if (before === "reports") back = document.activeElement;
  document.body.dataset.side = id;
  for (const panel of sides) panel.hidden = panel.id !== id;
  for (const button of document.querySelectorAll("[aria-controls]")) {
    if (button.hasAttribute("aria-expanded")) button.setAttribute("aria-expanded", String(button.getAttribute("aria-controls") === id));
  }
  changes.get(before)?.(false);
  changes.get(id)?.(true);
  if (id !== "reports") (focused ?? document.querySelector(`#${id} h2`)).focus({ preventScroll: true });
}

/** The reports again. */
export function closeSide() {
  const hadFocus = document.activeElement.closest?.(".side") || document.activeElement === document.body;
  openSide("reports");
  if (hadFocus && back && isShown(back)) back.focus({ preventScroll: true });
}

/** On a phone; elsewhere all is there. */
export function goTab(name) {
  document.body.dataset.tab = name;
  for (const tab of tabs) {
    if (tab.dataset.tab === name) tab.setAttribute("aria-current", "true");
    else tab.removeAttribute("aria-current");
  }
}

/** Offers tabs, the menu, and what closes a panel. */
export function offerSides() {
  for (const tab of tabs) {
    tab.prepend(drawn(tab.dataset.tab));
    tab.addEventListener("click", () => {
      closeSide();
      goTab(tab.dataset.tab);
    });
  }
  for (const panel of sides) panel.querySelector(".head > .close")?.addEventListener("click", closeSide);
  document.querySelector(".strip .menu").addEventListener("click", () => (side() === "more" ? closeSide() : openSide("more")));
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || event.defaultPrevented || side() === "reports" || event.target.closest("dialog, .pair")) return;
    event.preventDefault();
    closeSide();
  });
}

const LEVELS = ["bad", "ask", "wait"];

/** How many alarms are of what is behind a tab, and the worst of them. */
export function showOnTab(name, alarms) {
  const tab = tabs.find(({ dataset }) => dataset.tab === name), sign = tab.querySelector(".waits");
  set(sign, { hidden: alarms.length === 0 });
  mark(sign, "level", LEVELS.find((level) => alarms.some(({ severity }) => severity === level)) ?? "");
  say(sign, String(alarms.length));
  set(tab, { title: alarms.map(({ what }) => clip(what, 60)).join(", ") });
}
