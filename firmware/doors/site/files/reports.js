// Artifact reports, newest first: the state of each, the Command Post's answer, and the possible actions.
import { actionsOf, barred, CORRECT, hintOf, isBusy, outcomeOf, perform } from "./actions.js";
import { icon } from "./artifact_icons.js";
import { correct } from "./compose.js";
import { attribute, badge, list, make, mark, say, set } from "./dom.js";
import { isCounted, nearTo } from "./near.js";
import { comparePair } from "./pair.js";
import { showHistory } from "./history.js";
import { isOpen, life } from "./arriving.js";
import { remembered } from "./remembered.js";
import { Still } from "./still.js";
import { closeSide, goTab } from "./side.js";
import { ago, clip, placeOf } from "./words.js";

const section = document.getElementById("reports");
const rows = section.querySelector(".rows"), others = section.querySelector(".others"), filter = section.querySelector(".filter select");
const MANY = 100; // rows, until one scrolls to the end of them
const opened = new Set();
let last = null; // the last shown: {view, now}
let showsOthers = false; // shows settled reports of other runs: earlier ones, and those at other Command Posts

const isOfOther = (report, { run_number }) => report.run !== run_number && !isOpen(report);

const rowOf = (number) => rows.querySelector(`[data-key="${number}"]`);
const again = () => last && showReports(last.view, last.now);
const own = new Set(); // those that this operator has acted on since the list was left
const still = new Still(rows, () => {
  own.clear();
  again();
});
const newer = section.querySelector(".newer");
newer.addEventListener("click", () => {
  still.release();
  rows.scrollTop = rows.parentNode.scrollTop = 0;
});
filter.addEventListener("change", () => still.release());
let most = MANY; // rows that are shown
const MORE = 200; // pixels from the end
rows.parentNode.addEventListener("scroll", ({ target }) => {
  if (target.scrollTop + target.clientHeight < target.scrollHeight - MORE || most > (last?.count ?? 0)) return;
  most += MANY;
  again();
}, { passive: true });

function create(report) {
  const open = make("button.open");
  open.append(make("span.chevron"), make("span.spoken"));
  open.addEventListener("click", () => toggle(report.number));
  const outcome = make("p.outcome");
  outcome.setAttribute("role", "status");
  const title = make("div.title", make("span.what"), make("span.where", make("span"), make("span.since")));
  return make("li", make("span.picture", icon(report.type)), title, make("span.badge"), open, make("span.more"),
    make("div.acts", make("div.near"), make("div.actions")), make("p.hint"), outcome, make("div.history"));
}

function toggle(number) {
  if (!opened.delete(number)) opened.add(number);
  own.add(number);
  still.resize(rowOf(number));
  again();
}

others.addEventListener("click", () => {
  showsOthers = !showsOthers;
  const at = last.view.reports.findIndex((report) => isOfOther(report, last.view)), first = showsOthers && last.view.reports[at];
  most = Math.max(most, at + MANY);
  still.release();
  // They may be far down:
  if (first) rowOf(first.number)?.scrollIntoView({ block: "nearest" });
});

/** Opens a report, brings it into view and puts the focus there. */
export function reveal(number) {
  closeSide();
  goTab("reports");
  opened.add(number);
  filter.value = "";
  showsOthers ||= Boolean(last?.view.reports.some((report) => report.number === number && isOfOther(report, last.view)));
  if (last?.view.reports.length > most) most = last.view.reports.length;
  still.release();
  const row = rowOf(number);
  row?.scrollIntoView({ block: "nearest" });
  row?.querySelector(".open").focus({ preventScroll: true });
  return row !== null;
}

const nearestOf = (report, view) => (isCounted(report, view) ? nearTo(view, report)[0] : undefined);

/** What else there is to know: the Command Post's words, or why it is where it is. */
function more(report, nearest, now) {
  const left = report.sends_at ? `sent in ${Math.max(0, Math.ceil(report.sends_at - now))} s` : "";
  const said = report.report_status && report.report_status !== "scored" ? report.report_status : "";
  const found = report.reconciled ? "found in the run’s status" : "";
  const near = nearest ? `${nearest.metres.toFixed(1)} m from #${nearest.other.number}, of the same type` : "";
  return [left, said, found, report.note, near, report.status >= 400 ? `status ${report.status}` : ""].filter(Boolean).join(" · ");
}

function showNear(node, report, nearest) {
  list(node, nearest ? [nearest] : [], () => "both", () => make("button", "Show both"), (button, { other }) => {
    button.setAttribute("aria-label", `Show both on the map: reports ${report.number} and ${other.number}`);
    button.onclick = () => comparePair(report, other, button);
  });
}

function showActions(node, report, view, isShown) {
  const reason = barred();
  const createAction = (action) => {
    const button = make("button", action.label);
    button.setAttribute("aria-label", `${action.label}: report ${report.number}`);
    return button;
  };
  const actions = isShown ? actionsOf(report, Boolean(nearestOf(report, view))) : [];
  if (still.isHeld && !own.has(report.number) && node.children.length) {
    // Somebody else acted: an action that is no longer possible keeps its place, so that no other button comes under the hand.
    for (const button of node.children) button.disabled = Boolean(reason) || !actions.some(({ label }) => label === button.dataset.key);
    return;
  }
  list(node, actions, (action) => action.label, createAction, (button, action) => {
    button.disabled = Boolean(reason);
    button.onclick = () => {
      own.add(report.number);
      if (action === CORRECT) correct(report);
      else perform(action, report, last.view.run?.remaining_reports, again);
    };
  });
}

