// The one live page. Each part draws itself from the last view of the run that came from the box.
import { badge, mark, say } from "./dom.js";
import { listen } from "./live.js";
import { showPost, sample } from "./post.js";
import { showRefusals } from "./refusals.js";
import { showReports } from "./reports.js";
import { showRobots } from "./robots.js";
import { showAttention, showLights, showRun } from "./run.js";
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
  if (!view) return showAttention([], lost ? "The box does not answer." : "");
  const time = now();
  showAttention(view.attention, lost ? `The box does not answer: all below is as it was at ${timeOfDay(view.now)}.` : "");
  showRun(view, time, lost);
  showLights(view.lights);
  showRobots(view.activities, time, lost);
  showReports(view, time);
  showPost(view, lost);
  showRefusals(view.refusals, time);
  say(document.getElementById("about"), `Adit ${clip(view.version, 40)} · the box's clock ${timeOfDay(time)}`);
  const title = lost ? "Box lost – Adit" : view.attention.length ? `(${view.attention.length}) Adit` : "Adit";
  if (document.title !== title) document.title = title;
}

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
  if (view) sample(lost ? 0 : view.sent_mbit);
  show();
}, 1000);
