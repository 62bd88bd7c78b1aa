// The operator's actions on a report, and their results.
import { learnChange } from "./all_reports.js";
import { confirmed } from "./dialog.js";
import { post, session } from "./session.js";

const SEND = { name: "send", label: "Send" };
const AGAIN = { name: "send", label: "Send again" };
const COSTLY_SEND = { name: "send", label: "Send again", costs: "If the report is recorded already, it is recorded twice" };
const NEAR_SEND = { name: "send", label: "Send", costs: "Another report of this type is close by and may be the same artifact" };
export const CORRECT = { name: "correct", label: "Correct" }; // compose.js
const UNCORRECTED_SEND = { name: "send", label: "Send", costs: "The report was corrected" };
const LATE_SEND = { name: "send", label: "Send", costs: "The report was withdrawn" };
const SEND_NOW = { name: "send", label: "Send now" };
const UNDO = { name: "withdraw", label: "Undo" };
const HOLD = { name: "hold", label: "Hold" };
const WITHDRAW = { name: "withdraw", label: "Withdraw" };
const SETTLE = { name: "settle", label: "Settle" };
const RESUBMIT = { name: "resubmit", label: "Resubmit", costs: "The report is sent again as a new report" };

/** By the state that a report is in: the actions that the box takes (README.md). */
const DEEDS = {
  held: [SEND, CORRECT, WITHDRAW],
  queued: [HOLD, WITHDRAW],
  sending: [],
  in_doubt: [COSTLY_SEND, SETTLE],
  rejected: [AGAIN],
  withdrawn: [LATE_SEND],
  answered: [RESUBMIT],
  settled: [RESUBMIT],
};

/** `isNear`: another of its type was reported close by. */
export function actionsOf(report, isNear = false) {
  if (!report.position) return report.state === "in_doubt" ? [SETTLE] : []; // it is lost
  if (report.sends_at) return [UNDO, SEND_NOW];
  if (report.state === "withdrawn" && report.same_as > report.number) return [UNCORRECTED_SEND];
  if (report.state === "withdrawn" && report.same_as) return [COSTLY_SEND];
  if (report.state === "held" && report.same_as) return [COSTLY_SEND, CORRECT, WITHDRAW];
  if (report.state === "held" && isNear) return [NEAR_SEND, CORRECT, WITHDRAW];
  return DEEDS[report.state] ?? [];
}

/** What the buttons of a report in doubt do, in one line; "" if a report needs none. */
export function hintOf({ state, position }) {
  if (state !== "in_doubt") return "";
  const settle = `${SETTLE.label}: it is never sent again.`;
  return position ? `Not recorded? ${AGAIN.label}. Recorded? ${settle}` : settle;
}

let role = null, lost = false; // null: not learned yet

/** Why nothing can be done now, or "". */
export function barred() {
  if (lost) return "The box sends no data to this page, so you cannot act.";
  if (role === null) return "Checking your login.";
  return role === "operator" ? "" : "Only an operator can act. Log in as operator.";
}

export function linkIs(isLost) {
  if (lost && !isLost) learnRole();
  lost = isLost;
}

async function learnRole() {
  ({ role } = await session().catch(() => ({ role })));
}
/** Ends once it is known who looks at this page. */
export const learned = learnRole();

// The result of the last action on each report: {text, bad}.
const outcomes = new Map();
const underWay = new Set();
/** "" once it is no longer true: the report was sent, and this shows by itself. */
export function outcomeOf({ number, state }) {
  const outcome = outcomes.get(number);
  return [PAST.send, ACCEPTED].includes(outcome?.text) && ["in_doubt", "answered", "rejected"].includes(state) ? undefined : outcome;
}
export const isBusy = (number) => underWay.has(number);
export const tell = (number, text, bad = false) => outcomes.set(number, { text, bad });

export const ACCEPTED = "Accepted.";
const PAST = { send: "The report will be sent.", hold: "Held until you send it.", withdraw: "Withdrawn.", settle: "Settled." };

function question(action, report, remaining) {
  const left = remaining === undefined ? "" : ` ${remaining} reports are left.`;
  const title = `${action.label}: report ${report.number}, ${report.type}?`;
  return { title, text: `${action.costs}. This uses up a report.${left}`, word: action.label };
}

/** Does it, asking first where it costs a report. `shown` is called whenever there is something new to show. */
export async function perform(action, report, remaining, shown) {
  const { number } = report;
  if (underWay.has(number) || barred()) return;
  if (action.costs && !(await confirmed(question(action, report, remaining)))) return;
  underWay.add(number);
  outcomes.delete(number);
  shown();
  try {
    const answer = await post(`/adit/reports/${number}/${action.name}`);
    await learnChange(number);
    tell(number, action.name === "resubmit" ? `Sent again as report ${answer.report}.` : PAST[action.name]);
  } catch (error) {
    tell(number, error.message, true);
  } finally {
    underWay.delete(number);
    shown();
  }
}
