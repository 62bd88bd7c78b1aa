// The run as others look at it: no controls, everything on one screen.
import { allReports } from "./all_reports.js";
import { icon } from "./artifact_icons.js";
import { badge, list, make, mark, say } from "./dom.js";
import { follow } from "./live.js";
import { MapOfRun } from "./map.js";
import { showAttention, showRun } from "./run.js";
import { followHistory } from "./run_history.js";
import { life } from "./arriving.js";
import { showRobots } from "./robots.js";
import { showEnds } from "./strip.js";
import { clip, placeOf, timeOfDay } from "./words.js";

const calm = ({ verdict }) => ({ id: "calm", severity: verdict.level === "good" ? "good" : "quiet", what: "No alarm" });
const newFirst = ({ severity, acknowledged }) => 2 * Number(severity === "wait") + Number(acknowledged);
const MOST_REPORTS = 20; // more than fit any screen
const HIDES_POINTLESS = new URLSearchParams(location.search).get("hide") === "no-points";

const map = new MapOfRun(document.querySelector("#map canvas"));
map.setShown("pointless", !HIDES_POINTLESS);
const reports = document.getElementById("reports");

function showReports(view) {
  const all = view.reports.filter((report) => report.run === view.run_number);
  const mine = HIDES_POINTLESS ? all.filter((report) => report.score_change !== 0) : all, hidden = all.length - mine.length;
  say(reports.querySelector(".count"), [mine.length || "", hidden && `${hidden} without points hidden`].filter(Boolean).join(", "));
  reports.querySelector(".empty").hidden = all.length > 0;
  const create = (report) => make("li", icon(report.type), make("span.what"), make("span.badge"), make("span.number"));
  list(reports.querySelector("ol"), mine.slice(0, MOST_REPORTS), (report) => report.number, create, (node, report) => {
    const { level, word } = life(report);
    const [, what, badged, number] = node.children;
    mark(node, "level", level);
    say(what, clip(report.type, 40));
    badge(badged, level, clip(word, 20));
    say(number, `#${report.number} · ${placeOf(report)}`);
  });
}

function show({ view: told, time, lost, trouble }) {
  const away = trouble || "The box does not answer";
  const view = told && { ...told, reports: allReports(told, lost) };
  mark(document.body, "link", lost ? "lost" : view ? "live" : "opening");
  if (!view) return showAttention([], lost ? `${away}.` : "");
  const calling = [...view.alarms].sort((a, b) => newFirst(a) - newFirst(b)).slice(0, lost ? 1 : 2);
  showAttention(calling.length || lost ? calling : [calm(view)], lost ? `${away}: last data at ${timeOfDay(view.now)}.` : "");
  showRun(view, time, lost);
  showEnds(view, lost);
  showRobots(view, time, lost);
  showReports(view);
  map.show(view);
  if (!lost) followHistory(view, time);
}

follow("/adit/events", show);
