// What this box refused to its senders, newest first, with the sentence that they got.
import { list, make, say } from "./dom.js";
import { ago, clip } from "./words.js";

const section = document.getElementById("refusals");

export function showRefusals(refusals, now) {
  section.querySelector(".rows").hidden = refusals.length === 0;
  section.querySelector(".empty").hidden = refusals.length > 0;
  say(section.querySelector(".count"), refusals.length ? String(refusals.length) : "");
  // Two of one moment are told apart by how many stand before them.
  const seen = new Map();
  const key = (row) => {
    const name = `${row.at} ${row.uri} ${row.sender}`;
    seen.set(name, (seen.get(name) ?? 0) + 1);
    return `${name} ${seen.get(name)}`;
  };
  const create = () => make("li", make("span.status"), make("span.sentence"), make("span.who"), make("span.since"));
  list(section.querySelector(".rows"), refusals, key, create, (node, row) => {
    const [status, sentence, who, since] = node.children;
    say(status, String(row.status));
    say(sentence, clip(row.sentence));
    say(who, `${clip(row.uri, 60)} from ${clip(row.sender, 60)}`);
    say(since, ago(now - row.at));
  });
}
