// A card: its state in one line of words, and all else behind it, opened on demand. What needs the operator opens by itself.
import { badge, mark } from "./dom.js";

const CALLS = ["wait", "ask", "bad"];

/** Says in one line how the card of `section` stands. It opens once when its level becomes one that needs the operator. */
export function tellCard(section, words, level = "quiet") {
  const card = section.querySelector(".card"), before = card.dataset.level;
  badge(card.querySelector(".state"), level, words);
  mark(card, "level", level);
  if (CALLS.includes(level) && !CALLS.includes(before)) card.open = true;
}

/** Opens the card that the page's address names (#passwords), now and later. */
export function followAddress() {
  const open = () => {
    const section = document.getElementById(location.hash.slice(1));
    /** @type {HTMLDetailsElement} */
    const card = section?.querySelector(":scope > .card");
    if (!card) return;
    card.open = true;
    section.scrollIntoView();
  };
  addEventListener("hashchange", open);
  open();
}
