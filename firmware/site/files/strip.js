// The strip's right side: how fast each address of the Command Post answers, and whether the box does.
import { list, make, mark, say } from "./dom.js";
import { answerOf } from "./arriving.js";
import { clip } from "./words.js";

const ends = document.querySelector(".strip .ends");

export function showEnds(view, lost) {
  const create = () => make("div", make("dt"), make("dd"));
  list(ends, view.endpoints, ({ name }) => name, create, (node, row) => {
    const { level, word } = lost ? { level: "quiet", word: "–" } : answerOf(row, view);
    mark(node, "level", level);
    say(node.firstChild, clip(row.name, 12));
    say(node.lastChild, word);
  });
}

/** For who only listens; others see it in verdict and alarms. */
export function showLink(view, lost) {
  mark(document.body, "link", lost ? "lost" : view ? "live" : "opening");
  const words = lost ? (view ? "Box lost" : "No box") : view ? "Live" : "Looking for the box";
  say(document.getElementById("link"), words);
}
