// Is every map arriving? For the strip of the run and of the display.
import { badge, mark, say } from "./dom.js";
import { overall } from "./arriving.js";
import { clip } from "./words.js";

/** The answer in a few words, and why. */
export function showVerdict(view, now, lost) {
  const { level, word, reason } = lost ? { level: "bad", word: "Unknown", reason: "the box does not answer" } : overall(view);
  const node = document.getElementById("arriving");
  mark(node, "level", level);
  badge(node, level, clip(word, 60));
  say(node.querySelector(".reason"), clip(reason, 120));
  node.title = reason;
}
