// Is every map arriving? For the strip of the run and of the display.
import { badge, mark, say, set } from "./dom.js";
import { clip } from "./words.js";

/** The answer in a few words, and why. */
export function showVerdict(view, now, lost) {
  const { level, what, why } = lost ? { level: "bad", what: "Unknown", why: "the box sends no data to this page" } : view.verdict;
  const node = document.getElementById("arriving");
  mark(node, "level", level);
  badge(node, level, clip(what, 60));
  say(node.querySelector(".reason"), clip(why, 120));
  set(node, { title: why });
}
