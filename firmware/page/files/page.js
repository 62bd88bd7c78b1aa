// The one live page. Each part draws itself from the last view of the run that came from the box.
import { badge, mark, say } from "./dom.js";
import { listen } from "./live.js";
import { compose, showCompose } from "./compose.js";
import { linkIs } from "./deeds.js";
import { listenToKeys } from "./keys.js";
import { sampleLink } from "./link.js";
import { goLive, map, showMap } from "./map_controls.js";
import { showPost } from "./post.js";
import { showRefusals } from "./refusals.js";
import { showReports } from "./reports.js";
import { showRobots } from "./robots.js";
import { showAttention, showLights, showRun } from "./run.js";
import { followNetwork } from "./pending.js";
import { showWho } from "./session.js";
import { clip, timeOfDay } from "./words.js";

let view = null, heardAt = 0, lost = false;

/** The box's clock. */
const now = () => view.now + (performance.now() - heardAt) / 1000;

function showLink() {
  const link = document.getElementById("link");
  mark(document.body, "link", lost ? "lost" : view ? "live" : "opening");
  if (lost) badge(link, "bad", view ? "Box lost" : "No box");
  else badge(link, view ? "good" : "quiet", view ? "Live" : "Looking for the box");
}

function show() {
  showLink();
  linkIs(lost);
  if (!view) return showAttention([], lost ? "The box does not answer." : "");
  const time = now();
  showAttention(view.attention, lost ? `The box does not answer: all below is as it was at ${timeOfDay(view.now)}.` : "");
  showRun(view, time, lost);
  showLights(view.lights);
  showRobots(view.activities, time, lost);
  showReports(view, time);
  showCompose(view);
  showMap(view, time);
  showPost(view, lost);
  showRefusals(view.refusals, time);
  say(document.getElementById("about"), `Adit ${clip(view.version, 40)} · the box's clock ${timeOfDay(time)}`);
  const title = lost ? "Box lost – Adit" : view.attention.length ? `(${view.attention.length}) Adit` : "Adit";
  if (document.title !== title) document.title = title;
}

followNetwork();
showWho(document.getElementById("who"));
listen(
  "/adit/events",
  (next) => {
    view = next;
    heardAt = performance.now();
    show();
  },
  (isLost) => {
    lost = isLost;
    show();
  },
);

// Ages grow, and the link is sampled, whether or not anything comes.
setInterval(() => {
  if (view) sampleLink(view, lost);
  show();
}, 1000);

const focus = (selector) => document.querySelector(selector)?.focus();
listenToKeys(
  [
    { key: "n", text: "a new report", act: compose },
    { key: "r", text: "to the reports", act: () => focus("#reports .open") },
    { key: "m", text: "to the map", act: () => focus("#map .frame canvas") },
    { key: "l", text: "the map as it is now", act: goLive },
    { key: "0", text: "all of the map", act: () => map.fit() },
  ],
  [["← ↑ ↓ →", "on the map: move it"], ["+ −", "on the map: zoom"], ["F", "on the map: all of it"], ["Esc", "close, or give up picking a place"]],
);
