// Artifact reports, newest first: where each is in its life, what the Command Post said, and what can be done.
import { barred, deedsOf, isBusy, outcomeOf, perform } from "./deeds.js";
import { badge, list, make, mark, say } from "./dom.js";
import { nearTo } from "./near.js";
import { comparePair } from "./pair.js";
import { showStory } from "./story.js";
import { life } from "./verdict.js";
import { ago, clip, metres } from "./words.js";

const section = document.getElementById("reports");
const rows = section.querySelector(".rows");
const opened = new Set();
let last = null; // what was shown: {view, now}

const again = () => last && showReports(last.view, last.now);

function create(report) {
  const open = make("button.open");
  open.type = "button";
  open.append(make("span.chevron"), make("span.spoken"));
  open.addEventListener("click", () => toggle(report.number));
  const outcome = make("p.outcome");
  outcome.setAttribute("role", "status");
  return make("li", make("span.badge"), make("span.what"), make("span.where"), make("span.since"), make("span.more"), open,
    make("div.acts", make("div.near"), make("div.deeds")), outcome, make("div.story"));
}

function toggle(number) {
  if (!opened.delete(number)) opened.add(number);
  again();
}

/** Opens a report, brings it into view and puts the focus there. */
export function reveal(number) {
  opened.add(number);
  again();
  const row = rows.querySelector(`[data-key="${number}"]`);
  row?.scrollIntoView({ block: "nearest" });
  row?.querySelector(".open").focus({ preventScroll: true });
  return row !== null;
}

const nearestOf = (report, view) => (report.run === view.run_number && report.state !== "withdrawn" ? nearTo(view, report)[0] : undefined);

/** What else there is to know: the Command Post's words, or why it is where it is. */
function more(report, nearest) {
  const said = report.report_status && report.report_status !== "scored" ? report.report_status : "";
  const found = report.reconciled ? "found out from the run’s status" : "";
  const near = nearest ? `${nearest.metres.toFixed(1)} m from #${nearest.other.number}, of the same type` : "";
  return [said, found, report.note, near, report.status >= 400 ? `status ${report.status}` : ""].filter(Boolean).join(" · ");
}

function showNear(node, report, nearest) {
  const create = () => {
    const button = make("button", "Show both on the map");
    button.type = "button";
    return button;
  };
  list(node, nearest ? [nearest] : [], () => "both", create, (button, { other }) => {
    button.setAttribute("aria-label", `Show both on the map: reports ${report.number} and ${other.number}`);
    button.onclick = () => comparePair(report, other, button);
  });
}

function showDeeds(node, report, view, isShown) {
  const reason = barred();
  const createDeed = (deed) => {
    const button = make("button", deed.label);
    button.type = "button";
    button.setAttribute("aria-label", `${deed.label}: report ${report.number}`);
    return button;
  };
  list(node, isShown ? deedsOf(report) : [], (deed) => deed.label, createDeed, (button, deed) => {
    button.disabled = Boolean(reason) || isBusy(report.number);
    button.onclick = () => perform(deed, report, last.view.run?.remaining_reports, again);
  });
}

function update(node, report, view, now) {
  const { level, word } = life(report);
  const isOpen = opened.has(report.number);
  const [verdict, what, where, since, rest, open, acts, outcome, story] = node.children;
  const [near, deeds] = acts.children;
  mark(node, "level", level);
  badge(verdict, level, clip(word, 40));
  say(what, clip(report.type, 40));
  const { x, y, z } = report.position;
  say(where, `${metres(x)}, ${metres(y)}, ${metres(z)} m`);
  const earlier = report.run === view.run_number ? "" : ` · run ${report.run}`;
  say(since, `#${report.number} · ${ago(now - report.received)}${earlier}`);
  const nearest = nearestOf(report, view);
  say(rest, clip(more(report, nearest)));
  showNear(near, report, isOpen || level === "ask" ? nearest : undefined);
  open.setAttribute("aria-expanded", String(isOpen));
  say(open.lastChild, `More of report ${report.number}`);
  showDeeds(deeds, report, view, isOpen || level === "ask");
  const came = outcomeOf(report.number);
  say(outcome, came ? clip(came.text) : isBusy(report.number) ? "…" : "");
  mark(outcome, "bad", String(Boolean(came?.bad)));
  story.hidden = !isOpen;
  if (isOpen) showStory(story, report);
}

export function showReports(view, now) {
  last = { view, now };
  const { reports } = view;
  const open = reports.filter((report) => ["received", "waiting", "sending", "in doubt"].includes(report.state)).length;
  say(section.querySelector(".count"), !reports.length ? "" : open ? `${reports.length}, ${open} open` : `${reports.length}`);
  rows.hidden = reports.length === 0;
  section.querySelector(".empty").hidden = reports.length > 0;
  say(section.querySelector(".barred"), barred());
  list(rows, reports, (report) => report.number, create, (node, report) => update(node, report, view, now));
}
