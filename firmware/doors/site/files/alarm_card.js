// One alarm with its action, as the strip and the list of all show it.
import { barred } from "./actions.js";
import { attribute, make, mark, say, set } from "./dom.js";
import { post } from "./session.js";
import { clip, clock, timeOfDay } from "./words.js";

const SIDES = { robot: "Robot", box: "Box", network: "Network", command_post: "Command Post" };
/** What only the page can tell. */
export const BOX_LOST = "box_lost";

/** Whose the fault is, and the reason. Of a report: the reason alone, because the operator decides, and no side is at fault. */
function reasonOf(alarm) {
  const why = clip(alarm.why), side = /^reports?_/.test(alarm.id) && why ? "" : SIDES[alarm.side] ?? "";
  return [side, why].filter(Boolean).join(": ") + (alarm.hides ? ` · hides ${alarm.hides}` : "");
}

/** "uav3 was silent for 0:41, ended at 12:31" */
export const formerly = (over) => `${clip(over.was, 60)} for ${clock(over.until - over.since)}, ended at ${timeOfDay(over.until).slice(0, 5)}`;

/** Only to the box's own pages, or where it says that its page will be. */
const isWay = (link) => /^\/(?!\/)|^https?:\/\/[\w.:[\]-]+\/?$/.test(link);

async function acknowledge(id) {
  await post("/adit/alarms/acknowledge", { id }).catch(() => {}); // it has gone meanwhile: the next view says so
}

/** An alarm with its two buttons; for the strip and for the list. */
export function alarmCard() {
  const act = make("a.act"), seen = make("button.seen", "Acknowledge");
  seen.title = "Acknowledge: silence this alarm until it gets worse";
  const text = make("p.tx", make("strong", make("span.what"), " ", make("span.for")), make("span.why"));
  const node = make("div.alarm", make("span.glyph"), text, make("p.acts", act, seen));
  seen.addEventListener("click", () => acknowledge(node.dataset.key));
  return node;
}

export function fillCard(node, alarm, time) {
  const [glyph, text, acts] = node.children, [act, seen] = acts.children;
  mark(node, "level", alarm.severity);
  mark(node, "acknowledged", String(alarm.acknowledged));
  mark(glyph, "level", alarm.severity);
  const [what, lasts] = text.firstChild.children;
  say(what, clip(alarm.what, 60));
  say(lasts, clock(time - alarm.since));
  say(text.lastChild, reasonOf(alarm));
  say(act, clip(alarm.action.word, 20));
  set(act, { hidden: !alarm.action.word || !isWay(alarm.action.link) });
  if (!act.hidden) attribute(act, "href", alarm.action.link);
  set(seen, { hidden: alarm.acknowledged || alarm.id === BOX_LOST || barred() !== "" });
}
