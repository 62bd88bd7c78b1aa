// The strip's right side: how fast each address of the Command Post answers, and whether the box does.
import { list, make, mark, say } from "./dom.js";
import { clip, isOldAnswer, ms } from "./words.js";

const ends = document.querySelector(".strip .ends");

export function showEnds(view, lost) {
  const create = () => make("div", make("dt"), make("dd"));
  list(ends, view.endpoints, ({ name }) => name, create, (node, row) => {
    const { level, word } = lost ? { level: "quiet", word: "–" } : row;
    mark(node, "level", level);
    say(node.firstChild, clip(row.name, 12));
    say(node.lastChild, level === "good" && row.answer_ms !== null && !isOldAnswer(row) ? ms(row.answer_ms) : word);
  });
}

function linkWords(view, lost, trouble) {
  if (trouble) return `The box answers: ${trouble}`;
  if (lost) return view ? "Box lost" : "No box";
  return view ? "Live" : "Looking for the box";
}

/** For who only listens; others see it in verdict and alarms. */
export function showLink(view, lost, trouble) {
  mark(document.body, "link", lost ? "lost" : view ? "live" : "opening");
  say(document.getElementById("link"), linkWords(view, lost, trouble));
}
