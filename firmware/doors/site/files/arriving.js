// The meaning of the figures: for each a level (its shape and colour), a word, and a sentence if one helps.
//   good: as it should be   wait: late, or about to be decided   bad: it does not work   quiet: nothing to tell
//   ask: it waits for the operator's word
import { signed } from "./words.js";

export const kindOf = (row) => (row.kind === "state" ? "pose" : row.kind);

function gained({ score_change, report_status }) {
  if (score_change === null) return { level: "quiet", word: report_status || "answered" };
  if (score_change > 0) return { level: "good", word: `scored ${signed(score_change)}` };
  return { level: "quiet", word: score_change === 0 ? "no points" : `scored ${signed(score_change)}` };
}

const withdrawn = ({ number, same_as }) => (same_as > number ? `corrected as #${same_as}` : same_as ? `same as #${same_as}` : "withdrawn");

/** Whether something is still to happen with a report. */
export const isOpen = ({ state }) => ["held", "queued", "sending", "in_doubt"].includes(state);

/** Where a report is in its life. */
export function life(report) {
  switch (report.state) {
    case "held": return report.sends_at ? { level: "wait", word: "held, to be sent" } : { level: "ask", word: "held" };
    case "queued": return { level: "wait", word: "queued" };
    case "sending": return { level: "wait", word: "sending" };
    case "in_doubt": return report.asking ? { level: "wait", word: "in doubt, asking" } : { level: "ask", word: "in doubt" };
    case "rejected": return { level: "bad", word: "rejected" };
    case "answered": return gained(report);
    case "settled": return report.reconciled ? gained(report) : { level: "quiet", word: "settled" };
    case "withdrawn": return { level: "quiet", word: withdrawn(report) };
    default: return { level: "quiet", word: report.state };
  }
}
