// What this box refused to its senders, newest first, with the sentence that they got.
import { barred } from "./actions.js";
import { list, make, say, set } from "./dom.js";
import { ago, clip } from "./words.js";

/** A list has a step of its own. */
const wayTo = (key) => (key.includes("[") ? `/setup#${key.split("[")[0]}` : `/setup?setting=${key}#all`);

/** For an operator: the way to the setting that can prevent this refusal, if the box names one. */
function showCure(link, setting) {
  const key = barred() ? "" : setting;
  link.hidden = !key;
  if (!key || link.dataset.of === key) return;
  link.dataset.of = key;
  link.href = wayTo(key);
  say(link, `Set ${key}`);
}

/** How many poses or markers it was, or 1: a message as a whole. */
const weightOf = (row) => row.parts || 1;
const partsOf = (row) => (row.parts ? `${row.parts} ${row.parts === 1 ? "part" : "parts"} of ` : "");

const section = document.getElementById("refusals");

export function showRefusals(refusals, now) {
  set(section.querySelector(".rows"), { hidden: refusals.length === 0 });
  set(section.querySelector(".empty"), { hidden: refusals.length > 0 });
  say(section.querySelector(".count"), refusals.length ? String(refusals.reduce((sum, row) => sum + weightOf(row), 0)) : "");
  // The number of rows before it distinguishes two of one time.
  const seen = new Map();
  const key = (row) => {
    const name = `${row.at} ${row.uri} ${row.sender}`;
    seen.set(name, (seen.get(name) ?? 0) + 1);
    return `${name} ${seen.get(name)}`;
  };
  const create = () => make("li", make("span.status"), make("span.sentence"), make("span.who"), make("span.since"), make("a.cure"));
  list(section.querySelector(".rows"), refusals, key, create, (node, row) => {
    const [status, sentence, who, since, cure] = node.children;
    say(status, String(row.status));
    say(sentence, clip(row.sentence, 1200)); // ten of them, where parts of a message were refused
    say(who, `${partsOf(row)}${clip(row.uri, 60)} from ${clip(row.sender, 60)}`);
    say(since, ago(now - row.at));
    showCure(cure, row.setting);
  });
}
