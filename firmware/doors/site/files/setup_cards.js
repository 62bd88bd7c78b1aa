// The cards of set-up. A card opens by itself for a change that is not applied yet, an error, and a token that the box needs.
import { makeCard, tellCard } from "./card.js";
import { make } from "./dom.js";
import { draft, keyOf, read, same } from "./draft.js";
import { nameOf } from "./names.js";
import { clip } from "./words.js";

const cards = new Map(); // the element around a card to stateOf()

/** `stateOf()` gives the line of the card in `around`, and its level if it needs the operator. */
export const followCard = (around, stateOf) => cards.set(around, stateOf);

/** Adds a card to `place`. The address /setup#ID opens it. */
export function addCard(place, id, title, stateOf, ...body) {
  const around = Object.assign(make("div.folds", makeCard(title, ...body)), { id });
  place.append(around);
  followCard(around, stateOf);
}

export const counted = (count, what) => `${count} ${what}${count === 1 ? "" : "s"}`;

/** Says how each card stands. Errors that are shown come first. */
export function tellCards() {
  for (const [around, stateOf] of cards) {
    const errors = around.querySelectorAll("[aria-invalid=true]").length;
    if (!around.isConnected) cards.delete(around);
    else if (errors) tellCard(around, counted(errors, "error"), "bad");
    else tellCard(around, ...stateOf());
  }
}

/** The state of the settings at `paths`, of one group. */
export function stateOfGroup(paths) {
  const typed = paths.filter((path) => !same(read(path), read(path, draft.base))).length;
  if (typed) return [`${counted(typed, "change")} not applied yet`, "wait"];
  const others = paths.filter((path) => !same(read(path), keyOf(path).default));
  if (others.length !== 1) return [others.length ? `${others.length} differ from the default` : "All at the default"];
  const name = nameOf(others[0]).replace(/^[^:]+: /, "");
  return [clip(`${name[0].toUpperCase()}${name.slice(1)}: ${read(others[0])}`, 60)];
}
