// The alarms of the box: a strip with the two worst, each with its action, which has one height in every state; the list of all;
// the tab's title and icon; and a sound if the operator wants one.
import { fillAlarmList } from "./alarm_list.js";
import { sounds } from "./alarm_sound.js";
import { alarmCard, BOX_LOST, fillCard, formerly } from "./alarm_card.js";
import { open } from "./dialog.js";
import { list, make, mark, say } from "./dom.js";
import { showOnTab } from "./side.js";
import { clip, timeOfDay } from "./words.js";

const SHOWN = 2;
const NO_ACTION = { word: "", link: "" };
const LOST = { id: BOX_LOST, severity: "bad", side: "box", what: "The box does not answer", action: NO_ACTION, acknowledged: false, hides: 0 };

const cards = document.getElementById("attention");
const dialog = document.getElementById("all-alarms");
const all = document.querySelector(".alarms .all");
all.addEventListener("click", () => open(dialog));

/** What is not acknowledged comes first, so that nothing that is new is behind what is known. */
const inOrder = (alarms) => [...alarms.filter((alarm) => !alarm.acknowledged), ...alarms.filter((alarm) => alarm.acknowledged)];

/** Beside maps that are late, it is not green. */
function calm(over, verdict) {
  if (!cards.querySelector(".calm")) {
    cards.replaceChildren(make("div.calm", make("span.glyph"), make("p.tx", make("strong", "No alarm"), make("span.why"))));
  }
  const node = cards.querySelector(".calm");
  mark(node, "key", "calm");
  mark(node.firstChild, "level", verdict.level === "good" ? "good" : "quiet");
  say(node.querySelector(".why"), over.length ? `last alarm: ${formerly(over[0])}` : "no earlier alarm");
}

const ICONS = { bad: "icon_bad.svg", ask: "icon_ask.svg", wait: "icon_wait.svg" };

function showTab(alarms) {
  const worst = alarms.find((alarm) => !alarm.acknowledged) ?? alarms[0];
  const icon = ICONS[worst?.severity] ?? "icon.svg", link = document.querySelector("link[rel=icon]");
  if (link.getAttribute("href") !== icon) link.setAttribute("href", icon);
  const title = worst ? `(${alarms.length}) ${clip(worst.what, 60)} – Adit` : "Adit";
  if (document.title !== title) document.title = title;
}

const TABS = { reports: /^\/#reports?\b/, robots: /^\/#robot=/ }; // by where an alarm's action leads

function showOnTabs(alarms) {
  for (const [tab, way] of Object.entries(TABS)) showOnTab(tab, alarms.filter(({ action }) => way.test(action.link)));
}

/** The box does not answer, or answers a page with `trouble`. */
function lostAlarm(view, since, trouble) {
  if (trouble) return { ...LOST, since, what: "The box sends no data to this page", why: trouble };
  return { ...LOST, since, why: view ? `last data at ${timeOfDay(view.now)}` : "connecting" };
}

/** `view`: null where none came yet; `trouble`: the box's sentence where it answers with an error, or "". */
export function showAlarms(view, time, lost, trouble) {
  const now = time ?? 0;
  const told = inOrder(view?.alarms ?? []), over = view?.alarms_over ?? [];
  const since = view ? view.now : now;
  const shown = lost ? [lostAlarm(view, since, trouble), ...told] : told;
  if (!shown.length && view) calm(over, view.verdict);
  else list(cards, shown.slice(0, SHOWN), (alarm) => alarm.id, alarmCard, (node, alarm) => fillCard(node, alarm, now));
  say(all, shown.length ? `All ${shown.length}` : "History");
  fillAlarmList(dialog, shown, over, now);
  showTab(shown);
  showOnTabs(shown);
  sounds(shown);
}
