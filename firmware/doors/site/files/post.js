// The Command Post: its two endpoints, and how much of the link is in use.
import { attribute, badge, list, make, mark, say } from "./dom.js";
import { answeredWords, clip, mbit, ms } from "./words.js";

const at = (id) => document.getElementById(id);

function createEndpoint() {
  return make("li", make("span.name"), make("span.badge"), make("span.address"), make("span.answer"), make("span.trouble"));
}

function updateEndpoint(node, row, lost) {
  const { level, word } = lost ? { level: "quiet", word: "unknown" } : row;
  const [name, badged, address, answer, trouble] = node.children;
  mark(node, "level", level);
  say(name, row.name);
  badge(badged, level, word);
  say(answer, row.last_status ? [`${row.last_status} in ${ms(row.answer_ms)}`, answeredWords(row)].filter(Boolean).join(", ") : "no answer");
  say(address, clip(row.address, 60));
  say(trouble, clip(row.trouble));
}

export function showPost(view, lost) {
  list(document.querySelector("#post .endpoints"), view.endpoints, (row) => row.name, createEndpoint, (node, row) => updateEndpoint(node, row, lost));
  const share = view.budget_mbit > 0 ? Math.min(100, (100 * view.sent_mbit) / view.budget_mbit) : 0;
  say(at("sent"), lost ? "–" : `${mbit(view.sent_mbit)} Mbit/s`);
  say(at("budget"), `of ${mbit(view.budget_mbit)}`);
  attribute(at("bar"), "aria-valuenow", share.toFixed(0));
  at("bar").firstElementChild.style.inlineSize = `${share}%`;
}
