// The log, newest first, as it grows.
import { badge, make } from "./dom.js";
import { get, isFault } from "./session.js";
import { clip, timeOfDay } from "./words.js";

const EVERY = 2000; // ms
const MOST = 500; // rows
const LEVELS = { error: "bad", warning: "wait", notice: "good" };

const section = document.getElementById("log");
const rows = section.querySelector(".rows"), empty = section.querySelector(".empty");
const level = section.querySelector("select"), text = section.querySelector("input"), file = section.querySelector("a");

let last = 0; // the number of the newest that was asked for
let asked = 0; // counts requests, so that a late answer to an older request is not shown

function row({ at, level, message, fields }) {
  const shown = LEVELS[level] ?? "quiet";
  const item = make("li", make("time", timeOfDay(at)), badge(make("span.badge"), shown, level), make("span.message", clip(message, 600)));
  item.dataset.level = shown;
  const said = Object.entries(fields).map(([name, value]) => `${name}=${value}`);
  if (said.length) item.append(make("span.fields", clip(said.join("  "), 1200)));
  return item;
}

function wanted() {
  const query = new URLSearchParams({ level: level.value });
  if (text.value) query.set("text", text.value);
  return query;
}

async function ask() {
  const mine = ++asked, query = wanted();
  query.set("since", String(last));
  const answer = await get(`/adit/log?${query}`);
  if (mine !== asked) return;
  if (answer.last < last) return startOver(); // the box restarted
  last = answer.last;
  rows.prepend(...answer.records.map(row).reverse());
  while (rows.children.length > MOST) rows.lastElementChild.remove();
  empty.hidden = rows.children.length > 0;
  empty.textContent = text.value || level.value !== "debug" ? "No record matches." : "No record yet.";
}

function startOver() {
  last = 0;
  rows.replaceChildren();
  file.href = `adit/log.txt?${wanted()}`;
  return ask();
}

/** Shows what comes; `lost(true or false)` is told whether the box answers. */
export function followLog(lost) {
  const turn = (action) => action().then(() => lost(false), (error) => isFault(error) || lost(true));
  for (const filter of [level, text]) filter.addEventListener("input", () => turn(startOver));
  const follow = async () => {
    if (!document.hidden) await turn(ask);
    setTimeout(follow, EVERY);
  };
  turn(startOver).then(() => setTimeout(follow, EVERY));
}