/** If `isStill`, the text keeps its height, so that no button moves below it. */
function sayAtPlace(node, text, isStill) {
  if (!isStill) node.style.blockSize = "";
  else if (!node.firstChild) return;
  else node.style.blockSize ||= `${node.offsetHeight}px`;
  say(node, isStill ? text || "\u00a0" : text);
}

function update(node, report, view, now) {
  const { level, word } = life(report);
  const isMore = opened.has(report.number);
  const [, title, badged, open, rest, acts, hint, outcome, history] = node.children;
  const [what, where] = title.children;
  const [near, actions] = acts.children;
  mark(node, "level", level);
  badge(badged, level, clip(word, 40));
  say(what, clip(report.type, 40));
  const robot = report.robot ? ` · ${clip(report.robot, 40)}` : "";
  const earlier = report.run === view.run_number ? "" : ` · run ${report.run}`;
  say(where.firstChild, `#${report.number} · ${placeOf(report)}${robot}${earlier}`);
  say(where.lastChild, ` · ${ago(now - report.received)}`);
  const isTold = isMore || isOpen(report) || level === "bad" || level === "ask";
  const nearest = isTold ? nearestOf(report, view) : undefined;
  const isStill = still.isHeld && !own.has(report.number) && node.dataset.told && !report.sends_at;
  sayAtPlace(rest, isTold ? clip(more(report, nearest, now)) : "", isStill);
  mark(node, "told", "true");
  if (!still.isHeld || own.has(report.number) || !near.firstChild) showNear(near, report, isMore || level === "ask" ? nearest : undefined);
  attribute(open, "aria-expanded", String(isMore));
  say(open.lastChild, `Details of report ${report.number}`);
  showActions(actions, report, view, isMore || level === "ask" || Boolean(report.sends_at));
  say(hint, actions.firstChild ? hintOf(report) : "");
  set(acts, { hidden: !acts.querySelector("button") });
  const came = outcomeOf(report);
  say(outcome, came ? clip(came.text) : isBusy(report.number) ? "…" : "");
  mark(outcome, "bad", String(Boolean(came?.bad)));
  set(history, { hidden: !isMore });
  if (isMore) showHistory(history, report);
}

const RANKS = { ask: 0, wait: 1 };
/** Open ones first, those that wait for the operator's word before all; then the newest. */
const inOrder = (reports) => {
  const rank = (report) => (isOpen(report) ? (RANKS[life(report).level] ?? 1) : 2);
  const ranked = reports.map((report) => ({ report, rank: rank(report) }));
  return ranked.sort((a, b) => a.rank - b.rank || b.report.number - a.report.number).map(({ report }) => report);
};

/** "20 sent, 1 in doubt" */
function counted(reports) {
  const count = (...states) => reports.filter(({ state }) => states.includes(state)).length;
  const parts = [
    [count("sending", "in_doubt", "answered", "settled", "rejected"), "sent"],
    [count("in_doubt"), "in doubt"],
    [count("held"), "held"],
    [count("queued"), "queued"],
  ];
  return parts.filter(([n]) => n).map(([n, words]) => `${n} ${words}`).join(", ");
}

const keysOf = ({ state, type }) => [`state ${state}`, `type ${type}`];

/** Offers the states and types that there are. Nothing changes in the list while it is open. */
function showFilter(keys) {
  if (document.activeElement === filter) return;
  const create = (key) => {
    const option = make("option", clip(key.replace(/^\w+ /, "").replace("in_doubt", "in doubt"), 20) || "All");
    option.value = key;
    return option;
  };
  list(filter, ["", ...keys], (key) => key, create, () => {});
}

/** {all: the reports to list, keys: their states and types, count: in words, hasOthers}. */
const arranged = remembered((reports, run_number, withOthers) => {
  const mine = reports.filter((report) => !isOfOther(report, { run_number })), all = withOthers ? reports : mine;
  const keys = [...new Set(all.map(({ state }) => `state ${state}`)), ...new Set(all.map(({ type }) => `type ${type}`))];
  return { all, keys, count: counted(mine), hasOthers: mine.length < reports.length };
});
const wanted = remembered((reports, key) => inOrder(reports.filter((report) => !key || keysOf(report).includes(key) || life(report).level === "ask")));

export function showReports(view, now) {
  last = { view, now, count: view.reports.length };
  const { all, keys, count: words, hasOthers } = arranged(view.reports, view.run_number, showsOthers);
  showFilter(keys);
  const shown = still.order(wanted(all, filter.value).slice(0, most), ({ number }) => number);
  const count = section.querySelector(".count");
  say(count, words);
  set(count.parentNode, { title: words });
  set(others, { hidden: !hasOthers });
  attribute(others, "aria-pressed", String(showsOthers));
  say(others, "All runs");
  set(newer, { hidden: still.waiting === 0 });
  say(newer, `${still.waiting} new`);
  const empty = section.querySelector(".empty");
  set(rows, { hidden: shown.length === 0 });
  set(empty, { hidden: shown.length > 0 });
  say(empty, all.length ? "No such report." : "No report yet.");
  say(section.querySelector(".barred"), barred());
  list(rows, shown, (report) => report.number, create, (node, report) => update(node, report, view, now));
}
