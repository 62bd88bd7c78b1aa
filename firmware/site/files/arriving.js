// What the figures mean: for each thing a level (its shape and colour), a word, and a sentence where one helps.
//   good: as it should be   wait: late, or about to be decided   bad: it does not work   quiet: nothing to tell
//   ask: it waits for the operator's word
import { signed } from "./words.js";

export const kindOf = (row) => (row.kind === "state" ? "pose" : row.kind);

function gained({ score_change, report_status }) {
  if (score_change === null) return { level: "quiet", word: report_status || "answered" };
  if (score_change > 0) return { level: "good", word: `scored ${signed(score_change)}` };
  return { level: "quiet", word: score_change === 0 ? "no points" : `scored ${signed(score_change)}` };
}

/** Where a report is in its life. */
export function life(report) {
  switch (report.state) {
    case "held": return { level: "ask", word: "held" };
    case "queued": return { level: "wait", word: "queued" };
    case "sending": return { level: "wait", word: "sending" };
    case "in_doubt": return report.asking ? { level: "wait", word: "in doubt, asking" } : { level: "ask", word: "in doubt" };
    case "rejected": return { level: "bad", word: "rejected" };
    case "answered": return gained(report);
    case "settled": return report.reconciled ? gained(report) : { level: "quiet", word: "settled" };
    case "withdrawn": return { level: "quiet", word: report.same_as ? `same as #${report.same_as}` : "withdrawn" };
    default: return { level: "quiet", word: report.state };
  }
}

const AWAY = {
  no_token: "no token", cable_out: "cable out", cables_exchanged: "cables exchanged", no_address: "no address", command_post_unreachable: "unreachable", command_post_foreign: "wrong host",
  command_post_refusing: "refused", command_post_silent: "silent", command_post_failing: "failing", command_post_throttling: "slow down",
};

/** What is wrong with an endpoint of the Command Post, or with the way to it, by the list of alarms: {level, word}, or undefined. */
export function troubleOf({ alarms }, endpoint) {
  const isOf = ({ id, subject }) => id === "cable_out:command_post" || id === "cables_exchanged" || id === "no_address" || subject === "" || subject === endpoint;
  const alarm = alarms.find((each) => AWAY[each.id.split(":")[0]] && isOf(each));
  return alarm && { level: alarm.severity, word: AWAY[alarm.id.split(":")[0]] };
}

/** How an endpoint stands. What is no alarm yet may pass. */
export function endpoint(row, view) {
  const trouble = troubleOf(view, row.name);
  if (trouble) return trouble;
  if (!row.connected) return { level: "wait", word: "not connected" };
  if (row.trouble) return { level: "wait", word: "retrying" };
  return row.last_status >= 400 ? { level: "wait", word: "connected" } : { level: "good", word: "connected" };
}

const ms = (value) => `${value.toFixed(value < 10 ? 1 : 0)} ms`;

/** How fast an endpoint answers, or why it does not, in a word or two. */
export function answerOf(row, view) {
  const trouble = troubleOf(view, row.name);
  if (trouble) return trouble;
  if (row.trouble) return { level: "wait", word: row.last_status >= 400 ? `status ${row.last_status}` : "no answer" };
  if (row.last_status === 429) return { level: "wait", word: "slow down" };
  if (row.last_status >= 400) return { level: "bad", word: `status ${row.last_status}` };
  return row.answer_ms === null ? { level: "quiet", word: "–" } : { level: "good", word: ms(row.answer_ms) };
}
