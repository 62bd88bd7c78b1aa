// Artifact reports, newest first: where each is in its life, what the Command Post said, and what can be done.
import { barred, actionsOf, isBusy, outcomeOf, perform } from "./actions.js";
import { badge, list, make, mark, say } from "./dom.js";
import { nearTo } from "./near.js";
import { comparePair } from "./pair.js";
import { showHistory } from "./history.js";
import { life } from "./arriving.js";
import { ago, clip, metres } from "./words.js";

const section = document.getElementById("reports");
const rows = section.querySelector(".rows"), others = section.querySelector(".others");
const opened = new Set();
let last = null; // what was shown: {view, now}
let showsOthers = false; // what is done of other runs: of earlier ones, and of those at other Command Posts

const isOpen = (report) => ["received", "waiting", "sending", "in doubt"].includes(report.state);
const isOfOther = (report, view) => report.run !== view.run_number && !isOpen(report);

const rowOf = (number) => rows.querySelector(`[data-key="${number}"]`);
const again = () => last && showReports(last.view, last.now);

function create(report) {
  const open = make("button.open");
  open.type = "button";
  open.append(make("span.chevron"), make("span.spoken"));
  open.addEventListener("click", () => toggle(report.number));
  const outcome = make("p.outcome");
  outcome.setAttribute("role", "status");
  return make("li", make("span.badge"), make("span.what"), make("span.where"), make("span.since"), make("span.more"), open,
    make("div.acts", make("div.near"), make("div.actions")), outcome, make("div.history"));
}

function toggle(number) {
  if (!opened.delete(number)) opened.add(number);
  again();
}

others.addEventListener("click", () => {
  showsOthers = !showsOthers;
  again();
  const first = showsOthers && last.view.reports.find((report) => isOfOther(report, last.view));
  // They may be far down:
  if (first) rowOf(first.number).scrollIntoView({ block: "nearest" });
});

/** Opens a report, brings it into view and puts the focus there. */
export function reveal(number) {
  opened.add(number);
  showsOthers ||= Boolean(last?.view.reports.some((report) => report.number === number && isOfOther(report, last.view)));
  again();
  const row = rowOf(number);
  row?.scrollIntoView({ block: "nearest" });
  row?.querySelector(".open").focus({ preventScroll: true });
  return row !== null;
}

const nearestOf = (report, view) => (report.position && report.run === view.run_number && report.state !== "withdrawn" ? nearTo(view, report)[0] : undefined);

/** A report without a position is one that damage took from the ledger. */
const placeOf = ({ position }) => (position ? `${metres(position.x)}, ${metres(position.y)}, ${metres(position.z)} m` : "lost from the ledger");

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

function showActions(node, report, view, isShown) {
  const reason = barred();
  const createAction = (action) => {
    const button = make("button", action.label);
    button.type = "button";
    button.setAttribute("aria-label", `${action.label}: report ${report.number}`);
    return button;
  };
  list(node, isShown ? actionsOf(report) : [], (action) => action.label, createAction, (button, action) => {
    button.disabled = Boolean(reason);
    button.onclick = () => perform(action, report, last.view.run?.remaining_reports, again);
  });
}

function update(node, report, view, now) {
  const { level, word } = life(report);
  const isMore = opened.has(report.number);
  const [badged, what, where, since, rest, open, acts, outcome, history] = node.children;
  const [near, actions] = acts.children;
  mark(node, "level", level);
  badge(badged, level, clip(word, 40));
  say(what, clip(report.type, 40));
  say(where, placeOf(report));
  const earlier = report.run === view.run_number ? "" : ` · run ${report.run}`;
  say(since, `#${report.number} · ${ago(now - report.received)}${earlier}`);
  const nearest = nearestOf(report, view);
  say(rest, clip(more(report, nearest)));
  showNear(near, report, isMore || level === "ask" ? nearest : undefined);
  open.setAttribute("aria-expanded", String(isMore));
  say(open.lastChild, `More of report ${report.number}`);
  showActions(actions, report, view, isMore || level === "ask");
  const came = outcomeOf(report.number);
  say(outcome, came ? clip(came.text) : isBusy(report.number) ? "…" : "");
  mark(outcome, "bad", String(Boolean(came?.bad)));
  history.hidden = !isMore;
  if (isMore) showHistory(history, report);
}

/** "12, 2 open, 7 of other runs" */
function counted(reports, othersCount) {
  const open = reports.filter(isOpen).length;
  return [reports.length || "", open ? `${open} open` : "", othersCount ? `${othersCount} of other runs` : ""].filter(Boolean).join(", ");
}

export function showReports(view, now) {
  last = { view, now };
  const elsewhere = view.reports.filter((report) => isOfOther(report, view)).length;
  const shown = view.reports.filter((report) => showsOthers || !isOfOther(report, view));
  say(section.querySelector(".count"), counted(view.reports.filter((report) => !isOfOther(report, view)), elsewhere));
  others.hidden = elsewhere === 0;
  others.setAttribute("aria-pressed", String(showsOthers));
  say(others, "Other runs");
  rows.hidden = shown.length === 0;
  section.querySelector(".empty").hidden = shown.length > 0;
  say(section.querySelector(".barred"), barred());
  list(rows, shown, (report) => report.number, create, (node, report) => update(node, report, view, now));
}
