// The one live page. Each part draws itself from the last view of the run that came from the box.
import "./presses.js";
import { showAside } from "./aside.js";
import { badge, mark, say } from "./dom.js";
import { follow } from "./live.js";
import { showBoxActions } from "./box_actions.js";
import { compose, showCompose } from "./compose.js";
import { learned, linkIs } from "./actions.js";
import { listenToKeys } from "./keys.js";
import { sampleLink } from "./link.js";
import { goLive, map, showMap } from "./map_controls.js";
import { showPair } from "./pair.js";
import { showPost } from "./post.js";
import { showRefusals } from "./refusals.js";
import { showReports } from "./reports.js";
import { showRobots } from "./robots.js";
import { showAttention, showLights, showRun } from "./run.js";
import { followNetwork } from "./pending.js";
import { showWho } from "./session.js";
import { clip, timeOfDay } from "./words.js";

function showLink(view, lost) {
  const link = document.getElementById("link");
  mark(document.body, "link", lost ? "lost" : view ? "live" : "opening");
  if (lost) badge(link, "bad", view ? "Box lost" : "No box");
  else badge(link, view ? "good" : "quiet", view ? "Live" : "Looking for the box");
}

function show({ view, time, lost }) {
  showLink(view, lost);
  linkIs(lost);
  if (!view) return showAttention([], lost ? "The box does not answer." : "");
  showAttention(view.attention, lost ? `The box does not answer: all below is as it was at ${timeOfDay(view.now)}.` : "");
  showRun(view, time, lost);
  showBoxActions(view, time);
  showLights(view.lights);
  showRobots(view.activities, time, lost);
  showReports(view, time);
  showCompose(view);
  showMap(view, time);
  showPair(view, time);
  sampleLink(view, time, lost);
  showPost(view, lost);
  showAside(view.aside, time);
  showRefusals(view.refusals, time);
  say(document.getElementById("about"), `Adit ${clip(view.version, 40)} · the box's clock ${timeOfDay(time)}`);
  const title = lost ? "Box lost – Adit" : view.attention.length ? `(${view.attention.length}) Adit` : "Adit";
  if (document.title !== title) document.title = title;
}

followNetwork();
showWho(document.getElementById("who"));
learned.then(follow("/adit/events", show));

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
