// A card shows its state in one line of words. The rest opens on demand, and by itself if the operator is needed.
import { badge, make, mark } from "./dom.js";

const CALLS = ["wait", "ask", "bad"];

/** Says in one line how the card of `section` stands. It opens once when its level becomes one that needs the operator. */
export function tellCard(section, words, level = "quiet") {
  const card = section.querySelector(".card"), before = card.dataset.level;
  badge(card.querySelector(".state"), level, words);
  mark(card, "level", level);
  if (CALLS.includes(level) && !CALLS.includes(before)) card.open = true;
}

/** A card with the title `title`, closed. */
export const makeCard = (title, ...body) =>
  make("details.card", make("summary", make("h3", title), " ", make("span.state.badge")), make("div.body", ...body));

/** Opens each card around `node`. */
export function openAround(node) {
  for (let card = node.closest(".card"); card; card = card.parentElement.closest(".card")) card.open = true;
}

/** Opens the card of `section` while a search finds something in it. Afterwards it is as before, unless it needs the operator. */
export function openFound(section, isFound) {
  const card = section.querySelector(".card"), isOpenedHere = "found" in card.dataset;
  if (isFound && !card.open) card.dataset.found = "";
  else if (!isFound) delete card.dataset.found;
  if (isFound) card.open = true;
  else if (isOpenedHere && !CALLS.includes(card.dataset.level)) card.open = false;
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
    card.querySelector("summary").focus({ preventScroll: true });
  };
  addEventListener("hashchange", open);
  open();
}
