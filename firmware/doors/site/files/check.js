// What a person should know before a report is sent: whether it may be there already, and what it costs.
import { life } from "./arriving.js";
import { nearestOf, nearTo, sameAs } from "./near.js";
import { ago, clip } from "./words.js";

const named = (report) => `#${report.number} ${clip(report.type, 40)}`;
const stands = (report, now) => `${life(report).word}, ${ago(now - report.received)}`;

function cost({ run }, isSame) {
  if (isSame) return { key: "cost", level: "good", text: "The box sends the same report only once. This uses up no report." };
  if (!run) return { key: "cost", level: "wait", text: "Uses up a report. The number of reports left is not known." };
  if (run.remaining_reports <= 0) return { key: "cost", level: "bad", text: "No report is left, so this report cannot score." };
  return { key: "cost", level: run.remaining_reports > 5 ? "good" : "wait", text: `Uses up 1 of the ${run.remaining_reports} reports left.` };
}

function none(view, report) {
  const next = nearestOf(view, report);
  const nearest = next ? `: the nearest is #${next.other.number}, ${next.metres.toFixed(0)} m away` : "";
  return { key: "none", level: "good", text: `No other ${report.type} within ${view.near_metres} m${nearest}.` };
}

/** [{key, level, text}] of a report {type, position} that is about to be sent. */
export function notesOn(view, report) {
  const same = sameAs(view, report);
  const near = nearTo(view, report).filter(({ other }) => other.number !== same?.number);
  return [
    ...(same ? [{ key: "same", level: "wait", text: `Already reported at the same place: ${named(same)}, ${stands(same, view.now)}.` }] : []),
    ...near.map(({ other, metres }) => ({ key: other.number, level: "wait",
      text: `${named(other)} is ${metres.toFixed(1)} m away (${stands(other, view.now)}). It may be the same artifact.` })),
    ...(same || near.length ? [] : [none(view, report)]),
    cost(view, Boolean(same)),
  ];
}
