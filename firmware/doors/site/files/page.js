// The one live page. Each part draws itself from the last view of the run that came from the box.
import "./presses.js";
import { followWays } from "./alarm_ways.js";
import { showAlarms } from "./alarms.js";
import { allReports } from "./all_reports.js";
import { showRejected } from "./rejected.js";
import { say } from "./dom.js";
import { follow } from "./live.js";
import { showBoxActions } from "./box_actions.js";
import { offerClock } from "./clock.js";
import { compose, showCompose } from "./compose.js";
import { learned, linkIs } from "./actions.js";
import { listenToKeys } from "./keys.js";
import { sampleLink } from "./link.js";
import { map, showMap, time as shownTime } from "./map_controls.js";
import { showPair } from "./pair.js";
import { showPost } from "./post.js";
import { followHistory } from "./run_history.js";
import { showRefusals } from "./refusals.js";
import { showReports } from "./reports.js";
import { showRobots } from "./robots.js";
import { offerRobotsList, showRobotsList } from "./robots_list.js";
import { showLights, showRun } from "./run.js";
import { offerSides, closeSide, goTab } from "./side.js";
import { showEnds, showLink } from "./strip.js";
import { followNetwork } from "./pending.js";
import { showWho } from "./session.js";
import { clip, timeOfDay } from "./words.js";

const CALM = 1500; // ms: what only ages is drawn every other second
let drawn = -Infinity;

function show({ view: told, time, lost, trouble, isUrgent }) {
  const view = told && { ...told, reports: allReports(told, lost) };
  showLink(view, lost, trouble);
  linkIs(lost);
  showAlarms(view, time, lost, trouble);
  if (!view) return;
  showRun(view, time, lost);
  showBoxActions(view, time);
  showReports(view, time);
  if (!isUrgent && performance.now() - drawn < CALM) return;
  drawn = performance.now();
  showEnds(view, lost);
  showLights(view.lights);
  showRobotsList(showRobots(view, time, lost), time);
  showCompose(view);
  showMap(view, time);
  showPair(view, time);
  sampleLink(view, time, lost);
  if (!lost) followHistory(view, time);
  showPost(view, lost);
  showRejected(view.rejected, time);
  showRefusals(view.refusals, time);
  say(document.getElementById("about"), `Adit ${clip(view.version, 40)} · the box's clock ${timeOfDay(time)}`);
}

offerSides();
offerRobotsList();
followWays();
followNetwork();
showWho(document.getElementById("who"));
offerClock().catch(() => {}); // the alarm says that the time is not set
learned.then(follow("/adit/events", show));

function focus(tab, selector) {
  closeSide();
  goTab(tab);
  document.querySelector(selector)?.focus();
}
listenToKeys(
  [
    { key: "n", text: "new report", act: compose },
    { key: "r", text: "go to the reports", act: () => focus("reports", "#reports .open") },
    { key: "m", text: "go to the map", act: () => focus("map", "#map .frame canvas") },
    { key: "l", text: "show the map now", act: () => shownTime.goLive() },
    { key: ",", text: "show the map 10 s earlier", act: () => shownTime.step(-10) },
    { key: ".", text: "show the map 10 s later", act: () => shownTime.step(10) },
    { key: "<", text: "show the map 1 min earlier", act: () => shownTime.step(-60) },
    { key: ">", text: "show the map 1 min later", act: () => shownTime.step(60) },
    { key: "p", text: "play the run, or pause", act: () => shownTime.play(!shownTime.isPlaying()) },
    { key: "0", text: "show the whole map", act: () => map.fit() },
  ],
  [["← ↑ ↓ →", "on the map: move"], ["+ −", "on the map: zoom"], ["F", "on the map: show the whole map"], ["Esc", "close"]],
);
