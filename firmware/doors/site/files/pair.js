// Two reports that may be of one artifact, side by side: on the map and in words.
import { badge, list, make, mark, say } from "./dom.js";
import { map } from "./map_controls.js";
import { distance } from "./near.js";
import { life } from "./arriving.js";
import { goTab } from "./side.js";
import { ago, clip, metres } from "./words.js";

const panel = document.querySelector("#map .pair");
let numbers = null, back = null, tab = "map";
let last = null; // the last shown: {view, now}

/** Shows both on the map; the focus goes back to `from` in the end. */
export function comparePair(one, other, from) {
  numbers = [one.number, other.number].sort((a, b) => a - b);
  back = from;
  map.showPair([one, other]);
  panel.hidden = false;
  tab = document.body.dataset.tab;
  goTab("map");
  showPair(last.view, last.now);
  panel.querySelector("button").focus({ preventScroll: true });
}

function close() {
  numbers = null;
  panel.hidden = true;
  map.showPair(null);
  map.fit();
  goTab(tab);
  back?.focus();
}
panel.querySelector("button").addEventListener("click", close);
panel.addEventListener("keydown", (event) => event.key === "Escape" && close());

function update(node, report, now) {
  const { level, word } = life(report);
  const [name, badged, where, whence] = node.children;
  mark(node, "level", level);
  say(name, `#${report.number} ${clip(report.type, 40)}`);
  badge(badged, level, clip(word, 40));
  const { x, y, z } = report.position;
  say(where, `${metres(x)}, ${metres(y)}, ${metres(z)} m`);
  say(whence, `${ago(now - report.received)}, from ${clip(report.sender, 40)}`);
}

export function showPair(view, now) {
  last = { view, now };
  if (!numbers) return;
  const both = numbers.map((number) => view.reports.find((report) => report.number === number)).filter(Boolean);
  if (both.length < 2) return close();
  say(panel.querySelector(".apart"), `${distance(...both).toFixed(1)} m apart: one artifact, or two?`);
  const create = () => make("li", make("strong"), make("span.badge"), make("span.where"), make("span.whence"));
  list(panel.querySelector("ol"), both, (report) => report.number, create, (node, report) => update(node, report, now));
}
